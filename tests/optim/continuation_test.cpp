// Prescribed motion that one step cannot take.
#include "optim/newton.hpp"
#include "optim/solver.hpp"
#include "support/equilibrium.hpp"
#include "support/tissue_laws.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace coapt {
namespace {

constexpr double kWidth = 1e-10;  // of the sliver [mm]

// A strip of tissue that stiffens steeply, 10 mm long, and ends in a sliver at the origin, where coordinates
// are exact; drawn out by `stretch` at its other end.
struct SliveredStrip {
  explicit SliveredStrip(bool holds_sliver) : moved(holds_sliver ? 4 : 2) {
    mesh.vertices.resize(3, 6);
    mesh.vertices << -10, -10, 0, 0, kWidth, kWidth, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0;
    mesh.triangles.resize(3, 4);
    mesh.triangles << 0, 2, 2, 4, 2, 3, 4, 5, 1, 1, 3, 3;
    fixed = fixed_nodes(6, holds_sliver ? std::vector<int>{0, 1, 2, 3, 4, 5} : std::vector<int>{0, 1, 4, 5});
    objective.emplace(
        mesh.vertices, fixed,
        terms_of(tissue_term(mesh, ExponentialLaw{{0.05, 0.02, 10}, 0}, 1, Points::Zero(3, 4))));
  }

  // parts: of the motion, as they are asked for.
  Result drawn_out_by(double stretch, std::vector<double>* parts = nullptr) {
    Problem problem{*objective, objective->unknowns(mesh.vertices)};
    problem.motion.positions = [this, stretch, parts](double t) {
      if (parts != nullptr) parts->push_back(t);
      Points x = mesh.vertices;
      x.leftCols(moved).row(0).array() -= stretch * t;
      return x;
    };
    return solve(*make_newton(), problem, {.tolerance = 1e-4, .max_iterations = 20000});
  }

  int moved;  // nodes, the first ones
  TriangleMesh mesh;
  FixedMask fixed;
  std::optional<Objective> objective;
};

// In a whole step the free nodes before the sliver lag behind by some widths of it: there the law overflows.
TEST(PathFollowing, TakesAMotionInPartsWhereTheEnergyOverflows) {
  SliveredStrip strip(false);
  std::vector<double> parts;
  const Result result = strip.drawn_out_by(3, &parts);
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_GT(parts.size(), 2u) << "of the motion that were tried";
  EXPECT_LT(*std::min_element(parts.begin(), parts.end()), 1);
  EXPECT_EQ(strip.objective->positions(result.q)(0, 0), -13) << "all of it";
  EXPECT_LE(strip.objective->true_residual(result.q), 1e-4);
}

TEST(PathFollowing, SaysHowFarAMotionWentThatNoStepCanTake) {
  SliveredStrip strip(true);
  const Result result = strip.drawn_out_by(3);
  EXPECT_EQ(result.status, Status::Stalled);
  EXPECT_NE(result.message.find("until its energy is not finite"), std::string::npos) << result.message;
  EXPECT_TRUE(result.q.allFinite());
  EXPECT_TRUE(std::isfinite(result.energy));
}

}  // namespace
}  // namespace coapt
