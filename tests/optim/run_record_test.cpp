#include "optim/run_record.hpp"

#include "energy/load_dead.hpp"
#include "optim/monitor.hpp"
#include "support/equilibrium.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

constexpr double kRecordTolerance = 1e-12;

// A square held at its rim, which is pulled up while a load presses on it, in four steps.
struct Square {
  TriangleMesh mesh = grid_mesh(6, 6);
  FixedMask fixed = FixedMask::Constant(3, mesh.vertex_count(), false);
  std::unique_ptr<Objective> objective;

  Square() {
    Points forces = Points::Zero(3, mesh.vertex_count());
    forces.row(2).setConstant(-1e-3);
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      const auto at = mesh.vertices.col(v).head<2>().array();
      fixed.col(v).setConstant((at < 1e-9 || at > 1 - 1e-9).any());
    }
    objective = std::make_unique<Objective>(
        mesh.vertices, fixed,
        terms_of(membrane_term(mesh.vertices, mesh.triangles, {1, 0.3, 0.05}),
                 std::make_unique<LoadDead>("load", "load_field", forces, mesh.vertices)));
  }
};

// Cancelled after `most` accepted iterates.
Result solved(const std::string& solver, RunRecorder& recorder, int most = 1 << 30) {
  Square square;
  MotionPath motion{4, [X = square.mesh.vertices](double t) {
                      Points x = X;
                      x.row(2).array() += 0.3 * t;
                      return x;
                    }};
  Problem problem{*square.objective, square.objective->unknowns(square.mesh.vertices), motion, {4, 1, 1}};
  const SolverTable table = recorder.recorded(built_in_solvers());
  int seen = 0;
  return solve(*table.at(solver)({}), problem, {.tolerance = kRecordTolerance},
               recorder.recorded([&](const Iteration&, const Vector&) { return ++seen < most; }));
}

TEST(RunRecord, LeadsACancelledRunToTheSameResult) {
  for (const char* solver : {"newton", "lbfgs"}) {
    RunRecorder whole({}, 0, {});
    const Result wanted = solved(solver, whole);
    ASSERT_EQ(wanted.status, Status::Converged) << wanted.message;
    ASSERT_GE(whole.record().ends.size(), 4u);
    const auto all = static_cast<int>(whole.record().iterations);
    for (int most = 1; most < all; most += std::max(1, all / 7)) {
      RunRecord kept;
      RunRecorder first({}, 0, [&](const RunRecord& record) { kept = record; });
      ASSERT_EQ(solved(solver, first, most).status, Status::Cancelled);
      EXPECT_TRUE(first.is_cut_short());
      EXPECT_EQ(first.record().iterations, most);
      EXPECT_EQ(kept.ends.size(), first.record().ends.size());
      EXPECT_EQ(kept.iterate, first.record().iterate);

      RunRecorder second(kept, 1e9, {});
      const Result result = solved(solver, second);
      EXPECT_EQ(result.status, Status::Converged) << result.message;
      EXPECT_NE(result.message.find("taken up again after " + std::to_string(most)), std::string::npos)
          << result.message;
      EXPECT_LT((result.q - wanted.q).lpNorm<Eigen::Infinity>(), 1e-9) << solver << " cut at " << most;
      EXPECT_EQ(second.record().ends.size(), whole.record().ends.size());
      EXPECT_FALSE(second.is_cut_short() || second.has_left_history());

      kept.iterate.resize(0);
      RunRecorder third(kept, 1e9, {});
      EXPECT_EQ(solved(solver, third).q, wanted.q) << solver << " cut at " << most << ", begun anew";
    }
  }
}

TEST(RunRecord, KeepsAllWhenItIsCancelledWhileItRetraces) {
  RunRecorder first({}, 0, {});
  const Result wanted = solved("newton", first);
  RunRecorder second(first.record(), 0, {});
  EXPECT_EQ(solved("newton", second, 3).status, Status::Cancelled);
  EXPECT_TRUE(second.is_cut_short());
  EXPECT_EQ(second.record().ends.size(), first.record().ends.size());
  RunRecorder third(second.record(), 0, {});
  EXPECT_EQ(solved("newton", third).q, wanted.q);
  EXPECT_EQ(third.record().iterations, first.record().iterations) << "nothing was left to do";
}

// A method is led along the way that it takes when nobody records it.
TEST(RunRecord, LeavesTheMethodWhatItIs) {
  class Own final : public Solver {
   public:
    std::string_view name() const override { return "own"; }
    bool raises_stress_limits() const override { return true; }
    bool honours_step_limits() const override { return false; }
    bool minimises_objective() const override { return false; }
    Status minimize(Objective&, Vector&, Monitor&) override { return Status::Stalled; }
  };
  RunRecorder recorder({}, 0, {});
  const SolverTable table =
      recorder.recorded(SolverTable{{"own", [](const SolverOptions&) { return std::make_unique<Own>(); }}});
  const auto recorded = table.at("own")({});
  EXPECT_TRUE(recorded->raises_stress_limits());
  EXPECT_FALSE(recorded->honours_step_limits());
  EXPECT_FALSE(recorded->minimises_objective());
}

TEST(RunRecord, DropsWhatDoesNotFit) {
  RunRecord foreign;
  foreign.ends.push_back({Points::Random(3, 5), Status::Converged, true, ""});
  foreign.iterate = Vector::Ones(6);
  RunRecorder recorder(foreign, 0, {});
  RunRecorder own({}, 0, {});
  EXPECT_EQ(solved("newton", recorder).q, solved("newton", own).q);
  EXPECT_TRUE(recorder.has_left_history());
}

}  // namespace
}  // namespace coapt
