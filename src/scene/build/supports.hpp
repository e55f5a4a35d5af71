// What is checked of a scene's surface and supports when it is built. Private to this room.
#pragma once

#include "scene/file/scene.hpp"
#include "scene/terms/term_types.hpp"

#include <map>
#include <string>
#include <vector>

namespace coapt {

// Errors of the mesh to `defects`, warnings to model.warnings, each naming the mesh file.
void check_surface(const Scene& scene, Model& model, std::vector<std::string>& defects);

// Prescribes nodes that belong to no triangle and no chord, with a warning.
void hold_isolated_nodes(Model& model, const std::map<std::string, PlacedNetwork>& networks,
                         FixedMask& fixed);

// Warns of every connected part of the internal terms that can shift along an axis as nothing of it is
// prescribed there.
void warn_of_unsupported_parts(Model& model, const std::vector<TermPointer>& terms, const FixedMask& fixed);

}  // namespace coapt
