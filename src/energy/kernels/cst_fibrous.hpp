// Membrane on a constant-strain triangle of any law with a fibre direction (energy/laws/fibrous.hpp), in
// plane stress.
//   W = V w(C),   V = A h volume at rest [length^3], C right Cauchy-Green tensor, first axis along the fibre
// Relaxed to a tension field it wrinkles instead of being compressed, which costs nothing:
//   W = V min w(C + P) over all P >= 0 (what wrinkles hide)
//   taut      no compression in any direction: P = 0
//   wrinkled  P = a a^T with stress(C + a a^T) a = 0, found by Newton in the two entries of a: tension along
//             one direction, which is that of least strain only where the law is isotropic
//   slack     both principal stretches are at most 1: C + P = I, no stress
// By the envelope theorem the stress is that of C + P; the tangent is condensed by the same two unknowns, so
// both derivatives are exact. The relaxed W is continuously differentiable and its Hessian jumps at the
// borders. Sources: Pipkin 1986, Steigmann 1990; Epstein 1999 (anisotropic membranes). Never throws; infinite
// where an exponential or a derivative of it overflows, and where wrinkles have not been found.
#pragma once

#include "energy/kernels/cst_state.hpp"
#include "energy/laws/fibrous.hpp"
#include "energy/term.hpp"
#include "energy/term_kind.hpp"

namespace coapt {

template <typename Law>
struct FibrousName;
template <>
struct FibrousName<OrthotropicLaw> {
  static constexpr std::string_view kType = "cst_orthotropic";
};
template <>
struct FibrousName<MayNewmanYinLaw> {
  static constexpr std::string_view kType = "cst_may_newman_yin";
};
template <>
struct FibrousName<CrimpedFibreLaw> {
  static constexpr std::string_view kType = "cst_crimped_fibre";
};

// Stress and tangent with the negative parts set to zero: a positive semidefinite d2W/dF2.
void make_positive(PlaneEnergy& w);

// The least eigenvalue of [[a, b], [b, c]] and its direction.
struct LeastDirection {
  double value = 0;
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
};
LeastDirection least_direction(double a, double c, double b);

// The power of two next below a size; 1 for zero and what is not finite.
double power_of_two(double size);

template <typename Law>
struct CstFibrous {
  static constexpr int kNodes = 3;
  static constexpr std::string_view kType = FibrousName<Law>::kType;
  static constexpr TermRole kRole = TermRole::Internal;
  static constexpr TermKind kKind = TermKind::Membrane;

  struct Rest {
    Eigen::Matrix2d shape;  // D_X^-1, first axis along the fibre [1/length]
    double volume = 0;      // V
    bool relaxes = true;    // a tension field
    Law law;
    // Lengths at rest along the fibre and across it over those of the reference shape; `shape` and `volume`
    // are those at rest.
    Eigen::Vector2d rest_scale = Eigen::Vector2d::Ones();
  };

  // fibre: its projection onto the triangle's plane is the first axis. thickness: at rest. Pre: the reference
  // triangle is not degenerate, thickness > 0, both scales > 0.
  static Rest rest(const Vec3& X0, const Vec3& X1, const Vec3& X2, const Vec3& fibre, const Law& law,
                   double thickness, bool relaxes = true,
                   const Eigen::Vector2d& rest_scale = Eigen::Vector2d::Ones()) {
    const CstShape shape = cst_shape(X0, X1, X2, fibre);
    return scaled({shape.inverse, shape.area * thickness, relaxes, law, rest_scale});
  }

  // --- For parameters ---------------------------------------------------------------------------------
  static const Eigen::Matrix2d& shape(const Rest& rest) { return rest.shape; }
  static Rest reshaped(Rest rest, const Corners&, const Corners& X) {
    rest.volume *= reshape(rest.shape, X);  // the area in reference over that at rest
    return scaled(std::move(rest));
  }
  static void stiffen(Rest& rest, double factor, bool /*is_size*/) { rest.volume *= factor; }
  static bool relaxes(const Rest& rest) { return rest.relaxes; }

