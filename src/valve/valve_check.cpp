#include "valve/valve_check.hpp"

#include "core/number_text.hpp"
#include "mesh/mesh_check.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <limits>

namespace coapt {
namespace {

// Generous: from the valves of mice to those of whales, and what a heart can do to them.
constexpr std::array<double, 2> kLeafletSize = {0.5, 500};  // largest extent [mm]
constexpr std::array<double, 2> kThickness = {0.001, 20};   // [mm]
constexpr double kThickest = 0.25;                          // thickness over the largest extent
constexpr std::array<double, 2> kChordArea = {1e-6, 300};   // [mm2]
constexpr std::array<double, 2> kPressure = {
    1.3e-6, 0.067};  // 0.01 to 500 mmHg [MPa]: 480 under weights (MacDougall 1985)
constexpr double kMpaPerMmhg = 133.322387415e-6;  // conventional mmHg, BIPM SI brochure

// Between the normals of two neighbours. Small triangles of uneven meshes are folded that far by right: rough
// valves have some, up to 0.57 of the mean edge high, and a solve unfolds them.
constexpr double kFlatCosine = -0.99985;      // of any height: an angle of 1 degree between the triangles
constexpr double kFoldedCosine = -0.8660254;  // of triangles that are not small: 150 degrees
constexpr double kSmallHeight = 0.6;          // of the mean edge

bool is_within(double value, const std::array<double, 2>& range) {
  return value >= range[0] && value <= range[1];
}

std::string range_text(const std::array<double, 2>& range, double factor = 1) {
  return number_text(range[0] * factor) + " to " + number_text(range[1] * factor);
}

// Zero for a sliver, whose normal says nothing.
Vec3 normal_unless_sliver(const TriangleMesh& mesh, int t) {
  const Vec3 a = mesh.vertices.col(mesh.triangles(0, t));
  const Vec3 u = mesh.vertices.col(mesh.triangles(1, t)) - a, v = mesh.vertices.col(mesh.triangles(2, t)) - a;
  const Vec3 n = u.stableNormalized().cross(v.stableNormalized());
  return n.norm() * kSliverAspect < 1 ? Vec3(Vec3::Zero()) : Vec3(n.normalized());
}

// The heights of two triangles over their common edge, the lower one.
double lower_height(const TriangleMesh& mesh, const Edge& edge) {
  const double length = (mesh.vertices.col(edge.a) - mesh.vertices.col(edge.b)).norm();
  double area = std::numeric_limits<double>::infinity();
  for (const int t : edge.triangles)
    area = std::min(area, area_vector(mesh.vertices, mesh.triangles.col(t)).norm());
  return 2 * area / length;
}

// Along the edge, from its lower to its higher vertex. Neighbours run in opposite directions, unless one of
// them is turned over.
bool runs_upward(const TriangleMesh& mesh, int t, const Edge& edge) {
  for (int k = 0; k < 3; ++k)
    if (mesh.triangles(k, t) == edge.a) return mesh.triangles((k + 1) % 3, t) == edge.b;
  return false;
}

}  // namespace

std::vector<std::string> fold_doubts(const TriangleMesh& leaflets, Numbering numbering) {
  constexpr size_t kFew = 10;
  size_t count = 0;
  std::string pairs;
  const double small = kSmallHeight * mean_edge_length(leaflets.vertices, leaflets.triangles);
  for (const Edge& edge : edges(leaflets.triangles)) {
    if (edge.triangles.size() != 2) continue;
    const int s = edge.triangles[0], t = edge.triangles[1];
    const int sign = runs_upward(leaflets, s, edge) == runs_upward(leaflets, t, edge) ? -1 : 1;
    const double cosine = sign * normal_unless_sliver(leaflets, s).dot(normal_unless_sliver(leaflets, t));
    if (!(cosine < kFlatCosine || (cosine < kFoldedCosine && lower_height(leaflets, edge) > small))) continue;
    if (++count > kFew) continue;
    pairs.append(pairs.empty() ? "(" : ", (").append(numbering.of(s)).append(", ");
    pairs.append(numbering.of(t)).append(")");
  }
  if (count == 0) return {};
  if (count > kFew) pairs.append(" and ").append(std::to_string(count - kFew)).append(" more");
  return {"neighbouring triangles are folded onto each other: " + pairs + numbering.note() +
          " (more than 150 degrees between their normals); bending and contact have no direction there. "
          "Unfold the mesh, or move the corners apart."};
}

std::vector<std::string> size_doubts(const Valve& valve) {
  std::vector<std::string> doubts;
  double size = std::numeric_limits<double>::infinity();
  if (valve.leaflets.triangle_count() > 0) {
    const Points& x = valve.leaflets.vertices;
    size = (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
    if (!is_within(size, kLeafletSize))
      doubts.push_back("the leaflets are " + number_text(size) + " mm across; valves have " +
                       range_text(kLeafletSize) +
                       " mm. Check the unit of the mesh (`units` of a valve JSON).");
  }
  if (valve.thickness > 0 && !is_within(valve.thickness, kThickness))
    doubts.push_back("the leaflets are " + number_text(valve.thickness) + " mm thick; valves have " +
                     range_text(kThickness) + " mm. Check the unit of the thickness.");
  else if (valve.thickness > kThickest * size)
    doubts.push_back("the leaflets are " + number_text(valve.thickness) + " mm thick and only " +
                     number_text(size) + " mm across; a membrane is thinner than a quarter of its extent. " +
                     "Check the units of mesh and thickness.");
  if (valve.pressure > 0 && !is_within(valve.pressure, kPressure))
    doubts.push_back("the pressure is " + number_text(valve.pressure / kMpaPerMmhg) + " mmHg; hearts have " +
                     range_text({0.01, 500}) + " mmHg. Check the unit of the pressure (1 kPa is 7.5 mmHg).");
  std::vector<int> odd;
  for (size_t k = 0; k < valve.chords.chords.size(); ++k)
    if (const double area = valve.chords.chords[k].area; area > 0 && !is_within(area, kChordArea))
      odd.push_back(static_cast<int>(k));
  if (!odd.empty())
    doubts.push_back(
        std::to_string(odd.size()) + " chords, the first of them " + std::to_string(odd.front()) + " with " +
        number_text(valve.chords.chords[static_cast<size_t>(odd.front())].area) +
        " mm2, have a cross-section outside " + range_text(kChordArea) + " mm2. Check the unit of `area`.");
  return doubts;
}

}  // namespace coapt
