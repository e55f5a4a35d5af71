// Stress rows S11, S12 and S22: solutions on a kink, several solutions, and the way back to one.
#include "energy/element_term.hpp"
#include "energy/kernels/cable.hpp"
#include "support/disc_scene.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace coapt {
namespace {

// --- S11 --------------------------------------------------------------------------------------------------

void expect_few_more(const char* name, const Result& kinked, const Result& smooth) {
  std::printf("S11 %s: %d iterations, its smooth twin %d\n", name, kinked.iterations, smooth.iterations);
  EXPECT_EQ(kinked.status, Status::Converged) << kinked.message;
  EXPECT_EQ(smooth.status, Status::Converged) << smooth.message;
  EXPECT_LE(kinked.iterations, 3 * smooth.iterations);
}

// Cables that the inflated disc reaches exactly at their length change nothing.
TEST(Kink, S11ChordsExactlyAtTheirLength) {
  const DiscScene scene{smooth_disc_mesh(16)};
  const Equilibrium smooth = scene.solve({.tolerance = 1e-8});
  const auto count = scene.mesh.vertices.cols();
  Points X(3, count + 1);
  X << scene.mesh.vertices, Vec3(0, 0, -1);
  std::vector<int> nodes;
  std::vector<Cable::Rest> rest;
  const FixedMask disc_fixed = scene.fixed();
  for (int v = 0; v < count; v += 7) {
    if (disc_fixed(0, v)) continue;
    nodes.insert(nodes.end(), {static_cast<int>(count), v});
    rest.push_back({10, (smooth.x.col(v) - X.col(count)).norm(), 0, 0});
  }
  FixedMask fixed = FixedMask::Constant(3, count + 1, true);
  fixed.leftCols(count) = disc_fixed;
  Terms terms = scene.terms();
  terms.push_back(std::make_unique<ElementTerm<Cable>>("chords", nodes, rest));
  const Equilibrium kinked = find_equilibrium(X, fixed, std::move(terms), {.tolerance = 1e-8});
  expect_few_more("chords at their length", kinked.result, smooth.result);
  EXPECT_LT((kinked.x.leftCols(count) - smooth.x).cwiseAbs().maxCoeff(), 1e-6);
}

// A strip pulled lengthwise with free sides lies on the border of taut and wrinkled everywhere.
TEST(Kink, S11SheetOnTheBorderOfTautAndWrinkled) {
  const int n = 16;
  const TriangleMesh mesh = grid_mesh(n, n);
  Points start = mesh.vertices;
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  fixed(1, 0) = fixed(1, grid_node(n, n, 0)) = true;
  fixed.row(2).setConstant(true);
  for (int j = 0; j <= n; ++j)
    for (const int i : {0, n}) {
      fixed(0, grid_node(n, i, j)) = true;
      start(0, grid_node(n, i, j)) *= 1.1;
    }
  const auto solved = [&](SheetLaw material) {
    return find_equilibrium(start, fixed,
                            terms_of(sheet_term(material, mesh.vertices, mesh.triangles, {1, 0.3, 0})),
                            {.tolerance = 1e-8});
  };
  const Equilibrium kinked = solved(SheetLaw::TensionField), smooth = solved(SheetLaw::StVK);
  expect_few_more("taut and wrinkled", kinked.result, smooth.result);
}

// --- S12 --------------------------------------------------------------------------------------------------

// A strip of width 1.2 whose edges are pushed to distance 1 arches to the side that it bowed to at first.
struct Arch {
  Points x;
  double rise = 0;
};

Arch pushed_arch(double bow, int steps) {
  const int n = 24;
  const TriangleMesh mesh = grid_mesh(n, 2, 1.2, 0.1);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  fixed.row(1).setConstant(true);
  Points start = mesh.vertices;
  for (int j = 0; j <= 2; ++j)
    for (int i = 0; i <= n; ++i) {
      const double s = static_cast<double>(i) / n;
      start(2, grid_node(n, i, j)) = 4 * bow * s * (1 - s);
      if (i == 0 || i == n) fixed.col(grid_node(n, i, j)).setConstant(true);
    }
  Method method{.tolerance = 1e-8, .max_iterations = 5000};
  method.motion.steps = steps;
  method.motion.positions = [&](double t) {
    Points x = start;
    for (int j = 0; j <= 2; ++j) x(0, grid_node(n, n, j)) = 1.2 - 0.2 * t;
    return x;
  };
  const Equilibrium found = find_equilibrium(start, fixed,
                                             terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0, 0}),
                                                      bending_term(mesh.vertices, mesh.triangles, 1e-3)),
                                             method);
  EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
  std::printf("S12 bow %.0e in %d steps: rise %.6f, energy %.8g, %d iterations\n", bow, steps,
              found.x(2, grid_node(n, n / 2, 1)), found.result.energy, found.result.iterations);
  return {found.x, found.x(2, grid_node(n, n / 2, 1))};
}