  // EnergyTerm::limit_stress().
  static void limit_stress(Rest& rest, const TensionScale& scale) requires requires(Law law) { law.limit; }
  {
    const double area = 0.5 / std::abs(rest.shape.determinant());
    rest.law.limit_stress(scale.membrane * area / rest.volume);
  }
  static double raise_limit(Rest& rest, const CstVector& x) requires requires(Law law) { law.limit; }
  { return rest.law.raise_limit(respond(rest, cst_strain(cst_frame(rest.shape, x))).w.energy); }

  // The same element with its knees rounded over at least this strain.
  static Rest rounded(Rest rest, double share) requires requires(Law law) { law.fibre_knee; }
  {
    rest.law.fibre_knee = rest.law.fibre_knee.rounded(share);
    rest.law.cross_knee = rest.law.cross_knee.rounded(share);
    return rest;
  }

  // Elongation of the fibres over that at which they yield, of the law as it is stretched behind the
  // wrinkles.
  static bool yields(const Rest& rest) requires requires(Law law) { law.yields(); }
  { return rest.law.yields(); }
  // g: its gradient, null where it is not wanted.
  static double yield_ratio(const Rest& rest, const CstVector& x, CstVector* g) requires requires(Law law) {
    law.yields();
  }
  {
    const CstFrame frame = cst_frame(rest.shape, x);
    const CstStrain e = cst_strain(frame);
    const Metric c = respond(rest, e).stretched;
    const PlaneInvariant ratio = rest.law.yield_ratio(c.c11, c.c22, c.c12);
    if (g == nullptr) return ratio.value;
    const Eigen::Vector3d slope =
        follow(rest.law, c, {c.c11 - 1 - 2 * e.e11, c.c22 - 1 - 2 * e.e22}) * ratio.first;
    cst_gradient(frame, {slope[0], slope[1], slope[2]}, *g);
    return ratio.value;
  }

  static MembraneState state(const Rest& rest, const CstVector& x) {
    const CstStrain e = cst_strain(cst_frame(rest.shape, x));
    const Response at = respond(rest, e);
    return membrane_state(e, {at.w.stress[0], at.w.stress[1], at.w.stress[2]}, at.regime);
  }

  static double evaluate(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    return evaluate(rest, x, g, H, false);
  }

  // With the negative eigenvalues of stress and tangent set to zero: positive semidefinite, though not the
  // nearest such matrix.
  static double evaluate_projected(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H) {
    return evaluate(rest, x, g, H, true);
  }

 private:
  static constexpr double kRoundOff = 1e-14;  // of the stiffness: stress below it counts as none

  // C, in the axes of the fibre.
  struct Metric {
    double c11, c22, c12;
    Metric widened(const Eigen::Vector2d& a) const {
      return {c11 + a[0] * a[0], c22 + a[1] * a[1], c12 + a[0] * a[1]};
    }
  };

  struct Response {
    PlaneEnergy w;
    MembraneRegime regime = MembraneRegime::Slack;
    Metric stretched{1, 1, 0};  // C + P
  };

  // Takes shape and volume from the reference to the rest shape.
  static Rest scaled(Rest rest) {
    rest.shape.col(0) /= rest.rest_scale[0];
    rest.shape.col(1) /= rest.rest_scale[1];
    rest.volume *= rest.rest_scale.prod();
    return rest;
  }

  static PlaneEnergy at(const Law& law, const Metric& c) { return law.evaluate(c.c11, c.c22, c.c12); }

  // Transposed derivative of the strain of C + P by that of C. c: C + P; hidden: the diagonal of P = a a^T.
  static Eigen::Matrix3d follow(const Law& law, const Metric& c, const Eigen::Vector2d& hidden) {
    if (!(hidden.maxCoeff() > 0)) return Eigen::Matrix3d::Identity();
    const PlaneEnergy w = at(law, c);
    Eigen::Vector2d a = hidden.cwiseMax(0).cwiseSqrt();
    // The sign of one entry: that for which no stress is left.
    if (const Eigen::Vector2d other(a[0], -a[1]); traction(w, other).norm() < traction(w, a).norm())
      a = other;
    const Eigen::Matrix<double, 3, 2> by_a = widening(a);
    const Eigen::Matrix2d h = stiffness(w, by_a);
    return h.determinant() > 0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity() -
                                                 w.tangent * by_a * h.inverse() * by_a.transpose())
                               : Eigen::Matrix3d::Identity();
  }

