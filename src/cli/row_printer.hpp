// Tables on the terminal.
#pragma once

#include "formats/terminal_table.hpp"

#include <cstdio>

namespace coapt::cli {

inline void print_table(const Table& table, bool has_headings = true) {
  std::fputs(terminal_table(table, has_headings).c_str(), stdout);
  std::fflush(stdout);
}

// Prints a table whose rows come one at a time, the headings above the first.
class RowPrinter {
 public:
  void operator()(const Table& rows) {
    print_table(rows, !has_headings_);
    has_headings_ = true;
  }

 private:
  bool has_headings_ = false;
};

}  // namespace coapt::cli
