// Published models of valves, and springs as the usual leaflets: from the valve to the scene to the closed
// shape.
#include "scene/valve_models.hpp"

#include "core/error.hpp"
#include "mesh/generators/mitral.hpp"
#include "scene/build.hpp"
#include "scene/import.hpp"
#include "scene/run.hpp"
#include "scene/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace coapt {
namespace {

class ValveModels : public testing::TestWithParam<std::string> {};

// The generated valve with the springs of a model, without contact, by both solvers.
TEST_P(ValveModels, Closes) {
  const TemporaryFolder folder;
  Valve valve = mitral_valve({.triangles = 625});
  ImportOptions options;
  options.contact = "none";
  apply_valve_model(GetParam(), valve, options);
  write_valve_scene(valve, folder.path(), options);
  const Scene scene = load_scene(folder.path() / "scene.json");
  RunOptions how;
  how.writes = false;
  std::vector<Points> shapes;
  for (const char* solver : {"newton", "lbfgs"}) {
    how.solver = solver;
    how.tolerance = 1e-8;
    const RunReport done = run(scene, built_in_solvers(), how);
    const Result& result = done.report.result;
    std::printf("%s, %s: %d iterations, residual %.1e\n", GetParam().c_str(), solver, result.iterations,
                result.residual);
    EXPECT_EQ(result.status, Status::Converged) << solver << ": " << result.message;
    EXPECT_NEAR(done.model.applied_pressure, GetParam() == "hammer-2008" ? 0.016 : 0.013, 1e-12);
    EXPECT_EQ(done.model.membrane[0].thickness, 1);
    EXPECT_EQ(std::count_if(scene.terms.begin(), scene.terms.end(),
                            [](const TermSpec& t) { return t.type == "spring"; }),
              2);
    shapes.push_back(done.report.fields.x);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ValveModels, testing::ValuesIn(valve_model_names()), [](const auto& instance) {
  return instance.param.substr(instance.param.find('-') + 1);
});

TEST(ValveModels, NamesThoseThereAre) {
  Valve valve = mitral_valve({.triangles = 300});
  ImportOptions options;
  try {
    apply_valve_model("hamer-2008", valve, options);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean \"hammer-2008\""), std::string::npos)
        << error.what();
  }
}

// Linear springs in the place of the usual membrane, and of another program's linear shells.
TEST(SpringImport, WritesSpringsWithoutAPoissonsRatio) {
  const TemporaryFolder folder;
  const Valve valve = mitral_valve({.triangles = 300});
  write_valve_scene(valve, folder.path(), {.membrane = "spring"});
  const Scene scene = load_scene(folder.path() / "scene.json");
  EXPECT_EQ(scene.terms[0].type, "spring");
  EXPECT_EQ(scene.terms[1].type, "bending");
  EXPECT_NO_THROW(build(scene));
  // A valve JSON with springs keeps them.
  Valve sprung = valve;
  ImportOptions options;
  apply_valve_model("hammer-2011", sprung, options);
  write_valve_scene(sprung, folder.path() / "a", options);
  import_valve(folder.path() / "a" / "valve.json", folder.path() / "b");
  EXPECT_EQ(load_scene(folder.path() / "b" / "scene.json").terms[0].type, "spring");
  import_valve(folder.path() / "a" / "valve.json", folder.path() / "c",
               {.membrane = "spring", .young = "2 MPa"});
  const Scene linear = load_scene(folder.path() / "c" / "scene.json");
  EXPECT_EQ(linear.terms[0].type, "spring");
  EXPECT_EQ(linear.terms[0].parameters.number("young"), 2);
}

}  // namespace
}  // namespace coapt
