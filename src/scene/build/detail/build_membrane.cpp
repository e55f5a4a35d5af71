#include "scene/build/detail/build_membrane.hpp"

namespace coapt {

void note_membrane(const TermSpec& spec, const std::vector<int>& triangles,
                   const std::vector<MembraneProperties>& properties, Model& model) {
  model.membrane.resize(static_cast<size_t>(model.mesh.triangle_count()));
  int doubled = 0;
  for (size_t k = 0; k < triangles.size(); ++k) {
    MembraneProperties& entry = model.membrane[static_cast<size_t>(triangles[k])];
    if (entry.thickness > 0 || entry.prestress > 0) ++doubled;
    entry = properties[k];
  }
  if (doubled > 0)
    model.warnings.push_back(spec.parameters.where() + ": " + std::to_string(doubled) +
                             " triangles belong to another membrane term too; their energies add up and the "
                             "stress in the results is that of the last.");
}

}  // namespace coapt
