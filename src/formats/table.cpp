#include "formats/table.hpp"

#include <algorithm>
#include <stdexcept>

namespace coapt {
namespace {

size_t place_of(const Table& table, const std::string& name) {
  const auto found = std::find_if(table.columns.begin(), table.columns.end(),
                                  [&](const TableColumn& column) { return column.name == name; });
  if (found == table.columns.end()) throw std::logic_error("the table has no column \"" + name + "\"");
  return static_cast<size_t>(found - table.columns.begin());
}

}  // namespace

Table chosen(const Table& table, const std::vector<std::string>& names) {
  Table result;
  result.rows.resize(table.rows.size());
  for (const std::string& name : names) {
    const size_t place = place_of(table, name);
    result.columns.push_back(table.columns[place]);
    for (size_t r = 0; r < table.rows.size(); ++r) result.rows[r].push_back(table.rows[r][place]);
  }
  return result;
}

Table without(const Table& table, const std::vector<std::string>& names) {
  for (const std::string& name : names) place_of(table, name);
  std::vector<std::string> others;
  for (const TableColumn& column : table.columns)
    if (std::find(names.begin(), names.end(), column.name) == names.end()) others.push_back(column.name);
  return chosen(table, others);
}

std::string heading(const TableColumn& column) {
  const std::string& title = column.title.empty() ? column.name : column.title;
  return column.unit.empty() ? title : title + " [" + column.unit + "]";
}

}  // namespace coapt
