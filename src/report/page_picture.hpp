// Pictures on a page of results.
#pragma once

#include "report/report_page.hpp"
#include "results/results.hpp"

#include <string>
#include <vector>

namespace coapt {

// A picture within the page itself, as wide as the page where it is wider. png: the bytes of its file. The
// caption says what it shows, also to a screen reader.
PageMarkup page_picture(const std::string& png, const std::string& caption);

// The page of a solve (report/solve_page.hpp) with `more` below its shape.
std::string solve_page_with(const Model& model, const Report& report, const std::vector<PageSection>& more);

}  // namespace coapt
