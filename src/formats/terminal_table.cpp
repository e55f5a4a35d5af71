#include "formats/terminal_table.hpp"

#include "core/number_text.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr int kNumberWidth = 8;  // "1.23e-08"

std::string words(const TableCell& cell, const TableColumn& column) {
  return cell_text(cell, "-", [&](double number) {
    return column.decimals < 0 ? number_text(number, column.digits) : fixed_text(number, column.decimals);
  });
}

// Of UTF-8 in characters.
size_t width_of(const std::string& text) {
  return static_cast<size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

std::string terminal_table(const Table& table, bool has_headings) {
  std::vector<std::vector<std::string>> lines(1);
  for (const TableColumn& column : table.columns) lines[0].push_back(heading(column));
  for (const std::vector<TableCell>& row : table.rows) {
    std::vector<std::string>& line = lines.emplace_back();
    for (size_t c = 0; c < row.size(); ++c) line.push_back(words(row[c], table.columns[c]));
  }
  std::string text;
  std::vector<size_t> widths;
  for (const TableColumn& column : table.columns) {
    size_t width = static_cast<size_t>(std::max(column.width, column.is_text ? 0 : kNumberWidth));
    for (const std::vector<std::string>& line : lines) width = std::max(width, width_of(line[widths.size()]));
    widths.push_back(width);
  }
  for (size_t l = has_headings ? 0 : 1; l < lines.size(); ++l) {
    for (size_t c = 0; c < widths.size(); ++c) {
      const std::string& cell = lines[l][c];
      const std::string blanks(widths[c] - width_of(cell), ' ');
      text += "  " + (table.columns[c].is_text ? cell + blanks : blanks + cell);
    }
    text.erase(text.find_last_not_of(' ') + 1);
    text += '\n';
  }
  return text;
}

}  // namespace coapt
