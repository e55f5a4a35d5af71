// The energies written anew from their definitions, on any scalar: oracles for automatic differentiation.
// They are slow, plain, and share no formula with the kernels (invariants instead of components, nodes
// instead of shape gradients).
#pragma once

#include "support/autodiff.hpp"

#include <array>
#include <vector>

namespace coapt::oracle {

inline AutoVec<double> plain(const Vec3& v) { return {v[0], v[1], v[2]}; }

template <typename T>
T squared(const T& a) {
  return T(a * a);
}

template <typename T>
T power(const T& a, int n) {
  T result = T(1.0);
  for (int k = 0; k < n; ++k) result = T(result * a);
  return result;
}

// Green strain of a triangle from the lengths of its three sides alone: along a side of rest length L and
// current length l it is (l^2/L^2 - 1)/2, and three of them give the whole tensor.
template <typename T>
struct TriangleStrain {
  double area;  // at rest
  T trace, determinant;
};

template <typename T>
TriangleStrain<T> triangle_strain(const Points& X, const Eigen::Vector3i& c,
                                  const std::vector<AutoVec<T>>& x) {
  // Planar coordinates of the rest triangle by the law of cosines.
  const double a = (X.col(c[1]) - X.col(c[0])).norm(), b = (X.col(c[2]) - X.col(c[0])).norm();
  const double cosine = (X.col(c[1]) - X.col(c[0])).dot(X.col(c[2]) - X.col(c[0])) / (a * b);
  const double px = b * cosine, py = b * std::sqrt(1 - cosine * cosine);
  // Side s with rest vector (sx, sy): (l^2 - L^2)/2 = E11 sx^2 + E22 sy^2 + 2 E12 sx sy.
  const double side[3][2] = {{a, 0}, {px, py}, {px - a, py}};
  const AutoVec<T> current[3] = {x[c[1]] - x[c[0]], x[c[2]] - x[c[0]], x[c[2]] - x[c[1]]};
  Eigen::Matrix3d system;
  std::array<T, 3> stretch;
  for (int s = 0; s < 3; ++s) {
    system.row(s) << side[s][0] * side[s][0], side[s][1] * side[s][1], 2 * side[s][0] * side[s][1];
    const double rest_squared = side[s][0] * side[s][0] + side[s][1] * side[s][1];
    stretch[s] = times(0.5, T(dot(current[s], current[s]) - T(rest_squared)));
  }
  const Eigen::Matrix3d solve = system.inverse();
  std::array<T, 3> E;  // E11, E22, E12
  for (int k = 0; k < 3; ++k) {
    E[k] = T(0.0);
    for (int s = 0; s < 3; ++s) E[k] = T(E[k] + times(solve(k, s), stretch[s]));
  }
  const T product = E[0] * E[1], shear = squared(E[2]);
  return {0.5 * a * py, T(E[0] + E[1]), T(product - shear)};
}

// St. Venant-Kirchhoff with prestress: h E/(2(1-nu^2)) (tr(E)^2 - 2 (1-nu) det(E)) + s tr(E) per area.
struct StVenantKirchhoff {
  Triangles triangles;
  Points X;
  double young, poisson, thickness, prestress;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      const TriangleStrain<T> strain = triangle_strain(X, triangles.col(t), x);
      energy = T(energy + times(strain.area, density(strain)));
    }
    return energy;
  }

  template <typename T>
  T density(const TriangleStrain<T>& e) const {
    const T elastic = times(0.5 * thickness * young / (1 - poisson * poisson),
                            T(squared(e.trace) - times(2 * (1 - poisson), e.determinant)));
    return T(elastic + times(prestress, e.trace));
  }
};

// The relaxed law by its definition: for each principal pair the least energy over the shortening that
// wrinkles hide, which is stationary in the minor strain where that is hidden, and in both where slack.
// A fraction `residual` of the full law is kept.
struct TensionField {
  StVenantKirchhoff full;
  double residual = 0;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index t = 0; t < full.triangles.cols(); ++t) {
      const TriangleStrain<T> strain = triangle_strain(full.X, full.triangles.col(t), x);
      const T relaxed = times(1 - residual, density(strain));
      energy = T(energy + times(strain.area, T(relaxed + times(residual, full.density(strain)))));
    }
    return energy;
  }

 private:
  template <typename T>
  T density(const TriangleStrain<T>& e) const {
    using std::sqrt;
    const double modulus = full.thickness * full.young / (1 - full.poisson * full.poisson), nu = full.poisson;
    const double s = full.prestress / modulus;
    const T mean = times(0.5, e.trace);
    const T square = T(squared(mean) - e.determinant);
    const T radius = T(sqrt(square));
    const T major = T(mean + radius), minor = T(mean - radius);
    if (number(minor) + nu * number(major) + s > 0) return full.density(e);
    // The minor strain m at which the stress across the major direction M vanishes: m + nu M + s = 0.
    const T hidden = T(T(-s) - times(nu, major));
    const double slack = -s / (1 + nu);  // both strains of the stress-free sheet
    if (number(major) > slack)
      return full.density(TriangleStrain<T>{1, T(major + hidden), T(major * hidden)});
    return full.density(TriangleStrain<T>{1, T(2 * slack), T(slack * slack)});
  }
};

