// Several solved states of one surface in one 3-D view. Private to this room.
#pragma once

#include "scene/solve_view.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct ComparedShape {
  std::string label;
  const Model* model = nullptr;
  const Report* report = nullptr;
  bool is_at_rest = false;  // the shape that it was solved from, without any field
};

// The shapes, with the fields of each; those whose nodes or triangles are not those of shapes[base] are left
// out, and the forces of lines where the lines differ, and obstacles where they do. Nothing without shapes.
// name: of pictures; slider: what leads from one to the next.
std::optional<ShapeView> compared_view(const std::vector<ComparedShape>& shapes, size_t base,
                                       const std::string& name, const std::string& slider);

}  // namespace coapt
