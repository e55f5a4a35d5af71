// A table, made once from the results of a study. Files, terminals and pages show it by
// formats/csv_table.hpp, formats/terminal_table.hpp and report/page_table.hpp.
//
//   const Table runs = table_of<Run>(all, {{text_column("method"), &Run::method},
//                                          {{"residual"}, &Run::residual},
//                                          {{"wall_s", "wall", "s", 3}, &Run::wall_s}});
//   formats::write_whole(folder / "runs.csv", csv_table(runs));
//   std::fputs(terminal_table(chosen(runs, {"method", "wall_s"})).c_str(), stdout);
#pragma once

#include <cmath>
#include <concepts>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace coapt {

enum class CellKind { Nothing, Text, Count, Number };

// Nothing, a text, a whole number or a finite number: one that is not finite, or not there, is nothing.
struct TableCell {
  TableCell() = default;
  TableCell(std::string words) : kind(CellKind::Text), text(std::move(words)) {}
  TableCell(std::string_view words) : TableCell(std::string(words)) {}
  TableCell(const char* words) : TableCell(std::string(words)) {}
  TableCell(std::integral auto whole) : kind(CellKind::Count), count(static_cast<long long>(whole)) {}
  TableCell(double value)
      : kind(std::isfinite(value) ? CellKind::Number : CellKind::Nothing), number(value) {}
  template <class Value>
  TableCell(const std::optional<Value>& maybe) : TableCell(maybe ? TableCell(*maybe) : TableCell()) {}

  CellKind kind = CellKind::Nothing;
  std::string text = {};
  long long count = 0;
  double number = 0;
};

// The text of a cell where nothing is `dash`, and numbers are as `number_words` has them.
std::string cell_text(const TableCell& cell, const std::string& dash, const auto& number_words) {
  if (cell.kind == CellKind::Text) return cell.text;
  if (cell.kind == CellKind::Count) return std::to_string(cell.count);
  return cell.kind == CellKind::Number ? number_words(cell.number) : dash;
}

namespace detail {

TableCell cell_along(const auto& value) { return TableCell(value); }

TableCell cell_along(const auto& value, const auto& step, const auto&... steps) {
  if constexpr (requires { *value; })
    return value ? cell_along(*value, step, steps...) : TableCell();
  else
    return cell_along(std::invoke(step, value), steps...);
}

}  // namespace detail

struct TableColumn {
  std::string name;        // in files: "wall_s"
  std::string title = {};  // for people, without the unit; empty: the name
  std::string unit = {};   // in ASCII: "mm2"; empty: none
  int digits = 4;          // significant, for people; files have more
  int decimals = -1;       // of numbers in a terminal, in place of `digits`; below 0: not given
  int width = 0;           // at least, in a terminal; for rows that are printed one at a time
  bool is_text = false;    // stands to the left; numbers stand to the right
};

inline TableColumn text_column(const std::string& name, const std::string& title = "", int width = 0) {
  return {.name = name, .title = title, .width = width, .is_text = true};
}

// Each row has a cell for each column.
struct Table {
  std::vector<TableColumn> columns = {};
  std::vector<std::vector<TableCell>> rows = {};
};

// A column and what stands in it: a member of the record, or a function of it.
template <class Record>
struct ColumnOf {
  TableColumn column;
  std::function<TableCell(const Record&)> cell;
};

// One row for each record.
template <class Record>
Table table_of(std::span<const Record> records, const std::vector<ColumnOf<Record>>& columns) {
  Table table;
  for (const ColumnOf<Record>& each : columns) table.columns.push_back(each.column);
  for (const Record& record : records) {
    std::vector<TableCell>& row = table.rows.emplace_back();
    for (const ColumnOf<Record>& each : columns) row.push_back(each.cell(record));
  }
  return table;
}

// What is found from a record along these members and functions; nothing where one of them is empty or null.
//
//   along(&Run::error, &Error::greatest)    // where Run::error is optional
auto along(auto... steps) {
  return [=](const auto& record) { return detail::cell_along(record, steps...); };
}

// The columns of these names, in their order. Throws std::logic_error for a name that the table has not.
Table chosen(const Table& table, const std::vector<std::string>& names);

// All columns but those of these names. Throws as chosen() does.
Table without(const Table& table, const std::vector<std::string>& names);

// "wall [s]": title and unit.
std::string heading(const TableColumn& column);

}  // namespace coapt
