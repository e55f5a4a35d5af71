// The closed reference of a scene, brought onto a solved surface.
#pragma once

#include "registration/registration.hpp"
#include "results/fields.hpp"

#include <optional>

namespace coapt {

struct RegisteredReference {
  TriangleMesh surface;                      // as it was given where the scene registers nothing
  std::optional<Registration> registration;  // of the given surface onto the solved one
};

// As `reference.register` of the scene says. Throws InputError, naming the closed surface, where nothing
// believable is found (register_surfaces.hpp, register_points.hpp) or the solved surface has no closed
// boundary loop. Pre: model.closed_reference. closed: the model's surface, solved.
RegisteredReference registered_reference(const Model& model, const TriangleMesh& closed);

// The same surface alone; none without a reference, or where nothing believable is found.
std::optional<TriangleMesh> placed_reference(const Model& model, const TriangleMesh& closed);

}  // namespace coapt
