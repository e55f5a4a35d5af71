#include "xpbd/heart_forces.hpp"

#include "mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>

namespace coapt {
namespace {

struct Axis {
  Vec3 middle = Vec3::Zero(), along = Vec3::Zero();

  Vec3 offset(const Vec3& at) const {
    const Vec3 d = at - middle;
    return d - d.dot(along) * along;
  }
};

Vec3 middle_of_membrane(const XpbdBody& body, const Points& x) {
  Vec3 sum = Vec3::Zero();
  for (const int node : body.triangles.reshaped()) sum += x.col(node);
  return sum / static_cast<double>(body.triangles.size());
}

// Along the area vector of the annulus; it points the way that `up` does. Zero where the annulus encloses
// nothing.
Axis axis_of(const XpbdBody& body, const Points& x) {
  Axis axis;
  for (const int node : body.annulus) axis.middle += x.col(node) / static_cast<double>(body.annulus.size());
  Vec3 area = Vec3::Zero();
  for (size_t k = 0; k < body.annulus.size(); ++k) {
    const Vec3 a = x.col(body.annulus[k]), b = x.col(body.annulus[(k + 1) % body.annulus.size()]);
    area += 0.5 * (a - axis.middle).cross(b - axis.middle);
  }
  if (!(area.norm() > 0)) return axis;
  axis.along = area.normalized();
  return axis;
}

// +1 where the loop of the annulus turns about the direction from the open leaflets to it, else -1.
double sense_of_loop(const XpbdBody& body) {
  const Axis axis = axis_of(body, body.rest);
  return axis.along.dot(axis.middle - middle_of_membrane(body, body.rest)) < 0 ? -1 : 1;
}

// +1 where the normals of the surface at rest point towards the axis, else -1.
double sense_of_normals(const XpbdBody& body) {
  const Axis axis = axis_of(body, body.rest);
  double outward = 0;
  for (const auto& t : body.triangles.colwise()) {
    const Vec3 centre = (body.rest.col(t[0]) + body.rest.col(t[1]) + body.rest.col(t[2])) / 3;
    outward += area_vector(body.rest, t).dot(axis.offset(centre).normalized());
  }
  return outward > 0 ? -1 : 1;
}

Points normals(const XpbdBody& body, const Points& x) {
  Points n = Points::Zero(3, x.cols());
  for (const auto& t : body.triangles.colwise()) {
    const Vec3 area = area_vector(x, t);
    for (const int node : t) n.col(node) += area;
  }
  return n.colwise().normalized();
}

}  // namespace

Points heart_forces(const XpbdBody& body, const Points& x, const XpbdPaper& weights, HeartPhase phase) {
  Axis axis = axis_of(body, x);
  axis.along *= sense_of_loop(body);
  const double sign = phase == HeartPhase::Systole ? 1 : -1;
  const Points n = sense_of_normals(body) * normals(body, x);
  std::vector<bool> is_membrane(static_cast<size_t>(x.cols()), false);
  for (const int node : body.triangles.reshaped()) is_membrane[static_cast<size_t>(node)] = true;
  Points forces = Points::Zero(3, x.cols());
  const Vec3 flow = weights.flow * axis.along;
  for (int node = 0; node < x.cols(); ++node) {
    if (!is_membrane[static_cast<size_t>(node)]) continue;
    const Vec3 normal = n.col(node);
    Vec3 force = flow + (flow.dot(normal) + weights.pressure) * normal;
    if (weights.radial != 0) force -= weights.radial * axis.offset(x.col(node)).stableNormalized();
    forces.col(node) = sign * force;
  }
  return forces;
}

bool has_heart_axis(const XpbdBody& body) {
  return body.annulus.size() >= 3 && body.triangles.cols() > 0 && axis_of(body, body.rest).along.norm() > 0;
}

}  // namespace coapt