TEST(Arch, S12StaysOnTheBranchOfItsPath) {
  const Arch up = pushed_arch(0.02, 8), finely = pushed_arch(0.02, 32), down = pushed_arch(-0.02, 8);
  std::printf("S12: distance of the two branches %.4f\n", (up.x - down.x).colwise().norm().maxCoeff());
  EXPECT_GT(up.rise, 0.1);
  EXPECT_LT((up.x - finely.x).cwiseAbs().maxCoeff(), 1e-5);
  EXPECT_NEAR(up.rise, -down.rise, 1e-5);
}

// --- S22 --------------------------------------------------------------------------------------------------

TEST(Valve, S22ComesBackWhenAChordDoes) {
  ValveScene scene({});
  const Equilibrium cold = scene.solve_in({}, 1e-10);
  ASSERT_EQ(cold.result.status, Status::Converged) << cold.result.message;
  const auto warm = [&](const Points& from) {
    Method method = scene.method(1e-10);
    method.motion = {};
    const Equilibrium found = find_equilibrium(from, scene.fixed, scene.terms(), method);
    EXPECT_EQ(found.result.status, Status::Converged) << found.result.message;
    return found;
  };
  const std::vector<int> held = scene.held_nodes(cold.x);
  const auto distance = [&](const Points& a, const Points& b) {
    return (a - b)(Eigen::all, held).colwise().norm().maxCoeff();
  };
  int taut = 0;  // the most stretched chord
  double most = 0;
  for (int k = 0; k < scene.chords.cols(); ++k) {
    const double stretch =
        (cold.x.col(scene.chords(0, k)) - cold.x.col(scene.chords(1, k))).norm() / scene.chord_lengths[k];
    if (stretch > most) taut = k;
    most = std::max(most, stretch);
  }
  for (const double factor : {1.1, 0.9}) {
    const double length = scene.chord_lengths[taut];
    scene.chord_lengths[taut] *= factor;
    const Equilibrium changed = warm(cold.x), fresh = scene.solve_in({}, 1e-10);
    scene.chord_lengths[taut] = length;
    const Equilibrium back = warm(changed.x);
    std::printf(
        "S22 chord %d times %.1f: moved %.3f mm, from the cold start %.1e mm, back %.1e mm; %d, %d, %d "
        "iterations\n",
        taut, factor, distance(changed.x, cold.x), distance(changed.x, fresh.x), distance(back.x, cold.x),
        changed.result.iterations, fresh.result.iterations, back.result.iterations);
    EXPECT_LT(distance(back.x, cold.x), 1e-6);
    EXPECT_LT(distance(changed.x, fresh.x), 1e-6);
  }
}

// A chord swings by a tenth of its length and back in a hundred warm starts.
TEST(Nightly, S22ASweepOfAHundredStepsEndsWhereItBegan) {
  ValveScene scene({});
  const Equilibrium cold = scene.solve_in({}, 1e-10);
  const std::vector<int> held = scene.held_nodes(cold.x);
  const double length = scene.chord_lengths[1];
  Method method = scene.method(1e-10);
  method.motion = {};
  Points x = cold.x;
  int iterations = 0;
  for (int step = 1; step <= 100; ++step) {
    scene.chord_lengths[1] = length * (1 + 0.1 * std::sin(2 * std::acos(-1.0) * step / 100));
    const Equilibrium found = find_equilibrium(x, scene.fixed, scene.terms(), method);
    ASSERT_EQ(found.result.status, Status::Converged) << step << ": " << found.result.message;
    x = found.x;
    iterations += found.result.iterations;
  }
  const double distance = (x - cold.x)(Eigen::all, held).colwise().norm().maxCoeff();
  std::printf("S22 sweep: back within %.1e mm after %d iterations\n", distance, iterations);
  EXPECT_LT(distance, 1e-6);
}

}  // namespace
}  // namespace coapt
