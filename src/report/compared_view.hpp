// Several solved states of one surface in one 3-D view.
#pragma once

#include "report/solve_view.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct ComparedShape {
  std::string label;
  const Model* model = nullptr;
  const Report* report = nullptr;
  bool has_history = false;  // is led to from its start, by iterates where the report has some
};

// The shapes, with the fields, outlines and coaptation line of each; those whose nodes or triangles are not
// those of shapes[base] are left out, and the forces of lines where the lines differ, and obstacles where
// they do. Two stand beside each other. The slider leads from one to the next; or, where they have histories,
// along that of one that is chosen. Nothing without shapes. name: of pictures; slider: what it is called.
std::optional<ShapeView> compared_view(const std::vector<ComparedShape>& shapes, size_t base,
                                       const std::string& name, const std::string& slider);

}  // namespace coapt