  static Response respond(const Rest& rest, const CstStrain& e) {
    const Metric c{1 + 2 * e.e11, 1 + 2 * e.e22, 2 * e.e12};
    const double widest = 1 + 2 * cst_principal(e).major;
    if (rest.relaxes && widest < 1 - kRoundOff) return {};
    // A facet all but collapsed is compressed; its stress would only overflow.
    constexpr double kCollapsed = 1e-6;
    if (c.c11 * c.c22 - c.c12 * c.c12 > kCollapsed || !rest.relaxes) {
      const PlaneEnergy w = at(rest.law, c);
      const LeastDirection least = least_direction(w.stress[0], w.stress[1], w.stress[2]);
      const double none = kRoundOff * w.tangent.diagonal().maxCoeff();
      // Infinite where an exponential overflows: compressed beyond measure.
      const bool is_taut = std::isfinite(least.value) && std::isfinite(none) && least.value >= -none;
      if (is_taut || !rest.relaxes)
        return {w,
                is_taut      ? MembraneRegime::Taut
                : widest > 1 ? MembraneRegime::Wrinkled
                             : MembraneRegime::Slack,
                c};
    }
    return widest > 1 ? wrinkled(rest.law, c) : Response{};
  }

  // Of C + a a^T: dE = (a da^T + da a^T)/2, as rows (E11, E22, 2 E12).
  static Eigen::Matrix<double, 3, 2> widening(const Eigen::Vector2d& a) {
    Eigen::Matrix<double, 3, 2> m;
    m << a[0], 0, 0, a[1], a[1], a[0];
    return m;
  }

  static Eigen::Vector2d traction(const PlaneEnergy& w, const Eigen::Vector2d& a) {
    return {w.stress[0] * a[0] + w.stress[2] * a[1], w.stress[2] * a[0] + w.stress[1] * a[1]};
  }

  // Second derivative of w(C + a a^T) by a.
  static Eigen::Matrix2d stiffness(const PlaneEnergy& w, const Eigen::Matrix<double, 3, 2>& m) {
    Eigen::Matrix2d k = m.transpose() * w.tangent * m;
    k(0, 0) += w.stress[0];
    k(1, 1) += w.stress[1];
    k(0, 1) += w.stress[2];
    k(1, 0) += w.stress[2];
    return k;
  }

  // The first guess widens the narrow direction to what a strip of constant volume would have.
  static Eigen::Vector2d first_guess(const Metric& c) {
    const LeastDirection narrow = least_direction(c.c11, c.c22, c.c12);
    const double wide = c.c11 + c.c22 - narrow.value;
    const double missing = std::max(1 / std::sqrt(wide) - narrow.value, 1e-3 * (1 - narrow.value));
    return std::sqrt(std::max(missing, 1e-16)) * narrow.direction;
  }

  // Newton towards the a at which f(C + a a^T) is least, from the a given. Returns f there.
  template <typename Function>
  static PlaneEnergy descend(const Function& f, const Metric& c, Eigen::Vector2d& a) {
    PlaneEnergy w = f(c.widened(a));
    constexpr int kMost = 60;       // steps towards what wrinkles take up
    constexpr double kLast = 1e-9;  // of a: the error that a step this small leaves is its square
    for (int k = 0; k < kMost; ++k) {
      const Eigen::Vector2d g = traction(w, a);
      Eigen::Matrix2d h = stiffness(w, widening(a));
      const LeastDirection least = least_direction(h(0, 0), h(1, 1), h(0, 1));
      const double greatest = h.trace() - least.value;
      const bool is_convex = least.value > 1e-12 * greatest;
      if (!is_convex) {
        // Its absolute value, so that the step descends and has the length of the curvature met.
        const double floor = 1e-6 * std::max(std::abs(least.value), std::abs(greatest));
        const double low = std::max(std::abs(least.value), floor), high = std::max(std::abs(greatest), floor);
        h = high * Eigen::Matrix2d::Identity() + (low - high) * least.direction * least.direction.transpose();
      }
      const Eigen::Vector2d step = -h.inverse() * g;
      PlaneEnergy next = f(c.widened(a + step));
      if (!(step.norm() > (is_convex ? kLast : 1e-15) * a.norm())) {
        if (!std::isfinite(next.energy)) break;
        a += step;
        w = next;
        break;
      }
      double length = 1;
      // Within round-off of the energy the stress decides.
      const auto is_worse = [&](const PlaneEnergy& trial, const Eigen::Vector2d& there) {
        return !(trial.energy < w.energy) && !(traction(trial, there).norm() < g.norm());
      };
      while (is_worse(next, a + length * step) && length > 1e-6) {
        length *= 0.5;
        next = f(c.widened(a + length * step));
      }
      if (is_worse(next, a + length * step)) break;
      a += length * step;
      w = next;
    }
    return w;
  }

