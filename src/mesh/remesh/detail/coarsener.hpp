// How coarsen() works: rounds of edge collapses and of edge flips on one mesh. Private to this room.
#pragma once

#include "mesh/remesh/coarsen.hpp"

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

namespace coapt::coarsening {

using Corners = Eigen::Vector3i;

inline constexpr size_t kMostNeighbours = 9;  // of a vertex, after a collapse or a flip
inline constexpr size_t kLeastTriangles = 4;  // around an inner vertex that loses one
inline constexpr double kNormalCosine = 0.5;  // between the normals of a triangle before and after

template <typename T>
T& at(std::vector<T>& list, int i) {
  return list[static_cast<size_t>(i)];
}
template <typename T>
const T& at(const std::vector<T>& list, int i) {
  return list[static_cast<size_t>(i)];
}

inline bool has_corner(const Corners& t, int v) { return t[0] == v || t[1] == v || t[2] == v; }

// 1 for an equilateral triangle, 0 for one without area.
inline double quality(const Vec3& a, const Vec3& b, const Vec3& c, double area_doubled) {
  const double sum = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return sum > 0 ? 2 * std::sqrt(3.0) * area_doubled / sum : 0;
}

// What collapses of a vertex have in common: its neighbours, and its triangles before.
struct Star {
  std::vector<int> ring;
  std::vector<Vec3> normals;  // of the triangles in the order of `around_`, length twice the area
  double worst = 1;           // quality of its triangles
};

// Without the digits that a rotation changes, so that what is equal but for round-off counts as equal.
inline double leading_digits(double value) {
  constexpr double kUnit = 1 << 30;
  int exponent = 0;
  const double fraction = std::frexp(value, &exponent);
  return std::ldexp(std::round(kUnit * fraction) / kUnit, exponent);
}

// One vertex may go into the other. Collapses that make the same worst triangle have the same cost; then the
// shorter edge goes first. Both without their last digits.
struct Collapse {
  double cost = 0, length = 0;
  int vertex = 0, into = 0;

  bool is_before(const Collapse& other) const {
    return std::tie(cost, length, vertex, into) <
           std::tie(other.cost, other.length, other.vertex, other.into);
  }
};

class Coarsener {
 public:
  Coarsener(const TriangleMesh& mesh, const CoarsenOptions& options);

  int triangle_count() const { return triangle_count_; }

  void run(int wanted);  // until so many triangles are left, or a round removes too few

  Coarsening result(const TriangleMesh& fine) const;

 private:
  void lay_lines(const TriangleMesh& mesh, const CoarsenOptions& options);
  void lock(const CoarsenOptions& options);
  void add_line(int a, int b);
  bool is_on_line(int v) const { return at(line_, v)[0] >= 0; }
  bool is_line(int a, int b) const { return at(line_, a)[0] == b || at(line_, a)[1] == b; }
  const std::vector<int>& ring(int v);
  void look_at(int v);

  std::optional<Collapse> best_collapse(int v);
  std::optional<double> cost_of(int v, int u, double most);
  bool keeps_manifold(int v, int u);
  void collapse_round(int wanted);
  void collapse(int v, int u);
  void flip_round();
  bool flip(int t, int k);
  int across(int t, int a, int b) const;
  double opposite_cotangents(int t, int s, int a, int b) const;
  void rehouse(const std::vector<int>& homeless, const std::vector<int>& homes);

  Vec3 normal(const Corners& t) const {
    return (x_.col(t[1]) - x_.col(t[0])).cross(x_.col(t[2]) - x_.col(t[0]));
  }

  const Points& x_;
  const std::vector<int>& regions_;
  int triangle_count_;
  std::vector<Corners> triangles_;        // -1 in the first place: gone
  std::vector<std::vector<int>> around_;  // triangles of each vertex
  std::vector<std::vector<int>> guests_;  // vertices that are gone, by triangle
  std::vector<std::array<int, 2>> line_;  // neighbours along the line that a vertex is on; -1: none
  std::vector<char> is_locked_;
  std::vector<int> kinds_;
  Vector size_;             // mean length of the edges at each vertex in the fine mesh
  double longest_squared_;  // of new edges, relative to those of the fine mesh
  Star star_;               // of the vertex that is looked at
  std::vector<int> mark_, second_mark_;
  int stamp_ = 0, second_stamp_ = 0;
};

}  // namespace coapt::coarsening
