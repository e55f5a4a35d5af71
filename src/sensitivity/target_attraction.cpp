#include "sensitivity/target_attraction.hpp"

#include "sensitivity/detail/facing_surface.hpp"

namespace coapt {

struct TargetAttraction::Target {
  explicit Target(TriangleMesh given) : mesh(std::move(given)), surface(mesh.vertices, mesh.triangles) {}
  TriangleMesh mesh;
  FacingSurface surface;
  double orientation = 1;
};

TargetAttraction::TargetAttraction(std::string name, const Triangles& triangles, const Points& x_start,
                                   TriangleMesh target)
    : EnergyTerm(std::move(name)), triangles_(triangles) {
  const Vector areas = nodal_areas(x_start, triangles_);
  stencils_.width = 1;
  for (int v = 0; v < areas.size(); ++v)
    if (areas[v] > 0) stencils_.nodes.push_back(v);
  areas_ = areas(stencils_.nodes);
  auto made = std::make_unique<Target>(std::move(target));
  made->orientation = made->surface.orientation_of(x_start, vertex_normals(x_start, triangles_), areas);
  target_ = std::move(made);
  face(x_start);
}

TargetAttraction::~TargetAttraction() = default;

void TargetAttraction::face(const Points& x) {
  directions_ = target_->orientation * vertex_normals(x, triangles_)(Eigen::all, stencils_.nodes);
}

double TargetAttraction::evaluate(const Points& x, Sink& sink) const {
  if (stiffness_ == 0) return 0;
  double energy = 0;
  for (int e = 0; e < stencils_.count(); ++e) {
    const int node = stencils_.nodes[static_cast<size_t>(e)];
    const ClosestPoint closest = target_->surface.closest(x.col(node), directions_.col(e));
    const Vec3 way = x.col(node) - closest.point;
    const double stiffness = stiffness_ * areas_[e];
    energy += 0.5 * stiffness * way.squaredNorm();
    if (sink.wants_gradient()) sink.add_gradient(node, stiffness * way);
    if (sink.wants_hessian()) sink.add_block(e, 1, 0, 0, stiffness * closest.away);
  }
  return energy;
}

}  // namespace coapt
