#include "formats/csv_table.hpp"

#include "core/number_text.hpp"
#include "formats/text.hpp"

namespace coapt {

std::string csv_table(const Table& table, int digits) {
  const auto number_words = [digits](double number) {
    return digits == kAllDigits ? exact_text(number) : number_text(number, digits);
  };
  std::string csv;
  const auto add_line = [&](const auto& cells, const auto& text_of) {
    for (size_t c = 0; c < cells.size(); ++c) csv.append(c == 0 ? "" : ",").append(text_of(cells[c]));
    csv += '\n';
  };
  add_line(table.columns, [](const TableColumn& column) { return csv_text(column.name); });
  for (const std::vector<TableCell>& row : table.rows)
    add_line(row, [&](const TableCell& cell) {
      return cell.kind == CellKind::Text ? csv_text(cell.text) : cell_text(cell, "", number_words);
    });
  return csv;
}

std::string csv_text(std::string text) {
  double number = 0;
  if (text.find_first_of("=+-@\t\r") == 0 && formats::read_number(text, number)) text.insert(0, 1, '\'');
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + "\"";
}

}  // namespace coapt
