#include "registration/registration.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "mesh/distance/surface_distance.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <utility>

namespace coapt {
namespace {

constexpr double kLargeError = 0.01;  // of the size: a standard error that the user should know of

constexpr std::array<std::pair<RegistrationMethod, const char*>, 3> kMethods{
    {{RegistrationMethod::Annulus, "annulus"},
     {RegistrationMethod::Landmarks, "landmarks"},
     {RegistrationMethod::Surface, "surface"}}};

RegistrationDistance distance_of(const SurfaceDistance& distance, const TriangleMesh& from) {
  const Vector areas = nodal_areas(from.vertices, from.triangles);
  const double squared = areas.dot(distance.vertex_distances.cwiseAbs2()) / areas.sum();
  return {distance.mean, distance.p95, distance.max, std::sqrt(squared)};
}

// A boundary that ends, as where three triangles meet at an edge, is no loop.
bool is_closed(const std::vector<int>& loop, const Triangles& triangles) {
  const int a = loop.back(), b = loop.front();
  for (const auto& t : triangles.colwise())
    for (int k = 0; k < 3; ++k)
      if ((t[k] == a && t[(k + 1) % 3] == b) || (t[k] == b && t[(k + 1) % 3] == a)) return true;
  return false;
}

}  // namespace

std::optional<RegistrationMethod> registration_method(const std::string& name) {
  for (const auto& [method, its_name] : kMethods)
    if (name == its_name) return method;
  return std::nullopt;
}

const char* registration_method_name(RegistrationMethod method) {
  for (const auto& [known, name] : kMethods)
    if (known == method) return name;
  return "";
}

std::vector<std::string> registration_doubts(const Registration& registration) {
  std::vector<std::string> doubts;
  if (registration.overlap < kSmallOverlap)
    doubts.push_back(
        "only " + fixed_text(100 * registration.overlap, 0) +
        " % of the points have a counterpart after the registration; look at it before you believe it");
  if (registration.free_directions > 0)
    doubts.push_back(
        "the surfaces leave " + std::to_string(registration.free_directions) +
        " directions of the motion open, as a sphere does its rotations; there it was left as it "
        "was; landmarks would determine it");
  if (registration.standard_error.value_or(0) > kLargeError * registration.size)
    doubts.push_back("noise leaves the place uncertain by " + number_text(*registration.standard_error, 2) +
                     " mm (standard error, rms over the points; the surfaces say little of one direction, as "
                     "the turn about an axis of near symmetry); landmarks would determine it");
  return doubts;
}

RegistrationDistances registration_distances(const TriangleMesh& moving, const TriangleMesh& target) {
  SurfaceDistance there = surface_distance(moving, target), back = surface_distance(target, moving);
  return {distance_of(there, moving), distance_of(back, target), std::move(there.vertex_distances),
          std::move(back.vertex_distances)};
}

double moved_by(const RigidMotion& motion, const Points& vertices) {
  const Vec3 middle = vertices.rowwise().mean();
  return (motion.apply(middle) - middle).norm();
}

Points annulus_loop(const TriangleMesh& mesh) {
  Points best(3, 0);
  double most = 0;
  for (const std::vector<int>& loop : boundary_loops(mesh.triangles)) {
    if (loop.size() < 3 || !is_closed(loop, mesh.triangles)) continue;
    const Points x = mesh.vertices(Eigen::all, loop);
    Vec3 area = Vec3::Zero();
    for (Eigen::Index k = 0; k < x.cols(); ++k)
      area += (x.col(k) - x.col(0)).cross(x.col((k + 1) % x.cols()) - x.col(0)) / 2;
    if (area.norm() <= most) continue;
    most = area.norm();
    best = x;
  }
  if (best.cols() == 0)
    throw InputError(
        "has no closed boundary loop to take for the annulus; register by surface or landmarks instead");
  return best;
}

}  // namespace coapt