  // Is no stress left along a? Beside the stress itself or, where there is hardly any, the round-off of it.
  static bool is_free(const PlaneEnergy& w, const Eigen::Vector2d& a) {
    constexpr double kLeft = 1e-7, kNoise = 1e-12;  // of the stress; of the stiffness
    const double most = kLeft * w.stress.cwiseAbs().maxCoeff() + kNoise * w.tangent.cwiseAbs().maxCoeff();
    return std::isfinite(most) && traction(w, a).cwiseAbs().maxCoeff() <= most * a.cwiseAbs().maxCoeff();
  }

  // Pre: one principal stretch of C exceeds 1, and C is compressed in some direction.
  static Response wrinkled(const Law& law, const Metric& c) {
    Eigen::Vector2d a = first_guess(c);
    PlaneEnergy w = descend([&](const Metric& wide) { return at(law, wide); }, c, a);
    bool has_converged = is_free(w, a);
    // Newton lowers an exponent by about one in each step, and nothing that overflows: so that of the
    // exponent itself, which is least at the same place.
    if constexpr (requires { law.exponent(1.0, 1.0, 0.0); })
      if (!has_converged) {
        a = first_guess(c);
        const auto exponent = [&](const Metric& e) { return law.exponent(e.c11, e.c22, e.c12); };
        has_converged = is_free(descend(exponent, c, a), a);
        w = at(law, c.widened(a));
      }
    if (!has_converged) w.energy = std::numeric_limits<double>::infinity();
    // Condensed: the wrinkles follow the strain.
    const Eigen::Matrix<double, 3, 2> m = w.tangent * widening(a);
    const Eigen::Matrix2d h = stiffness(w, widening(a));
    // Scaled, which rounds nothing, as the determinant of a large one overflows.
    const double scale = power_of_two(h.cwiseAbs().maxCoeff());
    const Eigen::Matrix2d small = h / scale;
    if (small.determinant() > 0) w.tangent -= (m / scale) * small.inverse() * m.transpose();
    return {w, MembraneRegime::Wrinkled, c.widened(a)};
  }

  static double evaluate(const Rest& rest, const CstVector& x, CstVector* g, CstMatrix* H, bool projects) {
    const CstFrame frame = cst_frame(rest.shape, x);
    Response at = respond(rest, cst_strain(frame));
    PlaneEnergy& w = at.w;
    const double V = rest.volume;
    // Next to where the energy overflows its derivatives have.
    if (overflows(frame, V * w.tangent.cwiseAbs().sum())) w.energy = std::numeric_limits<double>::infinity();
    const double energy = V * w.energy;
    if (g == nullptr) return energy;
    cst_gradient(frame, {V * w.stress[0], V * w.stress[1], V * w.stress[2]}, *g);
    if (H == nullptr) return energy;
    if (projects) make_positive(w);
    cst_hessian(frame, {V * w.stress[0], V * w.stress[1], V * w.stress[2]}, Eigen::Matrix3d(V * w.tangent),
                *H);
    return energy;
  }
};

using CstOrthotropic = CstFibrous<OrthotropicLaw>;
using CstMayNewmanYin = CstFibrous<MayNewmanYinLaw>;
using CstCrimpedFibre = CstFibrous<CrimpedFibreLaw>;

}  // namespace coapt
