#include "results/orifice_area.hpp"

#include "core/error.hpp"
#include "mesh/projected_area.hpp"
#include "results/closure.hpp"

namespace coapt {
namespace {

struct OrificeView {
  const std::vector<int>& annulus;
  Points surface, rim;
  Vec3 up;
};

OrificeView orifice_view(const Model& model, const Points& x) {
  const std::vector<int>& annulus = *annulus_of(model);
  Fields fields;
  fields.x = x;
  return {annulus, x.leftCols(model.mesh.vertex_count()), x(Eigen::all, annulus),
          annulus_frame(model, fields, annulus).up};
}

}  // namespace

std::optional<OrificeArea> orifice_area(const Model& model, const Points& x, int refinement) {
  if (annulus_of(model) == nullptr) return std::nullopt;
  try {
    const OrificeView view = orifice_view(model, x);
    const UncoveredArea area =
        uncovered_area(view.surface, model.mesh.triangles, view.rim, view.up, refinement);
    return OrificeArea{area.area, area.polygon_area};
  } catch (const InputError&) {
    return std::nullopt;
  }
}

Points orifice_area_gradient(const Model& model, const Points& x) {
  const OrificeView view = orifice_view(model, x);
  const UncoveredAreaGradient gradient =
      uncovered_area_gradient(view.surface, model.mesh.triangles, view.rim, view.up);
  Points by_x = Points::Zero(3, x.cols());
  by_x.leftCols(gradient.by_points.cols()) = gradient.by_points;
  for (size_t k = 0; k < view.annulus.size(); ++k)
    by_x.col(view.annulus[k]) += gradient.by_polygon.col(static_cast<Eigen::Index>(k));
  return by_x;
}

}  // namespace coapt
