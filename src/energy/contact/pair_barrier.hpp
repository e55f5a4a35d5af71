// The barrier of one pair of mesh features, point-triangle or edge-edge, with exact derivatives wherever
// their closest points lie.
//
//   W = k phi(d / r),  phi(s) = -(1 - s)^2 ln s for s < 1, else 0
//
// Source: Li et al. 2020, eq. 6, here in d instead of d^2.
// d is the distance, r the range. phi is C2 at s = 1 and grows without bound as s goes to 0.
//
// All cases are one: the closest points are differences of the four nodes, r = sum_a w_a(t) x_a, linear in
// the parameters t along which they can slide (two inside a triangle or two edges, one along an edge against
// a point, none between two points). With tangents made orthonormal, n = r/d, W the weights, E_j = dw/dt_j,
//   grad d    = W (x) n
//   d Hess d  = W W^T (x) P
//               - sum_j d [ (W (x) tau_j) (E_j (x) n)^T + its transpose + d (E_j (x) n) (E_j (x) n)^T ]
// where P projects on what is left besides n and the tangents. Of k (phi'' grad grad^T / r^2 + phi'/r Hess),
// phi' <= 0, the positive semidefinite part is known in closed form: the first summand, and of each bracket,
// which lives in the plane of two orthogonal vectors, the positive eigenvalue.
#pragma once

#include "energy/sink.hpp"
#include "mesh/distance/pair_corners.hpp"

#include <Eigen/Dense>

#include <array>

namespace coapt {

using PairVector = Eigen::Vector<double, 12>;
using PairMatrix = Eigen::Matrix<double, 12, 12>;

enum class PairKind : char { PointTriangle, EdgeEdge };

// Closest points of the two features: their difference is corners * weights.
struct ClosestPair {
  double distance = 0;  // [length]
  Eigen::Vector4d weights;
  int slides = 0;                     // ways in which the closest points can slide: 0, 1 or 2
  Eigen::Matrix<double, 4, 2> slide;  // derivative of the weights along each of them
};

ClosestPair closest_points(PairKind kind, const PairCorners& x);

// Their distance alone, the same number [length].
double pair_distance(PairKind kind, const PairCorners& x);

// phi and its first two derivatives at s = d/r > 0; zero for s >= 1.
struct BarrierValue {
  double energy, slope, curvature;
};
BarrierValue barrier(double s);

// Data of one pair that does not change with the positions.
struct BarrierRest {
  PairKind kind = PairKind::PointTriangle;
  double range = 0;     // r [length]
  double strength = 0;  // k [force x length]
  double parallel = 0;  // edge-edge: |u x v|^2 below which the barrier is turned down, see below [length^4]
};

// Energy; +infinity at distance zero. Derivatives where wanted (null = not); Pre: no Hessian without
// gradient.
//
// The distance of two edges has a kink where they are parallel. Below `parallel` the energy is therefore
// multiplied by m(c) = 1 - (1 - c/parallel)^3, c = |u x v|^2, which takes it to zero there (after Li et al.
// 2020, section 5.2, which has a polynomial of lower order); points against the other edge's triangles
// carry the contact meanwhile.
double evaluate_barrier(const BarrierRest& rest, const PairCorners& x, const ClosestPair& closest,
                        Projection projection, PairVector* g, PairMatrix* H);

}  // namespace coapt
