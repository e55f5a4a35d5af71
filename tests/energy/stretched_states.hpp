// Every kind of term far from rest: through the whole suite at stretches from 0.2 to 3, uniaxial, biaxial and
// sheared; and along ways through those states nothing jumps. Where an exponential overflows the energy is
// infinite.
#pragma once

#include "energy/element_term.hpp"
#include "membrane_patch.hpp"
#include "support/term_suite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

namespace coapt {

inline constexpr double kMostJudged = 1e120;  // energy up to which every product in the suite is finite
inline const Vec3 kFibre(std::cos(0.4), std::sin(0.4), 0);

// A term on a mesh that is at rest in the plane.
struct Kind {
  std::string label;
  std::function<std::unique_ptr<EnergyTerm>(const Frame&, const Points& X, const Triangles&)> make;
  TriangleMesh mesh = two_triangles();
  bool can_be_slack = false;  // and then does nothing at all
  bool can_overflow = false;
  bool has_hessian = true;
  bool is_zero_at_rest = true;
  bool ignores_rigid_motion = true;
  double above = 0;  // where the second half of the nodes lies over the first in the states
  double reach = 1e-3;

  static TriangleMesh two_triangles() {
    TriangleMesh mesh = grid_mesh(1, 1);
    mesh.vertices = shaken(mesh.vertices, 0.08, 3);
    mesh.vertices.row(2).setZero();
    return mesh;
  }

  TermCase at(const std::string& state, const Eigen::Matrix3d& F) const {
    TermCase c;
    c.label = label + ", " + state;
    c.rest = mesh.vertices;
    c.state = shaken(F * mesh.vertices, 2e-3, 4);
    if (above > 0) {
      const Eigen::Index half = c.state.cols() / 2;
      c.state.row(2).tail(half).array() += above - c.state.row(2).tail(half).mean();
    }
    c.reach = reach;
    c.has_hessian = has_hessian;
    c.is_zero_at_rest = is_zero_at_rest;
    c.ignores_rigid_motion = ignores_rigid_motion;
    c.far_away = 10;
    c.make = [kind = *this](const Frame& f) {
      return kind.make(f, f.points(kind.mesh.vertices), f.triangles(kind.mesh.triangles));
    };
    return c;
  }
};

inline double stress_unit(const Frame& f) { return f.force / (f.length * f.length); }

template <typename Kernel, typename RestOf>
std::unique_ptr<EnergyTerm> on_triangles(const Points& X, const Triangles& triangles, const RestOf& rest_of) {
  std::vector<typename Kernel::Rest> rest;
  for (const auto& t : triangles.colwise()) rest.push_back(rest_of(X.col(t[0]), X.col(t[1]), X.col(t[2])));
  return std::make_unique<ElementTerm<Kernel>>("membrane", triangle_nodes(triangles), rest);
}

// --- The states ---------------------------------------------------------------------------------------

struct State {
  std::string label;
  Eigen::Matrix3d F;
};

inline std::vector<State> states() {
  std::vector<State> all;
  for (const double l : {0.2, 0.47, 0.83, 1.12, 1.43, 1.86, 2.37, 3.0}) {
    const std::string at = " " + std::to_string(l);
    all.push_back({"uniaxial" + at, deformation(l, 0, 0.96)});
    all.push_back({"narrowing" + at, deformation(l, 0, 0.9 / std::sqrt(l))});
    all.push_back({"biaxial" + at, deformation(l, 0, 1.01 * l)});
    all.push_back({"sheared" + at, deformation(1.07, 0.6 * l, l)});
  }
  return all;
}

// Everything that is wrong with a kind of term at all states.
inline void examine(const Kind& kind) {
  int judged = 0, slack = 0, overflown = 0;
  for (const State& state : states()) {
    const TermCase c = kind.at(state.label, state.F);
    const TermValues at = evaluate_term(*c.make({}), c.state);
    ASSERT_FALSE(std::isnan(at.energy)) << c.label;
    if (kind.can_be_slack && at.gradient.isZero(0)) {
      EXPECT_TRUE(at.hessian.isZero(0)) << c.label;
      EXPECT_TRUE(at.energy == 0 || !kind.is_zero_at_rest) << c.label;
      ++slack;
    } else if (at.energy > kMostJudged && kind.can_overflow) {
      EXPECT_TRUE(std::isinf(at.energy) || (at.gradient.allFinite() && at.hessian.allFinite())) << c.label;
      ++overflown;
    } else {
      EXPECT_EQ(examine_term(c), "");
      ++judged;
    }
  }
  EXPECT_GE(judged, kind.can_overflow ? 8 : 16)
      << kind.label << ": " << slack << " slack, " << overflown << " overflow";
}

// --- The ways between them ----------------------------------------------------------------------------

// Straight from one place to another: is the energy there more by the work of the force along it? Halved
// until Simpson's rule is exact; where the energy jumps no halving helps.
class Way {
 public:
  Way(EnergyTerm& term, Points from, const Points& to)
      : term_(term), from_(std::move(from)), change_(to - from_) {}

