#include "results/detail/contact_limit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace coapt {
namespace {

constexpr double kMostOfReach = 0.95;  // vertices without a gap lie beyond all of it

double gap_at(int vertex, const Fields& fields) {
  return std::isnan(fields.gap[vertex]) ? fields.gap_reach : fields.gap[vertex];
}

// Part of a triangle over which a linear function with these values at the corners is at most `level`.
double part_below(std::array<double, 3> values, double level) {
  std::sort(values.begin(), values.end());
  const auto [a, b, c] = values;
  if (c <= level) return 1;
  if (a >= level) return 0;
  if (b >= level) return (level - a) * (level - a) / ((b - a) * (c - a));
  return 1 - (c - level) * (c - level) / ((c - a) * (c - b));
}

// The gap that half of the area around vertices in contact does not exceed; the contact distance where there
// are none.
double resting_gap(const Model& model, const Fields& fields) {
  const Vector areas = nodal_areas(fields.x.leftCols(fields.gap.size()), model.mesh.triangles);
  std::vector<std::pair<double, double>> gaps;  // with their areas
  double whole = 0, below = 0;
  for (Eigen::Index v = 0; v < fields.gap.size(); ++v)
    if (fields.is_contact[static_cast<size_t>(v)]) {
      gaps.emplace_back(fields.gap[v], areas[v]);
      whole += areas[v];
    }
  std::sort(gaps.begin(), gaps.end());
  for (const auto& [gap, area] : gaps)
    if ((below += area) >= 0.5 * whole) return gap;
  return fields.contact_distance;
}

}  // namespace

ContactLimit contact_limit(const Model& model, const Fields& fields) {
  const double near = fields.contact_distance, rest = resting_gap(model, fields), beyond = near - rest;
  const double far = std::min(rest + 4 * beyond, kMostOfReach * fields.gap_reach);
  if (!(beyond > 0) || !(far > near)) return {near, near, 1};
  return {near, far, 1 / (std::sqrt((far - rest) / beyond) - 1)};
}

Vector areas_within(double distance, const Model& model, const Fields& fields) {
  const Triangles& triangles = model.mesh.triangles;
  Vector areas(triangles.cols());
  for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
    const Eigen::Vector3i c = triangles.col(t);
    const double part =
        part_below({gap_at(c[0], fields), gap_at(c[1], fields), gap_at(c[2], fields)}, distance);
    areas[t] = part == 0 ? 0 : area_vector(fields.x, c).norm() * part;
  }
  return areas;
}

ContactMeasure measure_contact(const Model& model, const Fields& fields) {
  const ContactLimit limit = contact_limit(model, fields);
  const Vector near = areas_within(limit.near, model, fields), far = areas_within(limit.far, model, fields);
  return {limit, near, near - limit.weight * (far - near)};
}

std::optional<double> resolved_area(double near, double in_contact) {
  if (near == 0) return 0;
  return in_contact > 0 ? std::optional(in_contact) : std::nullopt;
}

std::vector<Vec3> places_within(double distance, int region, const Model& model, const Fields& fields) {
  const TriangleMesh& mesh = model.mesh;
  std::vector<char> taken(static_cast<size_t>(mesh.vertex_count()), 0);
  std::vector<Vec3> places;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    if (region >= 0 && !mesh.regions.empty() && mesh.regions[static_cast<size_t>(t)] != region) continue;
    for (int k = 0; k < 3; ++k) {
      const int a = mesh.triangles(k, t), b = mesh.triangles((k + 1) % 3, t);
      const double at_a = gap_at(a, fields), at_b = gap_at(b, fields);
      if (at_a <= distance && !taken[static_cast<size_t>(a)]) {
        taken[static_cast<size_t>(a)] = 1;
        places.emplace_back(fields.x.col(a));
      }
      if ((at_a <= distance) == (at_b <= distance)) continue;
      const double part = (distance - at_a) / (at_b - at_a);
      places.emplace_back(fields.x.col(a) + part * (fields.x.col(b) - fields.x.col(a)));
    }
  }
  return places;
}

}  // namespace coapt
