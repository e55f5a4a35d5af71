// Tables on the terminal.
#pragma once

#include "formats/terminal_table.hpp"

#include <cstdio>
#include <sstream>
#include <string>

namespace coapt::cli {

inline void print_table(const Table& table, bool has_headings = true) {
  std::fputs(terminal_table(table, has_headings).c_str(), stdout);
  std::fflush(stdout);
}

// The text in lines of up to 120 characters that end between words, each behind so many blanks.
inline std::string wrapped(const std::string& text, size_t blanks) {
  constexpr size_t kWidth = 120;
  std::string lines, line;
  std::istringstream words(text);
  for (std::string word; words >> word; line += (line.empty() ? "" : " ") + word)
    if (!line.empty() && blanks + line.size() + 1 + word.size() > kWidth) {
      lines += std::string(blanks, ' ') + line + '\n';
      line.clear();
    }
  return lines + std::string(blanks, ' ') + line + '\n';
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
