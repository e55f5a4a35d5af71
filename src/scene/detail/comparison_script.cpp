#include "scene/detail/comparison_template.hpp"

namespace coapt {

const std::string_view kPageEnd = R"html(</script>
<script>
"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const study = data.study;

// --- elements

function element(name, text, className) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}

function drawn(name, attributes, text) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const key in attributes) made.setAttribute(key, attributes[key]);
  if (text !== undefined) made.textContent = text;
  return made;
}

const digits = (value, count) => value === null || value === undefined ? "–"
    : value === 0 ? "0"
    : Math.abs(value) < 1e-3 || Math.abs(value) >= 1e6 ? value.toExponential(Math.max(0, count - 2))
    : String(Number(value.toPrecision(count)));

// --- figures

const gap = method => method.distance_to_reference_method || {};
const same = method => gap(method).same_vertex || {};
const closed = method => method.distance_to_closed_surface || {};
const metric = (method, name) => (method.metrics || {})[name];
const time = method => method.time || {};

const distances = [
  ["method", m => m.name, true],
  ["status", m => m.status || "failed", true],
  ["verdict", m => m.verdict, true],
  ["mean", m => digits(gap(m).mean_mm, 3)],
  ["95 %", m => digits(gap(m).p95_mm, 3)],
  ["max", m => digits(gap(m).max_mm, 3)],
  ["same vertex mean", m => digits(same(m).mean_mm, 3)],
  ["same vertex max", m => digits(same(m).max_mm, 3)],
  ...(study.closed_surface ? [
    ["mean to closed surface", m => digits(closed(m).mean_mm, 3)],
    ["95 % to it", m => digits(closed(m).p95_mm, 3)],
    ["max to it", m => digits(closed(m).max_mm, 3)]] : []),
];

const figures = [
  ["method", m => m.name, true],
  ["orifice", m => digits(metric(m, "orifice_area_mm2"), 4)],
  ["coaptation area", m => digits(metric(m, "coaptation_area_mm2"), 4)],
  ["coaptation height", m => digits(metric(m, "coaptation_height_mm"), 4)],
  ["intersections", m => digits(metric(m, "intersections"), 6)],
  ["residual", m => digits(m.residual, 3)],
  ["energy", m => digits(m.energy_mj, 8)],
  ["iterations", m => digits(m.iterations, 9)],
  ["CPU s", m => digits(time(m).cpu_s, 3)],
  ["wall s", m => digits(time(m).wall_s, 3)],
];

function showTable(id, columns) {
  const table = document.getElementById(id);
  const head = table.appendChild(element("thead")).appendChild(element("tr"));
  const body = table.appendChild(element("tbody"));
  for (const [title, , isText] of columns) head.appendChild(element("th", title, isText ? "text" : ""));
  for (const method of study.methods) {
    const row = body.appendChild(element("tr"));
    for (const [, cell, isText] of columns) row.appendChild(element("td", cell(method), isText ? "text" : ""));
  }
}

function showMessages() {
  const list = document.getElementById("messages");
  for (const method of study.methods)
    list.appendChild(element("li", method.name + ": " + method.message, method.converged ? "" : "bad"));
}

// --- error and run time: bars on logarithmic scales

function scale(values, left, width) {
  const logs = values.filter(value => value > 0).map(Math.log10);
  if (!logs.length) return null;
  const high = Math.ceil(Math.max(...logs) + 1e-9);
  const low = Math.max(Math.floor(Math.min(...logs) - 1e-9), high - 12);
  const at = value => left + width * Math.max(0, Math.min(1, (Math.log10(value) - low) / (high - low)));
  return { low, high, at, left };
}

function showBars() {
  const errors = [["mean distance to " + study.reference, m => gap(m).mean_mm ?? same(m).mean_mm, "#2f6f9f"]];
  if (study.closed_surface) errors.push(["to " + study.closed_surface, m => closed(m).mean_mm, "#d08a2e"]);
  const times = [["CPU time of the solve [s]", m => time(m).cpu_s, "#5b6875"]];
  const bar = 14, row = bar * errors.length + 12, top = 46, bottom = top + row * study.methods.length;
  const svg = drawn("svg", { width: 1120, height: bottom + 26, role: "img" });
  const panel = (groups, left, width) => {
    const found = scale(study.methods.flatMap(m => groups.map(group => group[1](m))), left, width);
    groups.forEach((group, k) => {
      const key = left + k * width / groups.length;
      svg.appendChild(drawn("rect", { x: key, y: 8, width: 10, height: 10, fill: group[2] }));
      svg.appendChild(drawn("text", { x: key + 15, y: 17 }, group[0] + (width > 400 ? " [mm]" : "")));
    });
    if (!found) return;
    const every = Math.ceil((found.high - found.low) / 6);
    for (let power = found.low; power <= found.high; power += every) {
      const x = found.at(Math.pow(10, power));
      svg.appendChild(drawn("line", { x1: x, x2: x, y1: top - 8, y2: bottom, stroke: "#dde3e9" }));
      svg.appendChild(drawn("text", { x, y: bottom + 18, "text-anchor": "middle", class: "quiet" }, "1e" + power));
    }
    study.methods.forEach((method, m) => groups.forEach((group, k) => {
      const value = group[1](method), y = top + m * row + k * bar;
      if (value === null || value === undefined) return;
      const end = value > 0 ? found.at(value) : left;
      svg.appendChild(drawn("rect", { x: left, y, width: Math.max(0, end - left), height: bar - 3, fill: group[2] }));
      svg.appendChild(drawn("text", { x: end + 5, y: y + bar - 4 }, digits(value, 3)));
    }));
  };
  study.methods.forEach((method, m) =>
      svg.appendChild(drawn("text", { x: 0, y: top + m * row + bar - 4 }, method.name)));
  panel(errors, 130, 480);
  panel(times, 700, 330);
  document.getElementById("bars").appendChild(svg);
}

