#include "energy/contact/pair_barrier.hpp"

#include "energy/project_psd.hpp"
#include "mesh/distance/triangle_distance.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Adds value * (a (x) u)(b (x) v)^T.
void add_outer(double value, const Eigen::Vector4d& a, const Vec3& u, const Eigen::Vector4d& b, const Vec3& v,
               PairMatrix& H) {
  const Eigen::Matrix3d uv = value * u * v.transpose();
  for (int j = 0; j < 4; ++j) {
    if (b[j] == 0) continue;
    for (int i = 0; i < 4; ++i)
      if (a[i] != 0) H.block<3, 3>(3 * i, 3 * j) += a[i] * b[j] * uv;
  }
}

// Makes the tangents orthonormal and the weights' derivatives along them orthogonal to each other.
struct Sliding {
  int count = 0;
  Eigen::Matrix<double, 3, 2> tangent;
  Eigen::Matrix<double, 4, 2> weights;
};

Sliding orthonormal_sliding(const PairCorners& x, const ClosestPair& closest) {
  Sliding s;
  s.count = closest.slides;
  s.weights = closest.slide;
  for (int j = 0; j < s.count; ++j) {  // Gram-Schmidt
    if (j == 1) {
      const Vec3 second = x * s.weights.col(1);
      s.weights.col(1) -= s.tangent.col(0).dot(second) * s.weights.col(0);
    }
    const Vec3 tangent = x * s.weights.col(j);
    const double length = tangent.norm();
    if (length == 0) {
      s.count = j;
      return s;
    }
    s.tangent.col(j) = tangent / length;
    s.weights.col(j) /= length;
  }
  if (s.count < 2) return s;
  // Jacobi rotation that diagonalises the weights' Gram matrix.
  const double angle = 0.5 * std::atan2(2 * s.weights.col(0).dot(s.weights.col(1)),
                                        s.weights.col(0).squaredNorm() - s.weights.col(1).squaredNorm());
  Eigen::Matrix2d turn;
  turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
  s.tangent = (s.tangent * turn).eval();
  s.weights = (s.weights * turn).eval();
  return s;
}

// slope and curvature: of the energy with respect to the distance.
void add_hessian(const PairCorners& x, const ClosestPair& closest, double slope, double curvature,
                 Projection projection, PairMatrix& H) {
  const Eigen::Vector4d& w = closest.weights;
  const double d = closest.distance, pull = -slope;
  const Vec3 n = x * w / d;
  add_outer(curvature, w, n, w, n, H);
  const Sliding sliding = orthonormal_sliding(x, closest);
  for (int j = 0; j < sliding.count; ++j) {
    const Vec3 tau = sliding.tangent.col(j);
    const Eigen::Vector4d e = sliding.weights.col(j);
    if (projection == Projection::None) {
      add_outer(pull, w, tau, e, n, H);
      add_outer(pull, e, n, w, tau, H);
      add_outer(pull * d, e, n, e, n, H);
      continue;
    }
    // The matrix [0 b; b c] in the plane of the unit vectors along W (x) tau and E (x) n.
    const double w_norm = w.norm(), e_norm = e.norm();
    const double b = pull * w_norm * e_norm, c = pull * d * e_norm * e_norm;
    const double eigenvalue = 0.5 * c + std::hypot(0.5 * c, b);
    if (!(eigenvalue > 0)) continue;
    const double length = std::hypot(b, eigenvalue);
    const double along_w = b / length / w_norm, along_e = eigenvalue / length / e_norm;
    add_outer(eigenvalue * along_w * along_w, w, tau, w, tau, H);
    add_outer(eigenvalue * along_w * along_e, w, tau, e, n, H);
    add_outer(eigenvalue * along_w * along_e, e, n, w, tau, H);
    add_outer(eigenvalue * along_e * along_e, e, n, e, n, H);
  }
  if (projection != Projection::None || sliding.count == 2) return;
  Eigen::Matrix3d left = Eigen::Matrix3d::Identity() - n * n.transpose();
  for (int j = 0; j < sliding.count; ++j) left -= sliding.tangent.col(j) * sliding.tangent.col(j).transpose();
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) H.block<3, 3>(3 * i, 3 * j) += slope / d * w[i] * w[j] * left;
}

// c = |u x v|^2 of the two edges, and its derivatives by the four corners.
struct CrossSquared {
  double value;
  PairVector gradient;
  PairMatrix hessian;
};

double cross_squared(const PairCorners& x) {
  return Vec3(x.col(1) - x.col(0)).cross(Vec3(x.col(3) - x.col(2))).squaredNorm();
}

