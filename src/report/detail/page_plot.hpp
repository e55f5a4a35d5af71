// A plot of a page as SVG. Private to this room.
#pragma once

#include "report/report_page.hpp"

namespace coapt {

// The figure with its key and its notes, without the numbers.
std::string plot_html(const PagePlot& plot);

// Its numbers: one table for each series.
std::vector<PageTable> plot_numbers(const PagePlot& plot);

}  // namespace coapt
