// Cells of the tables that commands print.
#pragma once

#include <optional>

namespace coapt::cli {

// A number by its printf format, " %9.3g"; a dash as wide where there is none.
void print_cell(const std::optional<double>& value, const char* format);

}  // namespace coapt::cli
