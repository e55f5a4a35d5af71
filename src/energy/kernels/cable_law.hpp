// Cable of a nonlinear law (energy/laws/line_laws.hpp) that carries tension only.
//   W = A r w(rho(e)),   F = A w'(rho) rho',   e = l/r - 1,   l = |x1 - x0|
// A cross-section at rest [length^2], r rest length [length], w energy per volume of the law at an
// elongation. The onset of tension is rounded over an elongation of s0 r by what the law is asked for:
//   rho = s0 u^(3/2) (15 - 10 u + 3 u^2)/8,  u = e/s0,  below s0,   rho = e beyond
// so that the force leaves zero with slope zero and meets the law at s0 with its slope. Slack cables feel
// nothing, beyond s0 the law is exact. Twice continuously differentiable for s0 > 0 where the law is.
// Rounding the elongation and not the stress keeps a steep law (Ogden exponents of a hundred) soft at small
// elongations however wide the rounding is, as the continuation of a solver needs it. Never throws.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/laws/line_laws.hpp"
#include "energy/laws/rounded_elongation.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <algorithm>
#include <limits>

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
  static constexpr TermKind kKind = TermKind::Line;

  struct Rest {
    double length = 0;     // r
    double area = 0;       // A
    double smoothing = 0;  // s0, a share of the length
    Law law;
    double limit =
        std::numeric_limits<double>::infinity();  // of rho, beyond which w goes on along its tangent
  };

  static Rest rest(double length, double area, double smoothing, const Law& law) {
    return {length, area, smoothing, law};
  }

  // EnergyTerm::limit_stress().
  static void limit_stress(Rest& rest, const TensionScale& scale) {
    rest.limit = std::numeric_limits<double>::infinity();
    const double stress = scale.line / rest.area;
    if (stress < rest.limit) rest.limit = elongation_of(rest.law, stress, kMostElongation);
  }
  static double raise_limit(Rest& rest, const Eigen::Vector<double, 6>& x) {
    const double e = (x.tail<3>() - x.head<3>()).norm() / rest.length - 1;
    if (e <= 0) return 0;
    const double rho = rounded_elongation(e, rest.smoothing).value;
    if (!(rho > rest.limit)) return 0;
    const double stress = continued(rest, rho).stress, excess = std::log(rest.law.at(rho).stress / stress);
    const double most = 10 * rest.law.at(rest.limit).stress;
    rest.limit = elongation_of(rest.law, most > 0 ? std::min(stress, most) : stress, rho);
    return excess;
  }

  // The same cable with the onset of its tension rounded over at least this share of its length.
  static Rest rounded(const Rest& given, double share) {
    Rest result = given;
    result.smoothing = std::max(given.smoothing, share);
    return result;
  }

  // Energy, force and stiffness at elongation e = l/r - 1.
  static AxialLaw elastic(const Rest& rest, double e) {
    if (e <= 0) return {};
    const Elongation rho = rounded_elongation(e, rest.smoothing);
    const CurveValue w = continued(rest, rho.value);
    return {rest.area * rest.length * w.energy, rest.area * w.stress * rho.slope,
            rest.area / rest.length * (w.stiffness * rho.slope * rho.slope + w.stress * rho.curvature)};
  }

  static AxialLaw axial(const Rest& rest, double l) { return elastic(rest, l / rest.length - 1); }

  // --- For parameters and other solvers ----------------------------------------------------------------
  static LineTraits line(const Rest& rest) {
    const double onset = rest.smoothing * rest.length;
    return {.length = rest.length, .onset = onset, .begins_softly = onset > 0};
  }
  static void lengthen(Rest& rest, double length) { rest.length = length; }
  static RestSlope slope_by_rest(const Rest& rest, const AxialLaw& law, double l) {
    return homogeneous_slope(law, l, rest.length);
  }
  static void stiffen(Rest& rest, double factor, bool /*is_size*/) { rest.area *= factor; }

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    return evaluate(rest, x, g, H, -std::numeric_limits<double>::infinity());
  }

  // The force is never negative. The stiffness is where a law softens: Ogden's with exponents below 1, far
  // out.
  static double evaluate_projected(const Rest& rest, const Eigen::Vector<double, 6>& x,
                                   Eigen::Vector<double, 6>* g, Eigen::Matrix<double, 6, 6>* H) {
    return evaluate(rest, x, g, H, 0);
  }

 private:
  static constexpr double kMostElongation = 10;  // within which the limit of stress is looked for

  // The law up to the limit, its tangent beyond.
  static CurveValue continued(const Rest& rest, double rho) {
    if (rho <= rest.limit) return rest.law.at(rho);
    const CurveValue end = rest.law.at(rest.limit);
    const double past = rho - rest.limit;
    return {end.energy + (end.stress + 0.5 * end.stiffness * past) * past, end.stress + end.stiffness * past,
            end.stiffness};
  }

  // The elongation of this stress, at most `high`; by bisection, as a stress may overflow.
  static double elongation_of(const Law& law, double stress, double high) {
    double low = 0;
    while (high - low > 1e-14 * high) {
      const double middle = 0.5 * (low + high);
      (law.at(middle).stress < stress ? low : high) = middle;
    }
    return high;
  }

  // With a stiffness of at least `least` in the Hessian.
  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H, double least) {
    const Vec3 difference = x.tail<3>() - x.head<3>();
    const double l = difference.norm();
    AxialLaw law = elastic(rest, l / rest.length - 1);
    law.stiffness = std::max(law.stiffness, least);
    expand_axial(law, difference, l, g, H);
    return law.energy;
  }
};

using CableBilinear = CableLaw<BilinearLine>;
using CableOgden = CableLaw<OgdenLine>;
using CableToe = CableLaw<ToeLine>;
using CableCrimpedFibre = CableLaw<CrimpedLine>;

}  // namespace coapt
