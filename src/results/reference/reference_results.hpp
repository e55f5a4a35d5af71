// The distance from a reference, and how it was registered, in the files of results.
#pragma once

#include "formats/json/json_text.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "results/reference/reference_distance.hpp"

namespace coapt {

// Both directions together, each by itself, between vertices of the same number where that makes sense, and
// the registration: the value of `distance_to_reference` of result.json.
nlohmann::ordered_json reference_json(const ReferenceDistance& distance);

// How a surface was registered, but for the distances: keys of registration.json and of result.json.
nlohmann::ordered_json registration_json(const Registration& found, double translation_mm);

// The registered reference in its new place, with `distance_to_result` at its vertices [mm]. Pre:
// fields.registered_reference.
VtpSurface registered_surface(const Model& model, const Fields& fields);

}  // namespace coapt
