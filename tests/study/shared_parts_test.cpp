// What the methods of a comparison are checks of: the same energy with or without factorisations, springs in
// place of it, or constraints.
#include "exchange/import.hpp"
#include "solve/solve_scene.hpp"
#include "study/comparison.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <map>

namespace coapt {
namespace {

TEST(SharedParts, AreWhatEachMethodHasOfNewton) {
  const TemporaryFolder folder;
  write_valve_scene(mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark}), folder.path(),
                    {.contact = "none"});
  const std::map<std::string, std::string> shared = {{"newton", "all"},
                                                     {"lbfgs", "energy"},
                                                     {"dynamic", "energy + factorisation"},
                                                     {"dynamic-explicit", "energy"},
                                                     {"mass-spring", "loads"},
                                                     {"xpbd", "loads"}};
  ComparisonOptions options;
  for (const auto& [name, parts] : shared) options.methods.push_back(name);
  RunOptions run;
  run.writes = false;
  run.tolerance = 1e-6;
  const Comparison found =
      compare_methods(load_scene(folder.path() / "scene.json"), scene_solvers(), options, run);
  ASSERT_EQ(found.methods.size(), shared.size());
  for (const ComparedMethod& method : found.methods) {
    EXPECT_EQ(method.shares, shared.at(method.name)) << method.name;
    ASSERT_TRUE(method.run) << method.message;
    EXPECT_EQ(method.run->report.solver, method.name);
    const bool is_own = method.model == MethodModel::Scene;
    const Verdict wanted = method.name == "newton" ? Verdict::Reference
                           : is_own                ? Verdict::SameEquilibrium
                                                   : Verdict::ModelGap;
    EXPECT_EQ(method.verdict, wanted) << method.name << ": " << method.message;
    EXPECT_EQ(method.run->report.result.status == Status::Converged, method.name != "xpbd") << method.message;
  }
}

}  // namespace
}  // namespace coapt