// --- shapes: triangles and lines, the farthest first

const stops = [[232, 238, 243], [246, 213, 92], [219, 78, 42], [97, 10, 32]];

function colour(share, light) {
  const place = Math.min(share, 0.9999) * (stops.length - 1), k = Math.floor(place), part = place - k;
  const mix = c => Math.round(light * (stops[k][c] * (1 - part) + stops[k + 1][c] * part));
  return `rgb(${mix(0)},${mix(1)},${mix(2)})`;
}

// From the atrium and from the side. right, up, towards the viewer: coordinates of a point, by number and sign.
const views = [
  { right: [0, 1], up: [1, 1], towards: [2, 1] },
  { right: [0, 1], up: [2, 1], towards: [1, -1] },
];

// Of the first shape: all pictures have its scale, and what lies far off is cut.
function bounds(view) {
  const box = { right: [Infinity, -Infinity], up: [Infinity, -Infinity] }, points = data.shapes[0].points;
  for (const key of ["right", "up"])
    for (let i = view[key][0]; i < points.length; i += 3) {
      box[key][0] = Math.min(box[key][0], points[i]);
      box[key][1] = Math.max(box[key][1], points[i]);
    }
  return box;
}

function items(shape, view) {
  const coordinate = (key, node) => view[key][1] * shape.points[3 * node + view[key][0]];
  const all = [];
  for (const [ends, count] of [[data.triangles, 3], [data.lines, 2]])
    for (let i = 0; i < ends.length; i += count) {
      const nodes = ends.slice(i, i + count);
      all.push({ nodes, depth: nodes.reduce((sum, node) => sum + coordinate("towards", node), 0) / count });
    }
  return all.sort((a, b) => a.depth - b.depth);
}

// Share of a triangle's normal that points to the viewer.
function facing(shape, nodes, view) {
  const [a, b, c] = nodes.map(node => shape.points.slice(3 * node, 3 * node + 3));
  const u = b.map((value, k) => value - a[k]), v = c.map((value, k) => value - a[k]);
  const normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  return Math.abs(normal[view.towards[0]]) / (Math.hypot(...normal) || 1);
}

function paint(canvas, shape, view) {
  const ratio = window.devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight, margin = 12;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  pen.lineJoin = "round";
  const box = bounds(view);
  const size = Math.min((width - 2 * margin) / (box.right[1] - box.right[0] || 1),
                        (height - 2 * margin) / (box.up[1] - box.up[0] || 1));
  const middle = key => (box[key][0] + box[key][1]) / 2;
  const x = node => width / 2 + size * (shape.points[3 * node + view.right[0]] - middle("right"));
  const y = node => height / 2 - size * (shape.points[3 * node + view.up[0]] - middle("up"));
  for (const { nodes } of items(shape, view)) {
    pen.beginPath();
    nodes.forEach((node, k) => k ? pen.lineTo(x(node), y(node)) : pen.moveTo(x(node), y(node)));
    if (nodes.length === 2) {
      pen.strokeStyle = "#7a8794";
      pen.lineWidth = 0.8;
      pen.stroke();
      continue;
    }
    pen.closePath();
    const shade = shape.shades.length ? nodes.reduce((sum, node) => sum + shape.shades[node], 0) / 765 : 0;
    pen.fillStyle = pen.strokeStyle = colour(shade, 0.55 + 0.45 * facing(shape, nodes, view));
    pen.lineWidth = 0.4;
    pen.fill();
    pen.stroke();
  }
}

function showLegend() {
  if (!data.triangles.length) return;
  const legend = document.getElementById("legend");
  legend.textContent = "Distance of each vertex to the surface of " + study.reference + ": 0 ";
  const ramp = legend.appendChild(drawn("svg", { width: 160, height: 12 }));
  for (let k = 0; k < 80; ++k)
    ramp.appendChild(drawn("rect", { x: 2 * k, y: 0, width: 2.5, height: 12, fill: colour(k / 79, 1) }));
  legend.append(" " + digits(data.map_max, 3) + " mm and more. Left from the atrium, right from the side, all on one scale.");
}

function showShapes() {
  for (const shape of data.shapes) {
    const figure = document.getElementById("shapes").appendChild(element("figure"));
    figure.appendChild(element("figcaption", shape.name));
    for (const view of views) paint(figure.appendChild(element("canvas")), shape, view);
  }
}

document.getElementById("about").textContent = study.scene + ", residual wanted: " + study.tolerance +
    "; one equilibrium: no vertex farther than " + digits(study.same_shape_mm, 3) + " mm from itself; coapt " +
    study.version + (study.cancelled ? "; cancelled before the last method" : "");
showTable("distances", distances);
showMessages();
showTable("figures", figures);
showBars();
showLegend();
showShapes();
</script>
</body>
</html>
)html";

}  // namespace coapt
