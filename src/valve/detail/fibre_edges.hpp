// What a fibre field is computed in: frames of triangles, and doubled angles against the edges.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <complex>
#include <vector>

namespace coapt::fibres {

using Complex = std::complex<double>;
using Block = Eigen::Matrix2d;

// Unit vectors of a triangle's plane; the second is to the left of the first, seen from the normal's side.
struct Frame {
  Vec3 u, w;

  Frame(const Points& X, const Eigen::Vector3i& t)
      : u((X.col(t[1]) - X.col(t[0])).normalized()), w(area_vector(X, t).cross(u).normalized()) {}

  // Twice the angle of the part of d in the plane, its length squared: what stands for d (x) d without trace.
  Complex doubled(const Vec3& d) const {
    const Complex z(d.dot(u), d.dot(w));
    return z * z;
  }
  Vec3 direction(const Complex& doubled_angle) const {
    const double angle = 0.5 * std::arg(doubled_angle);
    return std::cos(angle) * u + std::sin(angle) * w;
  }
};

inline Complex unit(const Complex& z) { return std::abs(z) > 0 ? z / std::abs(z) : z; }

// An edge as a triangle sees it. The unknown is the doubled angle against the direction in which the first
// triangle of the edge runs along it.
struct Side {
  int unknown = 0;
  bool is_mirrored = false;  // this triangle and the first one have opposite orientations
  Complex turn;              // doubled angle of the edge in the triangle's frame

  Complex in_triangle(const Complex& z) const { return turn * (is_mirrored ? std::conj(z) : z); }
  Complex from_triangle(const Complex& z) const {
    const Complex turned = z * std::conj(turn);
    return is_mirrored ? std::conj(turned) : turned;
  }
  Block matrix() const {
    const Complex x = in_triangle({1, 0}), y = in_triangle({0, 1});
    return (Block() << x.real(), y.real(), x.imag(), y.imag()).finished();
  }
};

// The edges of the mesh, one for each region at it where regions count on their own.
struct EdgeSpace {
  std::vector<std::array<int, 2>> edges;    // per unknown, ascending: vertices a < b
  std::vector<std::vector<int>> triangles;  // per unknown
  std::vector<std::array<Side, 3>> sides;   // per triangle; k: the side opposite to corner k
  std::vector<Frame> frames;                // per triangle

  int count() const { return static_cast<int>(edges.size()); }
  // Unknowns of the edge between two vertices: [first, last).
  std::array<int, 2> between(int a, int b) const {
    const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
    const auto range = std::equal_range(edges.begin(), edges.end(), edge);
    return {static_cast<int>(range.first - edges.begin()), static_cast<int>(range.second - edges.begin())};
  }
  const Side& side(int unknown, int triangle) const {
    const auto& all = sides[static_cast<size_t>(triangle)];
    return *std::find_if(all.begin(), all.end(), [&](const Side& s) { return s.unknown == unknown; });
  }
};

// Each region on its own, or all as one.
EdgeSpace edge_space(const TriangleMesh& mesh, bool joins_regions);

}  // namespace coapt::fibres
