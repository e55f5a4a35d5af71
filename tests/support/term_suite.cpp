#include "support/term_suite.hpp"

#include "energy/moving_part.hpp"

#include <cmath>
#include <random>
#include <sstream>

namespace coapt {
namespace {

constexpr int kDirections = 20;
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

// Collects defects as lines that start with the label of the case.
class Findings {
 public:
  explicit Findings(std::string label) : label_(std::move(label)) {}
  void require(bool is_met, const std::string& defect, double found) {
    if (is_met) return;
    std::ostringstream line;
    line.precision(4);
    line << label_ << ": " << defect << " (found " << found << ")\n";
    text_ += line.str();
  }
  std::string text() const { return text_; }

 private:
  std::string label_, text_;
};

Points unit_direction(Eigen::Index nodes, unsigned seed) {
  std::mt19937 engine(seed);
  Points d(3, nodes);
  for (Eigen::Index k = 0; k < d.size(); ++k)
    d.data()[k] = 2.0 * engine() / static_cast<double>(std::mt19937::max()) - 1;
  return d / d.norm();
}

double energy_of(EnergyTerm& term, const Points& x) {
  term.prepare(x);
  Sink sink;
  return term.evaluate(x, sink);
}

Points gradient_of(EnergyTerm& term, const Points& x) {
  term.prepare(x);
  Points g = Points::Zero(3, x.cols());
  Sink sink(g.data());
  term.evaluate(x, sink);
  return g;
}

Vector flat(const Points& x) { return Eigen::Map<const Vector>(x.data(), x.size()); }

double relative(double difference, double scale) {
  return difference == 0 ? 0 : difference / std::max(std::abs(scale), 1e-300);
}

// The first 20 seeded directions along which the next order of the expansion is not all but zero: where it
// vanishes by chance, the order after it disturbs the slope and nothing can be read.
template <typename Coefficient>
std::vector<Points> telling_directions(Eigen::Index nodes, const Coefficient& coefficient) {
  std::vector<Points> drawn, kept;
  double largest = 0;
  for (unsigned sample = 0; sample < 2 * kDirections; ++sample) {
    drawn.push_back(unit_direction(nodes, 100 + sample));
    largest = std::max(largest, std::abs(coefficient(drawn.back())));
  }
  for (const Points& d : drawn)
    if (kept.size() < kDirections && std::abs(coefficient(d)) >= 0.03 * largest) kept.push_back(d);
  return kept;
}

// Worst slope of the remainder of the expansion of the given order.
double worst_slope(EnergyTerm& term, const TermCase& c, const TermValues& at, int order,
                   const std::vector<Points>& directions) {
  // Positions are rounded too: an error of epsilon in each coordinate times the force on it.
  const double rounding = kEpsilon * at.gradient.cwiseProduct(c.state).norm();
  double worst = kInfinity;
  for (const Points& d : directions) {
    const double gd = at.gradient.cwiseProduct(d).sum();
    const double dHd = order == 2 ? flat(d).dot(at.hessian * flat(d)) : 0;
    std::vector<double> steps, remainders, round_off;
    for (int rung = 2; rung <= 10; ++rung) {  // 1e-1 ... 1e-5 of the reach
      const double h = c.reach * std::pow(10.0, -0.5 * rung);
      const double energy = energy_of(term, c.state + h * d);
      steps.push_back(h);
      remainders.push_back(std::abs(energy - at.energy - h * gd - 0.5 * h * h * dHd));
      round_off.push_back(rounding +
                          4 * kEpsilon * (std::abs(energy) + std::abs(at.energy) + h * at.gradient.norm()));
    }
    worst = std::min(worst, slope_of_remainder(steps, remainders, round_off));
  }
  return worst;
}

void examine_slopes(EnergyTerm& term, const TermCase& c, const TermValues& at, Findings& findings) {
  const auto second = [&](const Points& d) { return flat(d).dot(at.hessian * flat(d)); };
  const auto third = [&](const Points& d) {
    const double h = 1e-3 * c.reach;
    const Eigen::MatrixXd change =
        evaluate_term(term, c.state + h * d).hessian - evaluate_term(term, c.state - h * d).hessian;
    return flat(d).dot(change * flat(d)) / (2 * h);
  };
  const std::vector<Points> directions = telling_directions(c.state.cols(), second);
  findings.require(directions.size() == kDirections, "too few directions to judge slopes",
                   static_cast<double>(directions.size()));
  const double of_gradient = worst_slope(term, c, at, 1, directions);
  findings.require(of_gradient >= 1.95, "Taylor slope of the gradient below 1.95", of_gradient);
  if (!c.has_hessian) return;
  const double of_hessian = worst_slope(term, c, at, 2, telling_directions(c.state.cols(), third));
  findings.require(of_hessian >= 2.9, "Taylor slope of the Hessian below 2.9", of_hessian);
}

void examine_differences(EnergyTerm& term, const TermCase& c, const TermValues& at, Findings& findings) {
  double worst_gradient = 0, worst_hessian = 0;
  for (unsigned sample = 0; sample < kDirections; ++sample) {
    const Points d = unit_direction(c.state.cols(), 200 + sample);
    const double gd = at.gradient.cwiseProduct(d).sum();
    const Vector Hd = at.hessian * flat(d);
    double best_gradient = kInfinity, best_hessian = kInfinity;
    for (double h : {1e-3 * c.reach, 1e-4 * c.reach, 1e-5 * c.reach}) {
      const double slope = (energy_of(term, c.state + h * d) - energy_of(term, c.state - h * d)) / (2 * h);
      best_gradient = std::min(best_gradient, relative(std::abs(slope - gd), at.gradient.norm()));
      const Points up = gradient_of(term, c.state + h * d), down = gradient_of(term, c.state - h * d);
      best_hessian = std::min(best_hessian, relative((flat(up - down) / (2 * h) - Hd).norm(), Hd.norm()));
    }
    worst_gradient = std::max(worst_gradient, best_gradient);
    worst_hessian = std::max(worst_hessian, best_hessian);
  }
  findings.require(worst_gradient <= 1e-7, "central difference of the energy against the gradient above 1e-7",
                   worst_gradient);
  if (c.has_hessian)
    findings.require(worst_hessian <= 1e-7,
                     "central difference of the gradient against the Hessian above 1e-7", worst_hessian);
}

// The assembled Hessian, its mask included, against the dense one.
void examine_assembly(const TermCase& c, const TermValues& at, Findings& findings) {
  for (const bool some_are_fixed : {false, true}) {
    FixedMask fixed = FixedMask::Constant(3, c.state.cols(), false);
    if (some_are_fixed) {
      fixed.col(0).setConstant(true);     // a node without unknowns
      fixed(1, fixed.cols() - 1) = true;  // a symmetry plane
    }
    std::vector<std::unique_ptr<EnergyTerm>> terms;
    terms.push_back(c.make({}));
    Objective objective(c.state, fixed, std::move(terms));
    Vector g;
    Eigen::SparseMatrix<double> sparse;
    const Vector q = objective.unknowns(c.state);
    objective.hessian(q, g, sparse);
    objective.hessian(q, g, sparse);  // written in place: the second call must not add to the first
    const Eigen::MatrixXd lower(sparse);
    Eigen::MatrixXd expected = at.hessian;
    const int first = some_are_fixed ? 3 : 0;
    if (some_are_fixed) {
      const Eigen::Index masked = expected.rows() - 2;
      expected.row(masked).setZero();
      expected.col(masked).setZero();
      expected(masked, masked) = 1;
      expected = expected.bottomRightCorner(expected.rows() - first, expected.cols() - first).eval();
    }
    const Eigen::MatrixXd full = lower.selfadjointView<Eigen::Lower>();
    const double difference =
        full.rows() == expected.rows() ? (full - expected).cwiseAbs().maxCoeff() : kInfinity;
    findings.require(difference <= 1e-14 * expected.cwiseAbs().maxCoeff(),
                     some_are_fixed ? "assembled Hessian with prescribed coordinates differs"
                                    : "assembled Hessian differs from the elements'",
                     difference);
  }
}

// A part of the nodes against the whole term, where they are and after a move within their reach.
void examine_part(const TermCase& c, const TermValues& at, Findings& findings) {
  const auto term = c.make({});
  term->prepare(c.state);
  for (const int stride : {1, 2, 3}) {
    std::vector<int> nodes;
    for (int node = static_cast<int>(c.state.cols()) - 1; node >= 0; node -= stride) nodes.push_back(node);
    MovingPart moving(c.state, nodes, 0.1 * c.reach);
    const auto part = term->part(moving);
    if (part == nullptr) return;
    for (const double share : {0.0, 0.9}) {
      Points state = c.state;
      const Points d = unit_direction(static_cast<Eigen::Index>(nodes.size()), 300);
      for (int k = 0; k < moving.moving_count(); ++k)
        state.col(moving.nodes()[k]) += share * moving.reach() * d.col(k);
      const TermValues whole = share == 0 ? at : evaluate_term(*term, state);
      const TermValues ours = evaluate_term(*part, state(Eigen::all, moving.nodes()));
      double gradient = 0, hessian = 0;
      for (int i = 0; i < moving.moving_count(); ++i) {
        const int a = moving.nodes()[i];
        gradient = std::max(gradient, (ours.gradient.col(i) - whole.gradient.col(a)).norm());
        for (int j = 0; j < moving.moving_count(); ++j)
          hessian = std::max(hessian, (ours.hessian.block<3, 3>(3 * i, 3 * j) -
                                       whole.hessian.block<3, 3>(3 * a, 3 * moving.nodes()[j]))
                                          .norm());
      }
      findings.require(gradient <= 1e-12 * whole.gradient.norm(), "gradient of a part differs", gradient);
      findings.require(hessian <= 1e-12 * whole.hessian.norm(), "Hessian of a part differs", hessian);
    }
  }
}

void examine_rigid_motion(const TermCase& c, const TermValues& at, Findings& findings) {
  if (!c.ignores_rigid_motion) return;
  const auto term = c.make({});
  const Frame turned = rotated_frame(), moved = moved_frame(c.far_away);
  const TermValues after_turn = evaluate_term(*term, turned.points(c.state));
  findings.require(relative(std::abs(after_turn.energy - at.energy), at.energy) < 1e-11,
                   "energy changes under rotation", after_turn.energy - at.energy);
  findings.require((after_turn.gradient - turned.forces(at.gradient)).norm() < 1e-11 * at.gradient.norm(),
                   "force does not rotate with the body",
                   (after_turn.gradient - turned.forces(at.gradient)).norm());
  const double shift = energy_of(*term, moved.points(c.state)) - at.energy;
  findings.require(relative(std::abs(shift), at.energy) < 1e-9, "energy changes under translation", shift);
  findings.require(at.gradient.rowwise().sum().norm() < 1e-11 * at.gradient.norm(),
                   "internal forces do not sum to zero", at.gradient.rowwise().sum().norm());
}

// The same problem in another frame has the same energy and the same forces.
void examine_frame(const TermCase& c, const TermValues& at, const Frame& frame, const std::string& what,
                   double tolerance, Findings& findings) {
  const auto term = c.make(frame);
  const TermValues seen = evaluate_term(*term, frame.points(c.state));
  const double energy = frame.force * frame.length * at.energy;
  findings.require(relative(std::abs(seen.energy - energy), energy) < tolerance, "energy depends on " + what,
                   relative(std::abs(seen.energy - energy), energy));
  const Points forces = frame.forces(at.gradient);
  findings.require((seen.gradient - forces).norm() < tolerance * forces.norm(), "forces depend on " + what,
                   (seen.gradient - forces).norm() / forces.norm());
  if (what != "units") return;
  const double stiffness = frame.force / frame.length;
  findings.require(
      (seen.hessian - stiffness * at.hessian).norm() <= tolerance * stiffness * at.hessian.norm(),
      "Hessian depends on units", (seen.hessian - stiffness * at.hessian).norm());
}

bool are_equal(const TermValues& a, const TermValues& b) {
  return a.energy == b.energy && a.gradient == b.gradient && a.hessian == b.hessian;
}

}  // namespace

TermValues evaluate_term(EnergyTerm& term, const Points& x) {
  term.prepare(x);
  const Stencils& stencils = term.stencils();
  const int n = static_cast<int>(3 * x.cols()), width = stencils.width;
  std::vector<BlockSlot> slots;
  for (size_t first = 0; width > 0 && first < stencils.nodes.size(); first += width)
    for (int a = 0; a < width; ++a)
      for (int b = 0; b < width; ++b)
        slots.push_back({3 * stencils.nodes[first + b] * n + 3 * stencils.nodes[first + a], n});
  TermValues values;
  values.gradient = Points::Zero(3, x.cols());
  values.hessian = Eigen::MatrixXd::Zero(n, n);
  Sink sink(values.gradient.data(), values.hessian.data(), slots.data(), Projection::None);
  values.energy = term.evaluate(x, sink);
  return values;
}

double slope_of_remainder(const std::vector<double>& steps, const std::vector<double>& remainders,
                          const std::vector<double>& round_off) {
  size_t clear = 0;  // rungs 0 .. clear-1 stand clear of round-off
  while (clear < steps.size() && remainders[clear] > 100 * round_off[clear]) ++clear;
  if (clear == 0) return kInfinity;
  // Too close to round-off for a whole decade: a remainder that small over one half decade still has to fall.
  const size_t last = clear - 1, first = last >= 2 ? last - 2 : 0;
  if (first == last) return kInfinity;
  return std::log(remainders[first] / remainders[last]) / std::log(steps[first] / steps[last]);
}

std::string examine_derivatives(const TermCase& c) {
  Findings findings(c.label);
  const auto term = c.make({});
  const TermValues at = evaluate_term(*term, c.state);
  findings.require(std::isfinite(at.energy) && at.energy != 0, "energy is zero or not finite", at.energy);
  findings.require(at.gradient.allFinite() && at.gradient.norm() > 0, "gradient is zero or not finite",
                   at.gradient.norm());
  if (c.has_hessian) {
    findings.require(at.hessian.allFinite() && at.hessian.norm() > 0, "Hessian is zero or not finite",
                     at.hessian.norm());
    findings.require((at.hessian - at.hessian.transpose()).norm() <= 1e-14 * at.hessian.norm(),
                     "Hessian is not symmetric", (at.hessian - at.hessian.transpose()).norm());
  }
  examine_slopes(*term, c, at, findings);
  examine_differences(*term, c, at, findings);
  examine_assembly(c, at, findings);
  examine_part(c, at, findings);
  return findings.text();
}

std::string examine_symmetries(const TermCase& c) {
  Findings findings(c.label);
  const auto term = c.make({});
  const TermValues at = evaluate_term(*term, c.state);
  examine_rigid_motion(c, at, findings);
  examine_frame(c, at, rotated_frame(), "the orientation of the axes", 1e-11, findings);
  examine_frame(c, at, moved_frame(c.far_away), "the place of the origin", 1e-9, findings);
  examine_frame(c, at, renumbered_frame(static_cast<int>(c.state.cols())), "the numbering", 1e-12, findings);
  examine_frame(c, at, scaled_frame(1e3, 1), "units", 1e-11, findings);
  examine_frame(c, at, scaled_frame(1e-6, 1e6), "units", 1e-11, findings);
  return findings.text();
}

std::string examine_state(const TermCase& c) {
  Findings findings(c.label);
  const auto term = c.make({});
  const TermValues at = evaluate_term(*term, c.state);
  const double scale = at.gradient.norm();
  if (c.is_zero_at_rest) {
    const TermValues rest = evaluate_term(*term, c.rest);
    findings.require(std::abs(rest.energy) <= 1e-13 * std::abs(at.energy), "energy at rest is not zero",
                     rest.energy);
    findings.require(rest.gradient.norm() <= 1e-13 * scale, "force at rest is not zero",
                     rest.gradient.norm());
  }
  // One history goes straight to the state, the other wanders: small and large moves, there and back.
  const auto traveller = c.make({});
  const Eigen::Index nodes = c.state.cols();
  for (double step : {0.01, 0.5, 20.0, 0.003, 1000.0, 1.0}) {
    const Points elsewhere =
        c.state + step * c.reach * unit_direction(nodes, static_cast<unsigned>(1000 * step));
    evaluate_term(*traveller, elsewhere);
    energy_of(*traveller, elsewhere + 0.01 * (c.state - c.rest));
  }
  const TermValues arrived = evaluate_term(*traveller, c.state);
  findings.require(are_equal(arrived, at), "values depend on the history", arrived.energy - at.energy);
  findings.require(are_equal(evaluate_term(*traveller, c.state), at), "values change when asked twice", 0);
  findings.require(energy_of(*traveller, c.state) == at.energy,
                   "energy alone differs from that with derivatives",
                   energy_of(*traveller, c.state) - at.energy);
  findings.require(gradient_of(*traveller, c.state) == at.gradient,
                   "gradient alone differs from that with the Hessian", 0);
  return findings.text();
}

std::string examine_term(const TermCase& c) {
  return examine_derivatives(c) + examine_symmetries(c) + examine_state(c);
}

}  // namespace coapt
