#include "xpbd/driving_forces.hpp"

#include "core/error.hpp"
#include "energy/connected_parts.hpp"
#include "mesh/triangle_mesh.hpp"
#include "xpbd/heart_forces.hpp"

namespace coapt {
namespace {

Points scene_forces(const Objective& objective, const Points& x, HeartPhase phase) {
  Points forces = Points::Zero(3, x.cols());
  for (const auto& term : objective.terms())
    if (term->role() == TermRole::Load) forces += nodal_forces(*term, x);
  return phase == HeartPhase::Systole ? forces : Points(-forces);
}

// The scene's pressure on a mean nodal area over the paper's p: the force that stands for one of the paper's
// [force].
double force_unit(const XpbdBody& body, double of_paper) {
  const Vector areas = nodal_areas(body.rest, body.triangles);
  const double count = static_cast<double>((areas.array() > 0).count());
  return count > 0 ? body.pressure * areas.sum() / count / of_paper : 0;
}

}  // namespace

DrivingForces::DrivingForces(const Objective& objective, const XpbdBody& body, const XpbdOptions& options)
    : objective_(objective), body_(body), options_(options) {
  const bool is_paper = options.forces == XpbdForces::Paper;
  if (is_paper && !has_heart_axis(body))
    throw InputError(
        "solver \"xpbd\": forces \"paper\" need a membrane and an ordered set \"annulus\" that encloses an "
        "opening; the scene has none");
  if (is_paper == (options.stiffness == XpbdStiffness::Paper)) return;
  const double unit = force_unit(body, options.paper.pressure);
  if (!(unit > 0))
    throw InputError(
        "solver \"xpbd\": stiffness and forces are one \"paper\" and one not, and the scene has "
        "no pressure that says how large the paper's forces are; use both or neither");
  factor_ = is_paper ? unit : 1 / unit;
}

Points DrivingForces::at(const Points& x, HeartPhase phase) const {
  if (options_.forces == XpbdForces::Scene) return factor_ * scene_forces(objective_, x, phase);
  return factor_ * heart_forces(body_, x, options_.paper, phase);
}

}  // namespace coapt
