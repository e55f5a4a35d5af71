// Cable of a nonlinear law (energy/laws/line_laws.hpp) that carries tension only.
//   W = A r w(p(l/r - 1)) summed up from its force A s(p(e)),   l = |x1 - x0|
// A cross-section at rest [length^2], r rest length [length], s nominal stress of the law. The onset of
// tension is rounded over an elongation of s0 r as in cable.hpp: p(e) = e for e > s0, e (2 - e/s0) e/s0 below,
// 0 for a slack cable. Twice continuously differentiable for s0 > 0. Never throws.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/laws/line_laws.hpp"
#include "energy/term.hpp"

#include <algorithm>

namespace coapt {

template <typename Law>
struct CableLawName;
template <>
struct CableLawName<BilinearLine> {
  static constexpr std::string_view kType = "cable_bilinear";
};
template <>
struct CableLawName<OgdenLine> {
  static constexpr std::string_view kType = "cable_ogden";
};
template <>
struct CableLawName<ToeLine> {
  static constexpr std::string_view kType = "cable_toe";
};
template <>
struct CableLawName<CrimpedLine> {
  static constexpr std::string_view kType = "cable_crimped_fibre";
};

template <typename Law>
struct CableLaw {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = CableLawName<Law>::kType;
  static constexpr TermRole kRole = TermRole::Internal;

  struct Rest {
    double length = 0;     // r
    double area = 0;       // A
    double smoothing = 0;  // s0, a share of the length
    Law law;
    double onset = 0;  // energy at elongation s0, less than that of the sharp law [stress]
  };

  static Rest rest(double length, double area, double smoothing, const Law& law) {
    Rest rest{length, area, smoothing, law, 0};
    rest.onset = smoothing > 0 ? rounded_energy(rest, smoothing) - law.at(smoothing).energy : 0;
    return rest;
  }

  // The same cable with the onset of its tension rounded over at least this share of its length.
  static Rest rounded(const Rest& given, double share) {
    return rest(given.length, given.area, std::max(given.smoothing, share), given.law);
  }

  // Energy, force and stiffness at elongation e = l/r - 1.
  static AxialLaw elastic(const Rest& rest, double e) {
    if (e <= 0) return {};
    const double volume = rest.area * rest.length;
    if (e >= rest.smoothing) {
      const CurveValue w = rest.law.at(e);
      return {volume * (w.energy + rest.onset), rest.area * w.stress, rest.area / rest.length * w.stiffness};
    }
    const double u = e / rest.smoothing;
    const CurveValue w = rest.law.at(e * u * (2 - u));
    return {volume * rounded_energy(rest, e), rest.area * w.stress,
            rest.area / rest.length * w.stiffness * u * (4 - 3 * u)};
  }

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    const Vec3 difference = x.tail<3>() - x.head<3>();
    const double l = difference.norm();
    const AxialLaw law = elastic(rest, l / rest.length - 1);
    expand_axial(law, difference, l, g, H);
    return law.energy;
  }

  // Force and stiffness are never negative, so neither is the exact Hessian.
  static double evaluate_projected(const Rest& rest, const Eigen::Vector<double, 6>& x,
                                   Eigen::Vector<double, 6>* g, Eigen::Matrix<double, 6, 6>* H) {
    return evaluate(rest, x, g, H);
  }

 private:
  // Integral of s(p(e)) from 0, by Gauss's rule of five points: p is cubic and the window narrow.
  static double rounded_energy(const Rest& rest, double e) {
    static constexpr double kAt[] = {-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                     0.9061798459386640};
    static constexpr double kWeight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                         0.4786286704993665, 0.2369268850561891};
    double sum = 0;
    for (int k = 0; k < 5; ++k) {
      const double at = 0.5 * e * (1 + kAt[k]), u = at / rest.smoothing;
      sum += kWeight[k] * rest.law.at(at * u * (2 - u)).stress;
    }
    return 0.5 * e * sum;
  }
};

using CableBilinear = CableLaw<BilinearLine>;
using CableOgden = CableLaw<OgdenLine>;
using CableToe = CableLaw<ToeLine>;
using CableCrimpedFibre = CableLaw<CrimpedLine>;

}  // namespace coapt