// Hinges (edge, edge, corner, corner) from heights and normals, in units of those at rest. `angle`: of each
// hinge at rest.
struct Hinges {
  Points X;
  Eigen::Matrix4Xi nodes;
  Vector angle;
  double stiffness;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index k = 0; k < nodes.cols(); ++k) {
      const Facet left = facet(nodes.col(k), 2), right = facet(nodes.col(k), 3);
      const AutoVec<T> m1 = height(nodes.col(k), 2, left, x), m2 = height(nodes.col(k), 3, right, x);
      const AutoVec<T> n1 = normal(nodes.col(k), 2, left, x), n2 = normal(nodes.col(k), 3, right, x);
      const double edge = (X.col(nodes(1, k)) - X.col(nodes(0, k))).norm();
      T square = T(0.0);
      for (int i = 0; i < 3; ++i) {
        const T flat = times(std::cos(angle[k] / 2), T(m1[i] + m2[i]));
        const T folded = times(std::sin(angle[k] / 2), T(n1[i] - n2[i]));
        square = T(square + squared(T(flat + folded)));
      }
      energy = T(energy + times(0.5 * stiffness * edge * edge / (left.area + right.area), square));
    }
    return energy;
  }

 private:
  struct Facet {
    double area, height, foot;  // at rest; foot: its share of the edge
  };

  // By Heron's formula and the law of cosines.
  Facet facet(const Eigen::Vector4i& n, int corner) const {
    const double edge = (X.col(n[1]) - X.col(n[0])).norm(), p = (X.col(n[corner]) - X.col(n[0])).norm(),
                 q = (X.col(n[corner]) - X.col(n[1])).norm(), half = 0.5 * (edge + p + q);
    const double area = std::sqrt(half * (half - edge) * (half - p) * (half - q));
    return {area, 2 * area / edge, 0.5 * (1 + (p * p - q * q) / (edge * edge))};
  }

  template <typename T>
  AutoVec<T> height(const Eigen::Vector4i& n, int corner, const Facet& f,
                    const std::vector<AutoVec<T>>& x) const {
    AutoVec<T> m;
    for (int i = 0; i < 3; ++i) {
      const T foot = T(times(1 - f.foot, x[n[0]][i]) + times(f.foot, x[n[1]][i]));
      m[i] = times(1 / f.height, T(x[n[corner]][i] - foot));
    }
    return m;
  }

  // Seen from the edge both corners turn the same way round, so the second normal points down.
  template <typename T>
  AutoVec<T> normal(const Eigen::Vector4i& n, int corner, const Facet& f,
                    const std::vector<AutoVec<T>>& x) const {
    AutoVec<T> cross_product = cross(AutoVec<T>(x[n[0]] - x[n[corner]]), AutoVec<T>(x[n[1]] - x[n[corner]]));
    for (T& entry : cross_product) entry = times(0.5 / f.area, entry);
    return cross_product;
  }
};

struct CubicTethers {
  Segments segments;
  double strength, length, scale;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index e = 0; e < segments.cols(); ++e) {
      const T excess = T(norm(AutoVec<T>(x[segments(1, e)] - x[segments(0, e)])) - T(length));
      if (number(excess) > 0)
        energy = T(energy + times(strength / (scale * scale * scale), power(excess, 3)));
    }
    return energy;
  }
};

struct Links {
  Segments segments;
  double stiffness, length;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index e = 0; e < segments.cols(); ++e) {
      const T excess = T(norm(AutoVec<T>(x[segments(1, e)] - x[segments(0, e)])) - T(length));
      energy = T(energy + times(stiffness / 2, power(excess, 2)));
    }
    return energy;
  }
};

// Elastic part as the integral of the rounded force 2 e^2/s - e^3/s^2, then e.
struct Cables {
  Segments segments;
  double axial_stiffness, length, smoothing, tension;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index k = 0; k < segments.cols(); ++k) {
      const T l = norm(AutoVec<T>(x[segments(1, k)] - x[segments(0, k)]));
      energy = T(energy + times(axial_stiffness / length, elastic(T(l - T(length)))));
      energy = T(energy + times(tension, l));
    }
    return energy;
  }

 private:
  template <typename T>
  T elastic(const T& e) const {
    const double s = smoothing;
    if (number(e) <= 0) return T(0.0);
    if (number(e) < s) return T(times(2 / (3 * s), power(e, 3)) - times(1 / (4 * s * s), power(e, 4)));
    const double at_s = s * s * (2.0 / 3 - 0.25);
    return T(T(at_s) + times(0.5, T(squared(e) - T(s * s))));
  }
};

