#include "cli/table_cell.hpp"

#include <cstdio>

namespace coapt::cli {

void print_cell(const std::optional<double>& value, const char* format) {
  if (value)
    std::printf(format, *value);
  else
    std::printf("%*s", std::snprintf(nullptr, 0, format, 0.0), "-");
}

}  // namespace coapt::cli
