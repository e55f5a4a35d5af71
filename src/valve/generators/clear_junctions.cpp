#include "valve/generators/clear_junctions.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <optional>

namespace coapt {
namespace {

// Does the segment from p to q cross the triangle? (Moeller & Trumbore 1997)
bool crosses(const Vec3& p, const Vec3& q, const Points& x, const Eigen::Vector3i& t) {
  const Vec3 a = x.col(t[0]), ab = Vec3(x.col(t[1])) - a, ac = Vec3(x.col(t[2])) - a, d = q - p;
  const Vec3 h = d.cross(ac), s = p - a;
  const double determinant = ab.dot(h);
  if (determinant == 0) return false;  // parallel
  const double u = s.dot(h) / determinant;
  if (u < 0 || u > 1) return false;
  const Vec3 g = s.cross(ab);
  const double v = d.dot(g) / determinant, w = ac.dot(g) / determinant;
  return v >= 0 && u + v <= 1 && w >= 0 && w <= 1;
}

bool has_corner(const Eigen::Vector3i& t, int v) { return t[0] == v || t[1] == v || t[2] == v; }

// The fan with the normals of its ends, and the triangles that a segment may meet.
struct FanSurroundings {
  const OpenFan& fan;
  Vec3 tip;
  Points normals;              // towards the ventricle, of the ends
  std::vector<int> triangles;  // that reach into the box of all places that are tried

  FanSurroundings(const OpenFan& of, const Vec3& at, double reach) : fan(of), tip(at) {
    const Points& x = fan.leaflets.vertices;
    const Points ends = x(Eigen::all, fan.vertices);
    const Vec3 low = ends.rowwise().minCoeff().cwiseMin((tip.array() - reach).matrix());
    const Vec3 high = ends.rowwise().maxCoeff().cwiseMax((tip.array() + reach).matrix());
    normals = Points::Zero(3, ends.cols());
    for (int t = 0; t < fan.leaflets.triangle_count(); ++t) {
      const Eigen::Vector3i corners = fan.leaflets.triangles.col(t);
      for (size_t i = 0; i < fan.vertices.size(); ++i)
        if (has_corner(corners, fan.vertices[i]))
          normals.col(static_cast<int>(i)) += area_vector(x, corners).normalized();
      const Eigen::Matrix3d at_corners = x(Eigen::all, corners);
      if ((at_corners.rowwise().maxCoeff().array() >= low.array()).all() &&
          (at_corners.rowwise().minCoeff().array() <= high.array()).all())
        triangles.push_back(t);
    }
    normals.colwise().normalize();
  }

  bool leaves_to_the_ventricle(const Vec3& junction) const {
    constexpr double kLeastRise = 0.1;  // of a branch above the leaflet, sine of the angle at its end
    for (size_t i = 0; i < fan.vertices.size(); ++i) {
      const Vec3 branch = junction - fan.leaflets.vertices.col(fan.vertices[i]);
      if (fan.is_inside[i] && branch.dot(normals.col(static_cast<int>(i))) < kLeastRise * branch.norm())
        return false;
    }
    return true;
  }

  bool misses_leaflets(const Vec3& junction) const {
    const Points& x = fan.leaflets.vertices;
    return std::none_of(triangles.begin(), triangles.end(), [&](int t) {
      const Eigen::Vector3i corners = fan.leaflets.triangles.col(t);
      if (crosses(tip, junction, x, corners)) return true;
      return std::any_of(fan.vertices.begin(), fan.vertices.end(), [&](int v) {
        return !has_corner(corners, v) && crosses(junction, x.col(v), x, corners);
      });
    });
  }

  bool is_clear(const Vec3& junction) const {
    return leaves_to_the_ventricle(junction) && misses_leaflets(junction);
  }
};

// What is minimised: the distance from the start, and far above it what a segment lacks in length.
double cost(const Vec3& place, const Vec3& start, const JunctionLimits& limits) {
  constexpr double kLengthWeight = 1000;
  double excess = 0;
  for (int i = 0; i < limits.ends.cols(); ++i)
    excess =
        std::max(excess, (place - limits.ends.col(i)).norm() - limits.rest_lengths[static_cast<size_t>(i)]);
  return (place - start).norm() + kLengthWeight * excess;
}

struct Place {
  Vec3 at;
  double cost;
};

// Places of a cubic grid of 2 n + 1 points a side, the cheap ones first.
std::vector<Place> grid_around(const Vec3& centre, double spacing, int n, const Vec3& start,
                               const JunctionLimits& limits) {
  std::vector<Place> places;
  for (int i = -n; i <= n; ++i)
    for (int j = -n; j <= n; ++j)
      for (int k = -n; k <= n; ++k) {
        const Vec3 at = centre + spacing * Vec3(i, j, k);
        places.push_back({at, cost(at, start, limits)});
      }
  std::stable_sort(places.begin(), places.end(),
                   [](const Place& a, const Place& b) { return a.cost < b.cost; });
  return places;
}

}  // namespace

Vec3 place_clear_junction(const Vec3& start, const JunctionLimits& limits, const OpenFan& fan) {
  constexpr int kSteps = 12;       // of the first grid, from its middle to its side
  constexpr int kRefinements = 5;  // grids of half the spacing around the best place
  constexpr double kReach = 1.25;  // of the first grid, in lengths of the trunk
  const Vec3 tip = limits.ends.col(0);
  const double reach = kReach * limits.rest_lengths[0];
  const FanSurroundings surroundings(fan, tip, reach);
  if (surroundings.is_clear(start)) return start;
  std::optional<Place> best;
  const auto look = [&](const Vec3& centre, double spacing, int n) {
    for (const Place& place : grid_around(centre, spacing, n, start, limits)) {
      if (best && place.cost >= best->cost) return;
      if (!surroundings.is_clear(place.at)) continue;
      best = place;
      return;
    }
  };
  double spacing = reach / kSteps;
  look(tip, spacing, kSteps);
  if (!best) return start;
  for (int i = 0; i < kRefinements; ++i) look(best->at, spacing /= 2, 2);
  return best->at;
}

}  // namespace coapt
