// The 3-D view of a solved scene.
#pragma once

#include "scene/results.hpp"
#include "scene/shape_view.hpp"

namespace coapt {

// Title of the field that a comparison of methods adds.
inline constexpr const char* kMethodDistance = "Distance to the reference method";

// As seen from the atrium; without an annulus from where most of the surface faces, else from above.
ViewFrame viewing_frame(const Model& model, const Fields& fields);

// The surface with its lines, obstacles and frame, without any state.
ShapeView bare_view(const Model& model, const Fields& fields);

// What colours the sheet of one solved state: gap, contact, displacement, distances, strains, stresses,
// regimes, leaflets; those that the scene has.
std::vector<ViewField> view_fields(const Model& model, const Fields& fields);

// The coaptation line, and the orifice outlines with their area, of the view's last state.
void add_outlines(const Metrics& metrics, ShapeView& view);

// From the start by the recorded iterates to the result, with its fields, outlines and coaptation line.
ShapeView solved_view(const Model& model, const Report& report);

}  // namespace coapt
