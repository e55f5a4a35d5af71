// The files of src/report/files, of three.js and of uPlot, which the build puts into the library. Private to
// this room.
#pragma once

#include <string_view>

namespace coapt::report_files {

extern const std::string_view style;  // of every page

// The 3-D view: its elements, their style, and scripts that go into one block in this order.
extern const std::string_view viewer_markup, viewer_style;
extern const std::string_view viewer_base, viewer_stage, viewer_parts, viewer_values, viewer_screenshot,
    viewer_sliders, viewer_controls;

// Empty in a build without three.js.
extern const std::string_view three, three_controls, three_notice;

extern const std::string_view plots;  // draws every plot of a page by uPlot

// Empty in a build without uPlot.
extern const std::string_view uplot, uplot_style, uplot_notice;

}  // namespace coapt::report_files
