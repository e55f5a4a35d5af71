// What a run of a scene keeps and writes: nothing that nobody asked for. By counting, see
// tests/optim/frugality_test.cpp.
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "report/shape_view.hpp"
#include "run/run.hpp"
#include "solve/solve_scene.hpp"
#include "support/counted_allocations.hpp"
#include "support/temporary_folder.hpp"

#include <set>

namespace coapt {
namespace {

class SceneFrugality : public CountedAllocations {
 protected:
  SceneFrugality() {
    write_mesh(folder_.path() / "disc.obj", disc(10, 300));
    scene_ = load_scene(folder_.write("scene.json", R"({"mesh": {"file": "disc.obj"},
      "boundary": [{"nodes": "boundary", "fix": true}],
      "terms": [{"type": "cst_tension_field", "young": "1 MPa", "thickness": "0.5 mm"},
                {"type": "load_pressure", "value": "1 kPa"}],
      "solver": {"type": "newton", "factorisation": "eigen"}})"));
  }

  // The most that was allocated from one accepted iterate to the next, after the second.
  long per_iterate(bool writes_page, int frame_interval = 0) {
    RunOptions options;
    options.writes_page = writes_page;
    options.frame_interval = frame_interval;
    std::vector<long> seen;
    seen.reserve(1000);
    options.folder = folder_.path() / "result";
    options.observer = [&](const Iteration&, const Vector&) {
      seen.push_back(allocations().bytes);
      return true;
    };
    report_ = run(scene_, scene_solvers(), options).report;
    EXPECT_EQ(report_.result.status, Status::Converged);
    EXPECT_GT(seen.size(), 4u);
    long most = 0;
    for (size_t k = 3; k < seen.size(); ++k) most = std::max(most, seen[k] - seen[k - 1]);
    return most;
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& file : std::filesystem::directory_iterator(folder_.path() / "result"))
      names.insert(file.path().filename().string());
    return names;
  }

  TemporaryFolder folder_;
  Scene scene_;
  Report report_;
};

TEST_F(SceneFrugality, NothingIsKeptOfAnIterateForAPageThatNobodyWants) {
  const long vector = 8 * 3 * disc(10, 300).vertex_count();
  EXPECT_EQ(per_iterate(false), 0);
  EXPECT_TRUE(report_.shape_history.empty());
  EXPECT_EQ(files(),
            (std::set<std::string>{"result.json", "closed.vtp", "closed.obj", "trace.csv", "metrics.csv"}));
  if (has_shape_view()) {
    EXPECT_GT(per_iterate(true), vector);  // so it would have been seen
    EXPECT_GT(report_.shape_history.size(), 1u);
    EXPECT_TRUE(files().contains("report.html"));
  }
}

TEST_F(SceneFrugality, AFrameIsWrittenWhereFramesAreWantedAlone) {
  EXPECT_EQ(per_iterate(false), 0);
  EXPECT_FALSE(files().contains("frames"));
  EXPECT_GT(per_iterate(false, 1), 0);
  EXPECT_TRUE(files().contains("frames"));
}

TEST_F(SceneFrugality, WhatTheSceneLacksIsNeitherCountedNorJudged) {
  per_iterate(false);
  const Result& result = report_.result;
  for (const TermReport& term : result.terms) {
    EXPECT_EQ(term.counters.candidates, 0) << term.name;
    EXPECT_EQ(term.counters.searches, 0) << term.name;
  }
  EXPECT_FALSE(result.phase_s.contains("collisions"));
  EXPECT_EQ(result.certificate.stability.smallest.size(), 0);
  EXPECT_TRUE(report_.levels.empty());
  EXPECT_FALSE(report_.accuracy.has_value());
  EXPECT_FALSE(report_.reference.has_value());
  EXPECT_TRUE(result.branch_changes.empty());
}

}  // namespace
}  // namespace coapt
