// A table as one of a page.
#pragma once

#include "formats/table.hpp"
#include "report/report_page.hpp"
#include "results/changed_figures.hpp"

#include <string>
#include <vector>

namespace coapt {

// Nothing is a dash; tones, remarks and shares are the caller's to add.
PageTable page_table(const Table& table, const std::string& caption, const std::string& note = "");

// The figures that one of two states defines, with their meanings in small print.
PageTable change_page_table(const std::vector<ChangedFigure>& figures);

}  // namespace coapt
