// Nonlinear and fibrous membranes written anew from their definitions: C from the images of the fibre and of
// the direction across it, invariants from its entries, incompressibility and the change of volume by hand.
#pragma once

#include "support/autodiff.hpp"
#include "support/crimped_oracle.hpp"
#include "support/oracles.hpp"

#include <array>
#include <vector>

namespace coapt::oracle {

// Right Cauchy-Green tensor in the plane, first axis along the fibre.
template <typename T>
struct PlaneMetric {
  T ff, cc, fc;
};

template <typename T>
AutoVec<T> image(const Vec3& direction, const Points& X, const Eigen::Vector3i& t,
                 const std::vector<AutoVec<T>>& x) {
  Eigen::Matrix<double, 3, 2> edges;
  edges << X.col(t[1]) - X.col(t[0]), X.col(t[2]) - X.col(t[0]);
  const Eigen::Vector2d c = edges.colPivHouseholderQr().solve(direction);
  const AutoVec<T> d1 = x[t[1]] - x[t[0]], d2 = x[t[2]] - x[t[0]];
  AutoVec<T> sum;
  for (int k = 0; k < 3; ++k) sum[k] = T(times(c[0], d1[k]) + times(c[1], d2[k]));
  return sum;
}

// The sum over triangles of area x thickness x density(C).
template <typename Density>
struct Tissue {
  Triangles triangles;
  Points X;
  Vec3 fibre;
  double thickness;
  Density density;

  template <typename T>
  T operator()(const std::vector<AutoVec<T>>& x) const {
    T energy = T(0.0);
    for (Eigen::Index k = 0; k < triangles.cols(); ++k) {
      const Eigen::Vector3i t = triangles.col(k);
      const Vec3 normal = (X.col(t[1]) - X.col(t[0])).cross(X.col(t[2]) - X.col(t[0])),
                 n = normal.normalized();
      const Vec3 along = (fibre - n.dot(fibre) * n).normalized(), across = n.cross(along);
      const AutoVec<T> f = image(along, X, t, x), c = image(across, X, t, x);
      const PlaneMetric<T> metric{dot(f, f), dot(c, c), dot(f, c)};
      energy = T(energy + times(0.5 * normal.norm() * thickness, density(metric)));
    }
    return energy;
  }
};

template <typename T>
T determinant(const PlaneMetric<T>& c) {
  const T product = c.ff * c.cc, shear = squared(c.fc);
  return T(product - shear);
}

// I1 - 3 at constant volume.
template <typename T>
T distortion(const PlaneMetric<T>& c) {
  const T thin = T(T(1.0) / determinant(c)), plane = T(c.ff + c.cc);
  return T(T(plane + thin) - T(3.0));
}

template <typename T>
std::array<T, 2> principal_stretches(const PlaneMetric<T>& c) {
  using std::sqrt;
  const T mean = times(0.5, T(c.ff + c.cc)), square = T(squared(mean) - determinant(c)),
          radius = T(sqrt(square));
  const T major = T(mean + radius), minor = T(mean - radius);
  return {T(sqrt(major)), T(sqrt(minor))};
}

template <typename T>
T exponential(const T& a) {
  using std::exp;
  return T(exp(a));
}

// A modulus that sets in at a knee, by its three pieces.
template <typename T>
T knee_energy(const T& strain, double modulus, double transition, double window) {
  const T past = T(strain - T(transition));
  if (number(past) <= -window) return T(0.0);
  if (number(past) >= window) return times(modulus, T(times(0.5, squared(past)) + T(window * window / 6)));
  return times(modulus / (12 * window), power(T(past + T(window)), 3));
}

struct Exponential {
  double c0, c1, c2;
  template <typename T>
  T grown(const T& j) const {
    return exponential(times(c2, squared(j)));
  }
  template <typename T>
  T of(const T& j) const {
    return T(times(0.5 * c0, j) + times(0.5 * c1, T(grown(j) - T(1.0))));
  }
  template <typename T>
  T slope(const T& j) const {
    const T rise = j * grown(j);
    return T(T(0.5 * c0) + times(c1 * c2, rise));
  }
  template <typename T>
  T operator()(const PlaneMetric<T>& c) const {
    return of(distortion(c));
  }
};

struct NeoHookean {
  double mu;
  template <typename T>
  T of(const T& j) const {
    return times(0.5 * mu, j);
  }
  template <typename T>
  T slope(const T&) const {
    return T(0.5 * mu);
  }
  template <typename T>
  T operator()(const PlaneMetric<T>& c) const {
    return of(distortion(c));
  }
};

// A function of the first invariant with the change of volume J that makes the energy least. It is found by
// Newton's method on the exact dW/dJ in the scalar T: each step carries the derivatives of J along.
template <typename Invariant>
struct Compressible {
  Invariant part;
  double bulk;

