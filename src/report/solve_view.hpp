// The 3-D view of a solved scene.
#pragma once

#include "report/shape_view.hpp"
#include "results/results.hpp"

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

// From the start by the recorded iterates to the result, with its outlines and its coaptation line. `history`
// holds positions relative to the model's origin, as report.shape_history.
std::vector<ViewState> view_states(const Report& report, const std::vector<RecordedShape>& history,
                                   const Vec3& up);

// One state, with its outlines and coaptation line. up: towards who looks from above, for smooth_outline().
ViewState result_state(const std::string& label, const Report& report, const Vec3& up);

// A closed outline as it is drawn: along `up`, a unit vector, every corner stands at the mean height of the
// corners around it, by a Gaussian whose width is a thirtieth of the perimeter. The rim of an orifice passes
// from one leaflet to another by a jump; seen along `up` nothing changes.
Points smooth_outline(const Points& corners, const Vec3& up);

// From the start by the recorded iterates to the result, with its fields.
ShapeView solved_view(const Model& model, const Report& report);

}  // namespace coapt
