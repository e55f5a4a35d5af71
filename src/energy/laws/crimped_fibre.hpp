// Stress of a crimped collagen fibre, a helix that is pulled straight.
// H0 wavelength, R0 amplitude, r0 radius of the fibre at rest; L0^2 = (2 pi R0)^2 + H0^2 length of one turn,
// stretch of the straight fibre: limit = L0/H0; with H = l H0, R^2 = (L0^2 - H^2)/(2 pi)^2:
// clang-format off
//   l <= limit   s = E_s eta (l - 1)
//   beyond       s = E_s (limit - 1) + E_f (l/limit - 1)
//   E_s = E_f H0^2 / (L0 (H0 + (1 + 37/(6 pi^2) + 2 L0^2/(pi r0)^2) (L0 - H0)))
//   eta = (R^2 + H^2) / (L0 H (1 + 4 R^2/r0^2 + 6 (20/9 + R^2/r0^2) R^2/H^2))
// clang-format on
// Only the ratios H0/R0 and R0/r0 matter. s is taken as nominal stress (force per area at rest), and fibres
// that are not pulled carry none. Where the fibre is straight its stiffness rises over a window of stretch
// around the limit, so that the energy is twice continuously differentiable (our own). Source: Freed &
// Doehring 2005, J Biomech Eng 127:587.
// A fibre may yield: from a strain y of the straight fibre on, l = limit (1 + y), it keeps the share 1 - f of
// its stiffness, f its failure; the change is rounded as the limit is. It remembers nothing: unloaded it
// follows the same curve. Toma et al. 2016 name yield strain and a parameter of failure and print neither
// numbers nor their algorithm: the form is ours.
#pragma once

#include "energy/laws/bilinear_curve.hpp"

#include <array>
#include <limits>

namespace coapt {

class CrimpedFibre {
 public:
  CrimpedFibre() = default;
  // young: E_f [stress]; crimp: H0/R0; slenderness: R0/r0; window: half of the rounding, in stretch,
  // at most limit - 1. Pre: all but window positive.
  CrimpedFibre(double young, double crimp, double slenderness, double window);

  // The same fibre that yields. strain: y > 0; failure: f, 0 to 1.
  CrimpedFibre yielding(double strain, double failure) const;

  // Energy per volume, nominal stress and its slope at elongation e = l - 1; zero for e <= 0.
  CurveValue at(double elongation) const;

  double limit() const { return limit_; }
  double secant_young() const { return secant_; }  // E_s
  // limit (1 + y) - 1; infinite where it never yields.
  double yield_elongation() const { return yield_elongation_; }

 private:
  CurveValue crimped(double elongation) const;
  double crimped_energy(double elongation) const;
  double work(double from, double to) const;

  // The stress of a slender crimp has a pole just beyond the limit. Pieces that halve towards the limit keep
  // it as far from each as the piece is long.
  static constexpr int kPieces = 20;

  double secant_ = 0;
  double crimp_ = 0;        // H0/R0
  double slenderness_ = 0;  // R0/r0
  double limit_ = 1;
  std::array<double, kPieces> energy_{};  // of the crimped branch at the pieces' ends
  CurveValue at_limit_;
  BilinearKnee knee_;
  BilinearKnee yield_;  // of the stiffness that is lost, negative
  double yield_elongation_ = std::numeric_limits<double>::infinity();
};

}  // namespace coapt
