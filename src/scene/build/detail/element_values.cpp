#include "scene/build/detail/element_values.hpp"

#include "core/error.hpp"
#include "formats/defects.hpp"
#include "formats/json/read_json.hpp"
#include "formats/json/suggestion.hpp"
#include "formats/json/units.hpp"
#include "formats/text.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

struct Column {
  const KeySpec* key = nullptr;
  double unit = 1;  // internal units per unit of the file
  std::vector<double> numbers;
};

std::vector<std::string> cells(std::string_view line) {
  std::vector<std::string> words;
  for (size_t from = 0;;) {
    const size_t comma = line.find(',', from);
    words.emplace_back(formats::trimmed(line.substr(from, comma - from)));
    if (comma == std::string_view::npos) return words;
    from = comma + 1;
  }
}

// The key, and the unit in brackets behind it.
Column read_heading(const std::string& heading, const TermType& type, const std::string& where) {
  const size_t open = heading.find('['), close = heading.find(']');
  const std::string name(formats::trimmed(std::string_view(heading).substr(0, open)));
  std::vector<std::string> known;
  Column column;
  for (const KeySpec& key : type.spec.keys) {
    if (key.kind != KeyKind::Quantity) continue;
    known.push_back(key.name);
    if (key.name == name) column.key = &key;
  }
  if (column.key == nullptr)
    throw InputError(where + ": " + formats::quoted(name) + " is no number of a " + type.name + " term" +
                     suggestion(name, known) + "; it has " + listed(known));
  const Dimension dimension = column.key->dimension;
  if (open == std::string::npos) {
    if (dimension != kDimensionless && dimension != kLength)
      throw InputError(where + ": " + name + " has no unit; write it as " + name + " [" +
                       internal_unit(dimension) + "]");
    return column;
  }
  if (close == std::string::npos || close < open)
    throw InputError(where + ": " + formats::quoted(heading) + " lacks the closing bracket of its unit");
  try {
    column.unit = unit_factor(heading.substr(open + 1, close - open - 1), dimension);
  } catch (const InputError& error) {
    throw InputError(where + ": " + name + ": " + error.what());
  }
  return column;
}

bool is_allowed(double value, const KeySpec& key) {
  return std::abs(value) <= kGreatestNumber && value <= key.max &&
         (key.excludes_min ? value > key.min : value >= key.min);
}

std::vector<Column> read_columns(const std::string& path, const TermType& type, int rows,
                                 const std::string& what) {
  const std::string text = read_text(path);
  formats::Lines lines(text);
  formats::Defects defects(path);
  std::vector<Column> columns;
  int row = 0;
  for (std::string_view line; lines.next(line);) {
    line = formats::trimmed(line);
    if (line.empty() || line.front() == '#') continue;
    const std::vector<std::string> words = cells(line);
    const std::string where = path + ": line " + std::to_string(lines.number());
    if (columns.empty()) {
      for (const std::string& word : words) columns.push_back(read_heading(word, type, where));
      continue;
    }
    if (words.size() != columns.size()) {
      defects.add("line", lines.number(),
                  "has " + std::to_string(words.size()) + " numbers; the first line names " +
                      std::to_string(columns.size()));
      continue;
    }
    for (size_t c = 0; c < columns.size(); ++c) {
      double value = 0;
      const KeySpec& key = *columns[c].key;
      if (const auto reason = formats::read_number(words[c], value))
        defects.add("line", lines.number(), key.name + ": " + *reason);
      else if (!is_allowed(value *= columns[c].unit, key))
        defects.add("line", lines.number(), key.name + ": " + words[c] + " is outside its limits");
      columns[c].numbers.push_back(value);
    }
    ++row;
  }
  if (columns.empty()) defects.fail("is empty; its first line must name keys of the term");
  defects.throw_if_any();
  if (row != rows)
    defects.fail("has " + std::to_string(row) + " rows; the mesh has " + std::to_string(rows) + " " + what);
  return columns;
}

Vector corner_means(const Vector& at_vertices, const Triangles& triangles) {
  Vector means(triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t)
    means[t] =
        (at_vertices[triangles(0, t)] + at_vertices[triangles(1, t)] + at_vertices[triangles(2, t)]) / 3;
  return means;
}

}  // namespace

ElementValues::ElementValues(const TermSpec& spec, const BuildContext& context)
    : parameters_(spec.parameters) {
  const TermType& type = *find_term_type(spec.type);
  const TriangleMesh& scene_mesh = context.scene_mesh;
  const auto keep = [&](const std::string& file_key, int rows, const std::string& what, const auto& carried) {
    if (!parameters_.has(file_key)) return;
    for (const Column& column : read_columns(parameters_.text(file_key), type, rows, what)) {
      const Vector numbers =
          parameters_.factor(column.key->name) *
          Eigen::Map<const Vector>(column.numbers.data(), static_cast<Eigen::Index>(column.numbers.size()));
      for (const double number : {numbers.minCoeff(), numbers.maxCoeff()})
        if (!is_allowed(number, *column.key))
          throw InputError(parameters_.text(file_key) + ": " + column.key->name + ": with the factor " +
                           std::to_string(parameters_.factor(column.key->name)) +
                           " that is tried a number is outside its limits");
      columns_[column.key->name] = carried(numbers);
    }
  };
  const Triangles& here = context.model.mesh.triangles;
  keep("vertex_values", scene_mesh.vertex_count(), "vertices",
       [&](const Vector& v) { return corner_means(context.at_vertices(v), here); });
  keep("triangle_values", scene_mesh.triangle_count(), "triangles",
       [&](const Vector& v) { return context.on_triangles(v); });
}

bool ElementValues::has(const std::string& key) const {
  return columns_.contains(key) || parameters_.has(key);
}

double ElementValues::number(const std::string& key, int triangle) const {
  const auto column = columns_.find(key);
  return column == columns_.end() ? parameters_.number(key) : column->second[triangle];
}

double ElementValues::number_or(const std::string& key, int triangle, double otherwise) const {
  return has(key) ? number(key, triangle) : otherwise;
}

KeySpec triangle_values_key() {
  return {.name = "triangle_values",
          .kind = KeyKind::File,
          .doc =
              "CSV file with a column for each number of this term that differs from triangle to triangle "
              "and a row per triangle of the mesh; its first line names them with their units, as "
              "`thickness [mm],young [MPa]`."};
}

KeySpec vertex_values_key() {
  return {.name = "vertex_values",
          .kind = KeyKind::File,
          .doc = "The same with a row per vertex of the mesh; a triangle takes the mean of its corners."};
}

}  // namespace coapt
