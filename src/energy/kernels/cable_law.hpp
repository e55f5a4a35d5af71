// Cable of a nonlinear law (energy/laws/line_laws.hpp) that carries tension only.
//   W = A r w(e),   F = A s(e),   e = l/r - 1,   l = |x1 - x0|
// A cross-section at rest [length^2], r rest length [length], w and s = w' energy per volume and nominal
// stress of the law. The onset of tension is rounded over an elongation of s0 r: below s0 the stress is the
// cubic that leaves zero with slope zero and meets the law at s0 with its slope (for a linear law that of
// cable.hpp), or, for a law that rises so steeply there that the cubic would fall on the way, the power of e
// that does the same. Slack cables feel nothing, beyond s0 the force is the law's. Twice continuously
// differentiable for s0 > 0. Never throws.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/laws/line_laws.hpp"
#include "energy/term.hpp"

#include <algorithm>
#include <cmath>

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
    CurveValue end;    // of the law at s0
    double onset = 0;  // what the rounding adds to the law's energy beyond s0 [stress]
  };

  static Rest rest(double length, double area, double smoothing, const Law& law) {
    Rest rest{length, area, smoothing, law, {}, 0};
    if (smoothing > 0) {
      rest.end = law.at(smoothing);
      rest.onset = onset(rest, smoothing).energy - rest.end.energy;
    }
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
    const CurveValue w = onset(rest, e);
    return {volume * w.energy, rest.area * w.stress, rest.area / rest.length * w.stiffness};
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
  // The rounded law at 0 < e <= s0.
  static CurveValue onset(const Rest& rest, double e) {
    const double s0 = rest.smoothing, s = rest.end.stress, slope = rest.end.stiffness * s0, u = e / s0;
    if (slope > 3 * s) {
      const double power = slope / s, stress = s * std::pow(u, power);
      return {stress * e / (power + 1), stress, power * stress / e};
    }
    return {s0 * u * u * u * (s * (1 - u / 2) + slope * (u / 4 - 1.0 / 3)),
            u * u * (s * (3 - 2 * u) + slope * (u - 1)), u * (6 * s * (1 - u) + slope * (3 * u - 2)) / s0};
  }
};

using CableBilinear = CableLaw<BilinearLine>;
using CableOgden = CableLaw<OgdenLine>;
using CableToe = CableLaw<ToeLine>;
using CableCrimpedFibre = CableLaw<CrimpedLine>;

}  // namespace coapt
