// A table as lines of a terminal.
#pragma once

#include "formats/table.hpp"

#include <string>

namespace coapt {

// A line of headings with their units, then the rows, each with two spaces before every cell and a dash where
// there is nothing. Columns are as wide as what they hold, numbers at least 8 characters. Without the
// headings: further rows of a table that is printed row by row, in line as far as they fit the widths of the
// columns.
std::string terminal_table(const Table& table, bool has_headings = true);

}  // namespace coapt
