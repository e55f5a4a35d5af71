// An edge of a membrane as a spring that stands for its part of the triangles on it.
//   W = a r w(e),   e = l/r - 1,   l = |x1 - x0|,   a = h (A_1 + A_2 ...)/r
// r rest length, h thickness and A_i rest areas of the triangles on the edge (one on the boundary, which so
// carries half of what an inner edge does), a the cross-section that they give to it, w the energy per volume
// of a line (energy/laws/blended_line.hpp). A linear line of modulus E has the stiffness E h sum(A_i)/r^2. On
// equilateral triangles and at small strain that is the isotropic membrane of modulus E and Poisson's ratio
// 1/3; on other meshes it is no membrane exactly, and not isotropic (docs/theory.md).
// Tension only (`resists` false) the elongation is rounded at its onset as a cable's is
// (energy/laws/rounded_elongation.hpp): slack springs feel nothing, beyond the smoothing the law is exact.
// Twice continuously differentiable where smoothing and windows are above zero, but for coincident ends of a
// spring that resists: there its force has no direction and none is given. Never throws.
// Sources: Van Gelder 1998; Hammer et al. 2008, eq. 1, and 2011.
#pragma once

#include "energy/kernels/axial.hpp"
#include "energy/laws/blended_line.hpp"
#include "energy/laws/rounded_elongation.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

#include <algorithm>

namespace coapt {

struct Spring {
  static constexpr int kNodes = 2;
  static constexpr std::string_view kType = "spring";
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Spring;

  struct Rest {
    double length = 0;     // r
    double area = 0;       // a, cross-section
    double smoothing = 0;  // of the onset of tension, a share of the length
    bool resists = false;  // compression too
    BlendedLine law;
  };

  // The part that one triangle gives to the spring on an edge of its own. Pre: length > 0.
  static Rest rest(double length, double triangle_area, double thickness, const BlendedLine& law,
                   double smoothing, bool resists) {
    return {length, thickness * triangle_area / length, resists ? 0 : smoothing, resists, law};
  }

  // The same spring with its onset and its knees rounded over at least this share of its length.
  static Rest rounded(Rest rest, double share) {
    if (!rest.resists) rest.smoothing = std::max(rest.smoothing, share);
    rest.law.first = rest.law.first.rounded(share);
    rest.law.second = rest.law.second.rounded(share);
    return rest;
  }

  // Energy, force and stiffness at the elongation e = l/r - 1.
  static AxialLaw elastic(const Rest& rest, double e) {
    if (e <= 0 && !rest.resists) return {};
    const Elongation rho = rest.resists ? Elongation{e, 1, 0} : rounded_elongation(e, rest.smoothing);
    const CurveValue w = rest.law.at(rho.value);
    return {rest.area * rest.length * w.energy, rest.area * w.stress * rho.slope,
            rest.area / rest.length * (w.stiffness * rho.slope * rho.slope + w.stress * rho.curvature)};
  }

  static AxialLaw axial(const Rest& rest, double l) { return elastic(rest, l / rest.length - 1); }

  // --- For parameters and other solvers ----------------------------------------------------------------
  static LineTraits line(const Rest& rest) {
    const double onset = rest.smoothing * rest.length;
    return {.length = rest.length,
            .onset = onset,
            .begins_softly = onset > 0,
            .is_one_law = rest.resists,
            .resists = rest.resists};
  }
  static void stiffen(Rest& rest, double factor, bool /*is_size*/) { rest.area *= factor; }

  static double evaluate(const Rest& rest, const Eigen::Vector<double, 6>& x, Eigen::Vector<double, 6>* g,
                         Eigen::Matrix<double, 6, 6>* H) {
    const Vec3 difference = x.tail<3>() - x.head<3>();
    const double l = difference.norm();
    const AxialLaw law = directed(rest, l);
    expand_axial(law, difference, l, g, H);
    return law.energy;
  }

  // The eigenvalues are twice the stiffness along the spring and twice its force over its length across: the
  // negative ones are set to zero.
  static double evaluate_projected(const Rest& rest, const Eigen::Vector<double, 6>& x,
                                   Eigen::Vector<double, 6>* g, Eigen::Matrix<double, 6, 6>* H) {
    const Vec3 difference = x.tail<3>() - x.head<3>();
    const double l = difference.norm();
    const AxialLaw law = directed(rest, l);
    Eigen::Vector<double, 6> unused;
    expand_axial({0, std::max(law.force, 0.0), std::max(law.stiffness, 0.0)}, difference, l, &unused, H);
    expand_axial(law, difference, l, g, nullptr);
    return law.energy;
  }

 private:
  // Without derivatives where the ends coincide.
  static AxialLaw directed(const Rest& rest, double l) {
    constexpr double kCoincident = 1e-12;  // of the length: ends nearer than this have no direction
    AxialLaw law = elastic(rest, l / rest.length - 1);
    if (l < kCoincident * rest.length) law.force = law.stiffness = 0;
    return law;
  }
};

// The springs of an edge from its triangles: parts whose knees lie at the same strains are one spring,
// exactly, as its stress is the mean of theirs by cross-section. True, and `spring` is the sum, where they
// are.
inline bool join(Spring::Rest& spring, const Spring::Rest& part) {
  const auto is_same = [](const BilinearKnee& a, const BilinearKnee& b) {
    return a.transition == b.transition && a.window == b.window;
  };
  const BlendedLine& law = part.law;
  if (!is_same(spring.law.first, law.first) || !is_same(spring.law.second, law.second)) return false;
  if (spring.smoothing != part.smoothing) return false;
  const double area = spring.area + part.area, share = part.area / area;
  const auto mix = [share](double& mean, double more) { mean += share * (more - mean); };
  mix(spring.law.young, law.young);
  mix(spring.law.first.modulus, law.first.modulus);
  mix(spring.law.second.modulus, law.second.modulus);
  spring.area = area;
  return true;
}

}  // namespace coapt
