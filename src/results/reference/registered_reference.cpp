#include "results/reference/registered_reference.hpp"

#include "core/error.hpp"
#include "registration/wanted_registration.hpp"

namespace coapt {

RegisteredReference registered_reference(const Model& model, const TriangleMesh& closed) {
  RegisteredReference reference{*model.closed_reference, std::nullopt};
  if (!model.registration) return reference;
  try {
    reference.registration = register_by(*model.registration, reference.surface, closed);
  } catch (const InputError& error) {
    throw error.within("reference.closed_surface");
  }
  reference.surface.vertices = reference.registration->motion.apply(reference.surface.vertices);
  return reference;
}

std::optional<TriangleMesh> placed_reference(const Model& model, const TriangleMesh& closed) {
  if (!model.closed_reference) return std::nullopt;
  try {
    return registered_reference(model, closed).surface;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

}  // namespace coapt