  struct Place {
    double share, energy, slope;
  };
  Place at(double share) {
    const Points x = from_ + share * change_;
    term_.prepare(x);
    Points g = Points::Zero(3, x.cols());
    Sink sink(g.data());
    const double energy = term_.evaluate(x, sink);
    return {share, energy, g.cwiseProduct(change_).sum()};
  }

  // The share of the way at which it jumps; negative where it does not. noise: of the energy.
  double jump(const Place& a, const Place& b, double noise, int halvings = 22) {
    if (!(a.energy < kMostJudged && b.energy < kMostJudged)) return -1;
    const Place middle = at(0.5 * (a.share + b.share));
    const double step = b.share - a.share;
    const double work = step * (a.slope + 4 * middle.slope + b.slope) / 6;
    const double size = step * (std::abs(a.slope) + std::abs(b.slope) + std::abs(middle.slope));
    const double rounding = noise + 1e-11 * (std::abs(a.energy) + std::abs(b.energy));
    if (std::abs(b.energy - a.energy - work) <= 1e-6 * size + rounding) return -1;
    if (halvings == 0) return middle.share;
    const double first = jump(a, middle, noise, halvings - 1);
    return first >= 0 ? first : jump(middle, b, noise, halvings - 1);
  }

 private:
  EnergyTerm& term_;
  Points from_, change_;
};

inline void follow(const Kind& kind) {
  for (const auto& [label, from, to] :
       {std::tuple{"uniaxial", deformation(0.2, 0, 0.96), deformation(3, 0, 0.96)},
        {"narrow", deformation(0.2, 0, 0.3), deformation(3, 0.1, 0.3)},
        {"biaxial", deformation(0.2, 0, 0.2), deformation(3, 0, 3.03)},
        {"sheared", deformation(1.07, 0.1, 0.2), deformation(1.07, 1.8, 3)}}) {
    const auto term = kind.make({}, kind.mesh.vertices, kind.mesh.triangles);
    Way way(*term, kind.at("", from).state, kind.at("", to).state);
    constexpr int kPieces = 256;
    Way::Place a = way.at(0);
    for (int k = 1; k <= kPieces; ++k) {
      const Way::Place b = way.at(static_cast<double>(k) / kPieces);
      // Where a kink is crossed and energies are next to nothing, of those that the piece leads to.
      const double noise = 1e-11 * std::max(std::abs(a.slope), std::abs(b.slope)) / kPieces;
      EXPECT_LT(way.jump(a, b, noise), 0) << kind.label << ", " << label;
      a = b;
    }
  }
}

inline void examine_and_follow(const std::vector<Kind>& kinds) {
  for (const Kind& kind : kinds) {
    examine(kind);
    follow(kind);
  }
}

}  // namespace coapt
