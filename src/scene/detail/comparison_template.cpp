#include "scene/detail/comparison_template.hpp"

namespace coapt {

const std::string_view kPageBegin = R"html(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Comparison of methods</title>
<style>
  body { font: 15px/1.45 system-ui, sans-serif; color: #1d2733; background: #fff; margin: 2rem auto; max-width: 1180px; padding: 0 1rem; }
  h1 { font-size: 1.5rem; margin: 0; } h2 { font-size: 1.1rem; margin: 2rem 0 .5rem; }
  p { margin: .3rem 0; max-width: 60rem; } .quiet { color: #5b6875; }
  .wide { overflow-x: auto; }
  table { border-collapse: collapse; font-size: .85rem; font-variant-numeric: tabular-nums; }
  th { text-align: right; font-weight: 600; vertical-align: bottom; border-bottom: 2px solid #1d2733; }
  td { text-align: right; border-bottom: 1px solid #dde3e9; white-space: nowrap; }
  th, td { padding: .3rem .55rem; } th.text, td.text { text-align: left; }
  li.bad { color: #a3231b; }
  .shapes { display: flex; flex-wrap: wrap; gap: 1rem; }
  figure { margin: 0; border: 1px solid #dde3e9; border-radius: 4px; padding: .5rem; }
  figcaption { font-weight: 600; } canvas { width: 262px; height: 210px; }
  svg text { font: 12px system-ui, sans-serif; fill: #1d2733; } svg .quiet { fill: #5b6875; }
</style>
</head>
<body>
<h1>Comparison of methods</h1>
<p id="about" class="quiet"></p>
<h2>Distances</h2>
<div class="wide"><table id="distances"></table></div>
<p class="quiet">In mm, between closed surfaces in both directions: mean of the means, greater 95th percentile, greater maximum. Same vertex: of each vertex from itself.</p>
<ul id="messages"></ul>
<h2>Figures</h2>
<div class="wide"><table id="figures"></table></div>
<p class="quiet">Areas in mm², lengths in mm, energies in mJ; times are those of the solve.</p>
<h2>Error and run time</h2>
<div id="bars" class="wide"></div>
<h2>Closed shapes</h2>
<p id="legend" class="quiet"></p>
<div id="shapes" class="shapes"></div>
<noscript>This page draws itself with the script that it carries.</noscript>
<script id="data" type="application/json">)html";

}  // namespace coapt
