// Prescribed motion that one step cannot take.
#include "optim/newton.hpp"
#include "optim/solver.hpp"
#include "support/equilibrium.hpp"
#include "support/tissue_laws.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

constexpr double kWidth = 1e-6;  // of the sliver [mm]

// A strip of exponential tissue, 10 mm long, that ends in a sliver; drawn out by `stretch` at the end.
struct SliveredStrip {
  explicit SliveredStrip(bool holds_sliver) {
    mesh.vertices.resize(3, 6);
    mesh.vertices << 0, 0, 10, 10, 10 + kWidth, 10 + kWidth, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0;
    mesh.triangles.resize(3, 4);
    mesh.triangles << 0, 2, 2, 4, 2, 3, 4, 5, 1, 1, 3, 3;
    fixed = fixed_nodes(6, holds_sliver ? std::vector<int>{0, 1, 2, 3, 4, 5} : std::vector<int>{0, 1, 4, 5});
    objective.emplace(mesh.vertices, fixed,
                      terms_of(tissue_term(mesh, laws::Exponential::law(1), 1, Points::Zero(3, 4))));
  }

  Result drawn_out_by(double stretch) {
    Problem problem{*objective, objective->unknowns(mesh.vertices)};
    problem.motion.positions = [this, stretch](double t) {
      Points x = mesh.vertices;
      x.rightCols(2).row(0).array() += stretch * t;
      return x;
    };
    return solve(*make_newton(), problem, {.tolerance = 1e-8, .max_iterations = 20000});
  }

  TriangleMesh mesh;
  FixedMask fixed;
  std::optional<Objective> objective;
};

// The free nodes before the sliver lag behind a whole step: there the exponential law overflows.
TEST(PathFollowing, TakesAMotionInPartsWhereTheEnergyOverflows) {
  SliveredStrip strip(false);
  const Points x = strip.mesh.vertices;
  Points whole = x;
  whole.rightCols(2).row(0).array() += 3;
  Sink sink;
  ASSERT_FALSE(std::isfinite(strip.objective->terms().front()->evaluate(whole, sink)));
  const Result result = strip.drawn_out_by(3);
  ASSERT_EQ(result.status, Status::Converged) << result.message;
  const Points found = strip.objective->positions(result.q);
  EXPECT_NEAR(found(0, 2), 10 * (13 + kWidth) / (10 + kWidth), 0.05) << "drawn out alike everywhere";
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
