// A plot of a page: its figure with the data that files/plots.js draws, and its numbers. Private to this
// room.
#pragma once

#include "report/report_page.hpp"

namespace coapt {

// The figure with its notes, without the numbers. Without uPlot a line that says so takes the place of the
// data.
std::string plot_html(const PagePlot& plot);

// uPlot with its style and its licence, and the script that draws every figure before it: once in a page that
// has a plot. Empty without uPlot.
std::string plot_scripts();

// Its numbers: one table for each series.
std::vector<PageTable> plot_numbers(const PagePlot& plot);

}  // namespace coapt