CrossSquared differentiate_cross_squared(const PairCorners& x) {
  const Vec3 u = x.col(1) - x.col(0), v = x.col(3) - x.col(2);
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  CrossSquared c;
  c.value = cross_squared(x);
  const Vec3 by_u = 2 * (vv * u - uv * v), by_v = 2 * (uu * v - uv * u);
  c.gradient << -by_u, by_u, -by_v, by_v;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d h_uu = 2 * (vv * I - v * v.transpose()), h_vv = 2 * (uu * I - u * u.transpose());
  const Eigen::Matrix3d h_uv = 2 * (2 * u * v.transpose() - uv * I - v * u.transpose());
  const double sign[] = {-1, 1, -1, 1};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      Eigen::Matrix3d block = j < 2 ? h_uu : h_uv;
      if (i >= 2 && j < 2) block = h_uv.transpose();
      if (i >= 2 && j >= 2) block = h_vv;
      c.hessian.block<3, 3>(3 * i, 3 * j) = sign[i] * sign[j] * block;
    }
  return c;
}

PairVector distance_gradient(const PairCorners& x, const ClosestPair& closest) {
  const Vec3 n = x * closest.weights / closest.distance;
  PairVector g;
  for (int a = 0; a < 4; ++a) g.segment<3>(3 * a) = closest.weights[a] * n;
  return g;
}

// The offset of the scene must not eat the digits of a small gap.
PairCorners from_first_corner(const PairCorners& x) { return x.colwise() - Vec3(x.col(0)); }

ClosestPair closest_point_triangle(const PairCorners& x) {
  const ClosestOnTriangle found = closest_on_triangle(x.col(0), x.col(1), x.col(2), x.col(3));
  ClosestPair pair;
  pair.weights << 1, -found.weights;
  int inside[3], count = 0;
  for (int k = 0; k < 3; ++k)
    if (found.weights[k] > 0) inside[count++] = k + 1;
  pair.slides = count - 1;
  pair.slide.setZero();
  for (int j = 0; j < pair.slides; ++j) {
    pair.slide(inside[0], j) = 1;
    pair.slide(inside[j + 1], j) = -1;
  }
  pair.distance = std::sqrt(found.distance_squared);
  return pair;
}

ClosestPair closest_edge_edge(const PairCorners& x) {
  const ClosestOnSegments found = closest_on_segments(x.col(0), x.col(1), x.col(2), x.col(3));
  ClosestPair pair;
  pair.weights << 1 - found.s, found.s, found.t - 1, -found.t;
  pair.slide.setZero();
  if (found.s > 0 && found.s < 1) pair.slide.col(pair.slides++) << -1, 1, 0, 0;
  if (found.t > 0 && found.t < 1) pair.slide.col(pair.slides++) << 0, 0, 1, -1;
  pair.distance = std::sqrt(found.distance_squared);
  return pair;
}

}  // namespace

ClosestPair closest_points(PairKind kind, const PairCorners& x) {
  const PairCorners local = from_first_corner(x);
  return kind == PairKind::PointTriangle ? closest_point_triangle(local) : closest_edge_edge(local);
}

double pair_distance(PairKind kind, const PairCorners& x) {
  const PairCorners local = from_first_corner(x);
  return std::sqrt(
      kind == PairKind::PointTriangle
          ? closest_on_triangle(local.col(0), local.col(1), local.col(2), local.col(3)).distance_squared
          : closest_on_segments(local.col(0), local.col(1), local.col(2), local.col(3)).distance_squared);
}

BarrierValue barrier(double s) {
  if (s >= 1) return {0, 0, 0};
  const double u = 1 - s, log = std::log(s);
  return {-u * u * log, 2 * u * log - u * u / s, -2 * log + 4 * u / s + u * u / (s * s)};
}

double evaluate_barrier(const BarrierRest& rest, const PairCorners& corners, const ClosestPair& closest,
                        Projection projection, PairVector* g, PairMatrix* H) {
  if (!(closest.distance > 0)) {
    if (g != nullptr) g->setConstant(kNaN);
    if (H != nullptr) H->setConstant(kNaN);
    return kInfinity;
  }
  const PairCorners x = from_first_corner(corners);
  const BarrierValue phi = barrier(closest.distance / rest.range);
  const double energy = rest.strength * phi.energy, slope = rest.strength / rest.range * phi.slope,
               curvature = rest.strength / (rest.range * rest.range) * phi.curvature;
  const bool is_turned_down = rest.kind == PairKind::EdgeEdge && cross_squared(x) < rest.parallel;
  if (g != nullptr) *g = slope * distance_gradient(x, closest);
  if (H != nullptr) {
    H->setZero();
    add_hessian(x, closest, slope, curvature, is_turned_down ? Projection::None : projection, *H);
  }
  if (!is_turned_down) return energy;

  const double left = 1 - cross_squared(x) / rest.parallel;
  const double m = 1 - left * left * left, dm = 3 * left * left / rest.parallel,
               ddm = -6 * left / (rest.parallel * rest.parallel);
  if (g == nullptr) return m * energy;
  const CrossSquared c = differentiate_cross_squared(x);
  if (H != nullptr) {
    *H = m * *H + dm * (*g * c.gradient.transpose() + c.gradient * g->transpose()) +
         energy * (ddm * c.gradient * c.gradient.transpose() + dm * c.hessian);
    if (projection == Projection::PositiveSemidefinite) project_psd(*H);
  }
  *g = m * *g + energy * dm * c.gradient;
  return m * energy;
}

}  // namespace coapt
