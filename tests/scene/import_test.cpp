#include "scene/import.hpp"

#include "core/error.hpp"
#include "scene/build.hpp"
#include "scene/temporary_folder.hpp"
#include "scene/valve_json.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace coapt {
namespace {

std::filesystem::path data_file(const std::string& name) {
  return std::filesystem::path(COAPT_SHARED_DIR) / "data" / name;
}

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(Import, MakesASceneOfTheTricuspidValveThatBuilds) {
  const auto valve = data_file("trivalve11-healthy/valve_coarse.json");
  if (!std::filesystem::exists(valve)) GTEST_SKIP() << "skipped: data not found";
  const TemporaryFolder folder;
  import_valve(valve, folder.path() / "out", {.pressure_model = "frozen"});
  const Model model = build(load_scene(folder.path() / "out" / "scene.json"));
  EXPECT_EQ(model.mesh.triangle_count(), 1735);
  EXPECT_EQ(model.X.cols(), 964 + 32 + 94);
  EXPECT_EQ(model.lines.size(), 507u);
  EXPECT_DOUBLE_EQ(model.applied_pressure, 0.00306);
  EXPECT_TRUE(model.closed_reference.has_value());
  ASSERT_TRUE(model.motion.positions != nullptr);
  const Valve source = read_valve(valve).valve;
  const Points end = model.motion.positions(1);
  for (size_t k = 0; k < source.annulus.size(); ++k)
    EXPECT_LT(
        (end.col(source.annulus[k]) + model.origin - source.annulus_closed.col(static_cast<int>(k))).norm(),
        1e-12);
  EXPECT_EQ(model.objective->free_count(), 3 * (964 - 76 + 94));
}

TEST(Import, FixesTheAnnulusOfAValveWithoutMotion) {
  const auto valve = data_file("mitral-ct-normal1/valve_n32.json");
  if (!std::filesystem::exists(valve)) GTEST_SKIP() << "skipped: data not found";
  const TemporaryFolder folder;
  const auto warnings = import_valve(valve, folder.path(), {.pressure_model = "field"});
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("thickness"), std::string::npos);
  const std::string text = text_of(folder.path() / "scene.json");
  EXPECT_NE(text.find(R"({ "nodes": "annulus", "fix": true })"), std::string::npos) << text;
  EXPECT_NE(text.find(R"("toward_line": "annulus", "pressure": "120 mmHg")"), std::string::npos) << text;
  const Model model = build(load_scene(folder.path() / "scene.json"));
  EXPECT_GT(model.origin.norm(), 100);  // scanner coordinates
  EXPECT_TRUE(model.motion.positions == nullptr);
}

TEST(Import, LeavesOutChordsWhereThereAreNone) {
  const auto valve = data_file("bhv-trileaflet/valve_coarse.json");
  if (!std::filesystem::exists(valve)) GTEST_SKIP() << "skipped: data not found";
  const TemporaryFolder folder;
  import_valve(valve, folder.path());
  const std::string text = text_of(folder.path() / "scene.json");
  EXPECT_EQ(text.find("cable"), std::string::npos);
  EXPECT_EQ(text.find("papillary"), std::string::npos);
  EXPECT_NE(text.find(R"("thickness": "0.386 mm")"), std::string::npos) << text;
  EXPECT_EQ(build(load_scene(folder.path() / "scene.json")).lines.size(), 0u);
}

TEST(Import, RefusesUnknownOptionsAllAtOnce) {
  const TemporaryFolder folder;
  try {
    write_valve_scene({}, folder.path(), {.young = "1 mm", .pressure_model = "soft", .contact = "maybe"});
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 3u) << error.what();
  }
}

}  // namespace
}  // namespace coapt