// Area by Heron's formula of the squared sides: 16 A^2 = 4 a^2 b^2 - (a^2 + b^2 - c^2)^2.
struct SoapFilm {
  Triangles triangles;
  double tension;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    using std::sqrt;
    T energy = T(0.0);
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      const auto side = [&](int p, int q) {
        const AutoVec<T> d = x[triangles(q, t)] - x[triangles(p, t)];
        return dot(d, d);
      };
      const T a2 = side(0, 1), b2 = side(1, 2), c2 = side(2, 0);
      const T product = a2 * b2;
      const T sixteen = T(times(4, product) - squared(T(T(a2 + b2) - c2)));
      energy = T(energy + times(tension / 4, T(sqrt(sixteen))));
    }
    return energy;
  }
};

// -p times the volume under the surface by the divergence theorem with the field (0, 0, z):
// integral of z n_z over each facet, its mean height times its shadow on the plane z = 0. Right for closed
// surfaces only, where it equals every other choice.
struct ClosedPressure {
  Triangles triangles;
  double pressure;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T volume = T(0.0);
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      const AutoVec<T>&a = x[triangles(0, t)], &b = x[triangles(1, t)], &c = x[triangles(2, t)];
      const AutoVec<T> normal = cross(AutoVec<T>(b - a), AutoVec<T>(c - a));
      const T height = T(T(a[2] + b[2]) + c[2]);
      const T share = height * normal[2];
      volume = T(volume + times(1.0 / 6, share));
    }
    return times(-pressure, volume);
  }
};

// One facet against an origin: the determinant of its three corner vectors.
struct Tetrahedra {
  Triangles triangles;
  double pressure;
  Vec3 origin;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index t = 0; t < triangles.cols(); ++t) {
      AutoVec<T> r[3];
      for (int a = 0; a < 3; ++a)
        for (int k = 0; k < 3; ++k) r[a][k] = T(x[triangles(a, t)][k] - T(origin[k]));
      for (int k = 0; k < 3; ++k) {  // rule of Sarrus
        const T up = r[0][k] * r[1][(k + 1) % 3], down = r[0][k] * r[1][(k + 2) % 3];
        const T plus = up * r[2][(k + 2) % 3], minus = down * r[2][(k + 1) % 3];
        energy = T(energy - times(pressure / 6, T(plus - minus)));
      }
    }
    return energy;
  }
};

struct DeadForces {
  Points forces, X;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index k = 0; k < X.cols(); ++k)
      for (int c = 0; c < 3; ++c)
        energy = T(energy - times(forces(c, k), T(x[static_cast<size_t>(k)][c] - T(X(c, k)))));
    return energy;
  }
};

// Every facet pair without a common vertex or joining edge, every pair of quadrature points.
struct FacetRepulsion {
  Points X;
  Triangles triangles;
  std::vector<std::pair<int, int>> pairs;
  std::vector<std::pair<Vec3, double>> rule;  // barycentric coordinates and share of the area
  double range, strength;
  int exponent;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (const auto& [j, k] : pairs)
      for (const auto& [p, p_share] : rule)
        for (const auto& [q, q_share] : rule) {
          const AutoVec<T> from = at(x, j, p), to = at(x, k, q);
          const T d = norm(AutoVec<T>(from - to));
          if (number(d) >= range) continue;
          const double weight = strength * rest_area(j) * p_share * rest_area(k) * q_share;
          energy = T(energy + times(weight, power(T(T(1.0) - times(1 / range, d)), exponent)));
        }
    return energy;
  }

 private:
  template <typename T>
  AutoVec<T> at(const std::vector<AutoVec<T>>& x, int facet, const Vec3& barycentric) const {
    AutoVec<T> point = {T(0.0), T(0.0), T(0.0)};
    for (int a = 0; a < 3; ++a)
      for (int c = 0; c < 3; ++c) point[c] = T(point[c] + times(barycentric[a], x[triangles(a, facet)][c]));
    return point;
  }

  double rest_area(int facet) const {
    const Vec3 a = X.col(triangles(0, facet)), b = X.col(triangles(1, facet)), c = X.col(triangles(2, facet));
    const double ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm(), s = 0.5 * (ab + bc + ca);
    return std::sqrt(s * (s - ab) * (s - bc) * (s - ca));
  }
};

}  // namespace coapt::oracle
