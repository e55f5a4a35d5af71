// Numbers of a membrane term that may differ from triangle to triangle. Private to this room.
#pragma once

#include "scene/terms/term_types.hpp"

#include <map>
#include <string>

namespace coapt {

// The keys of a term and, where `triangle_values` or `vertex_values` names a file, the columns of that file
// in their place. A triangle's value is that of its row, or the mean of its corners' rows.
//
// The files are CSV. The first line names a key of the term in each column, with the unit of its numbers
// where it has one: `thickness [mm],young [MPa]`. Then follows a row per triangle or per vertex of the
// scene's mesh, in its order. Lines that begin with # are skipped.
class ElementValues {
 public:
  // Throws InputError with all defects of the files, each by file and line.
  ElementValues(const TermSpec& spec, const BuildContext& context);

  double number(const std::string& key, int triangle) const;
  double number_or(const std::string& key, int triangle, double otherwise) const;
  bool has(const std::string& key) const;
  bool is_uniform() const { return columns_.empty(); }  // no number differs

 private:
  const Parameters& parameters_;
  std::map<std::string, Vector> columns_;  // per triangle of the model's mesh
};

// The keys `triangle_values` and `vertex_values`.
KeySpec triangle_values_key();
KeySpec vertex_values_key();

}  // namespace coapt