  // plane: C11 + C22; thin: 1/det C.
  template <typename T>
  T energy_at(const T& plane, const T& thin, const T& j) const {
    const T volume = squared(T(j - T(1.0)));
    return T(part.of(distortion_at(plane, thin, j)) + times(0.5 * bulk, volume));
  }
  template <typename T>
  T slope_at(const T& plane, const T& thin, const T& j) const {
    const T psi = part.slope(distortion_at(plane, thin, j)), wide = T(plane / j), thick = T(j * thin);
    const T rise = T(times(4.0 / 3, thick) - times(2.0 / 3, wide)), scaled = T(scale(j) * rise);
    return T(T(psi * scaled) + times(bulk, T(j - T(1.0))));
  }
  template <typename T>
  T operator()(const PlaneMetric<T>& c) const {
    const T plane = T(c.ff + c.cc), thin = T(T(1.0) / determinant(c));
    const auto slope = [&](double j) { return slope_at(number(plane), number(thin), j); };
    T j = T(1.0);
    for (int k = 0; k < 30; ++k) {
      const double h = 1e-5, at = number(j), curvature = (slope(at + h) - slope(at - h)) / (2 * h);
      j = T(j - times(1 / curvature, slope_at(plane, thin, j)));
    }
    return energy_at(plane, thin, j);
  }

 private:
  // J^(-2/3)
  template <typename T>
  static T scale(const T& j) {
    using std::log;
    return exponential(times(-2.0 / 3, T(log(j))));
  }
  template <typename T>
  static T distortion_at(const T& plane, const T& thin, const T& j) {
    const T square = squared(j), thick = T(square * thin), sum = T(plane + thick), i = T(scale(j) * sum);
    return T(i - T(3.0));
  }
};

struct Bilinear {
  double young, post, transition, window, poisson;
  template <typename T>
  T operator()(const PlaneMetric<T>& c) const {
    const std::array<T, 2> l = principal_stretches(c);
    const T e1 = T(l[0] - T(1.0)), e2 = T(l[1] - T(1.0)), product = e1 * e2;
    const T squares = T(squared(e1) + squared(e2));
    const T linear = times(young / (2 * (1 - poisson * poisson)), T(squares + times(2 * poisson, product)));
    return T(linear + T(knee_energy(e1, post - young, transition, window) +
                        knee_energy(e2, post - young, transition, window)));
  }
};

struct Orthotropic {
  double fibre_young, fibre_post, fibre_transition, cross_young, cross_post, cross_transition, window,
      poisson, shear;
  template <typename T>
  T operator()(const PlaneMetric<T>& c) const {
    using std::sqrt;
    const T lf = T(sqrt(c.ff)), lc = T(sqrt(c.cc));
    const T f = T(lf - T(1.0)), x = T(lc - T(1.0)), product = f * x;
    const double share = 1 / (2 * (1 - poisson * poisson));
    const T squares = T(times(fibre_young, squared(f)) + times(cross_young, squared(x)));
    const T linear =
        times(share, T(squares + times(2 * poisson * std::sqrt(fibre_young * cross_young), product)));
    const T knees = T(knee_energy(f, fibre_post - fibre_young, fibre_transition, window) +
                      knee_energy(x, cross_post - cross_young, cross_transition, window));
    return T(T(linear + knees) + times(0.5 * shear, squared(c.fc)));
  }
};

struct MayNewmanYin {
  double c0, c1, c2;
  template <typename T>
  T operator()(const PlaneMetric<T>& c) const {
    using std::sqrt;
    const T l = T(sqrt(c.ff)), q = T(times(c1, squared(distortion(c))) + times(c2, power(T(l - T(1.0)), 4)));
    return times(c0, T(exponential(q) - T(1.0)));
  }
};

// Fibres splayed about the first axis in a matrix of constant volume.
struct Crimped {
  double mu;
  CrimpedCurve fibre;
  double splay;
  template <typename T>
  T operator()(const PlaneMetric<T>& c) const {
    using std::sqrt;
    const double along = mean_square_cosine(splay);
    const T square = T(times(along, c.ff) + times(1 - along, c.cc)), l = T(sqrt(square));
    return T(times(0.5 * mu, distortion(c)) + fibre.energy(l));
  }
};

// Two populations of fibres dispersed in space, an active part of the first; the thickness follows from the
// constant volume.
struct CrimpedPopulations {
  double mu;
  CrimpedCurve fibre;
  double splay, out_of_plane, share, angle, active;

  Eigen::Matrix3d dispersion(double at) const { return mean_of_directions(splay, out_of_plane, at); }
  template <typename T>
  T stretch(const Eigen::Matrix3d& k, const PlaneMetric<T>& c) const {
    using std::sqrt;
    const T thin = T(T(1.0) / determinant(c)), plane = T(times(k(0, 0), c.ff) + times(k(1, 1), c.cc));
    const T other = T(times(2 * k(0, 1), c.fc) + times(k(2, 2), thin)), square = T(plane + other);
    return T(sqrt(square));
  }
  static constexpr double kReach = 0.02;  // elongation over which the active stress sets in
  template <typename T>
  T pulled(const T& l) const {
    if (number(l) <= 1) return T(0.0);
    const T e = T(l - T(1.0)), decayed = exponential(times(-1 / kReach, e));
    return times(active, T(e + times(kReach, T(decayed - T(1.0)))));
  }
  template <typename T>
  T operator()(const PlaneMetric<T>& c) const {
    const T first = stretch(dispersion(0), c), second = stretch(dispersion(angle), c);
    const T passive = T(fibre.energy(first) + times(share, fibre.energy(second)));
    return T(times(0.5 * mu, distortion(c)) + T(passive + pulled(first)));
  }
};

}  // namespace coapt::oracle
