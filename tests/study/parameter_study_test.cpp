#include "study/parameter_study.hpp"

#include "core/error.hpp"
#include "scene/file/scene_text.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>

namespace coapt {
namespace {

std::string refusal(const std::string& sweep) {
  try {
    parse_sweep(sweep);
    return "accepted";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Sweep, ReadsRangesListsAndUnits) {
  EXPECT_EQ(parse_sweep("ring.size=26..34").values, (std::vector<std::string>{"26", "28", "30", "32", "34"}));
  EXPECT_EQ(parse_sweep("ring.size=26..34mm:3").values,
            (std::vector<std::string>{"26 mm", "30 mm", "34 mm"}));
  EXPECT_EQ(parse_sweep("p.value=80, 120 mmHg").values, (std::vector<std::string>{"80 mmHg", "120 mmHg"}));
  EXPECT_EQ(parse_sweep("solver.tolerance=1e-6,1e-8").values, (std::vector<std::string>{"1e-06", "1e-08"}));
  EXPECT_EQ(parse_sweep("a.b=-1..1:3").values, (std::vector<std::string>{"-1", "0", "1"}));
  for (const char* bad :
       {"ring.size", "=1..2", "a.b=1..", "a.b=x..2", "a.b=1..2:1", "a.b=2..2", "a.b=1cm..2mm"})
    EXPECT_NE(refusal(bad).find("KEY=a..b"), std::string::npos) << bad << ": " << refusal(bad);
}

constexpr const char* kScene = R"({"terms": [{"type": "cable", "young": "40 MPa"}, {"type": "cable"}],
  "interventions": [{"type": "ring", "size": "30 mm"}, {"type": "clip", "name": "m", "at": [0.5]}]})";

std::string changed(const std::string& path, const std::string& value) {
  try {
    return with_value(kScene, path, value, "s.json");
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(SceneText, FindsKeysByNameAndByPath) {
  EXPECT_NE(changed("ring.size", "26").find("\"26 mm\""), std::string::npos);
  EXPECT_NE(changed("ring.size", "2.6 cm").find("\"2.6 cm\""), std::string::npos);
  EXPECT_NE(changed("m.at[0]", "0.25").find("0.25"), std::string::npos);
  EXPECT_NE(changed("cable_2.young", "7 MPa").find("\"7 MPa\""), std::string::npos);
  EXPECT_NE(changed("terms[0].young", "7").find("\"7 MPa\""), std::string::npos);
  EXPECT_NE(changed("rong.size", "26").find("did you mean \"ring\""), std::string::npos);
  EXPECT_NE(changed("m.at[4]", "1").find("has no entry 4"), std::string::npos);
  EXPECT_NE(changed("size", "1").find("no key path"), std::string::npos);
}

PointResult result_of(size_t number, double orifice, const std::string& status = "converged") {
  PointResult result;
  result.number = number;
  result.values = {std::to_string(number)};
  result.key = "k";
  result.status = status;
  result.metrics = {{"orifice_area_mm2", orifice}, {"coaptation_area_mm2", std::nullopt}};
  return result;
}

TEST(ParameterStudy, RanksConvergedPointsByTheMetric) {
  ParameterStudy study{
      .metric = "orifice_area_mm2",
      .point_count = 4,
      .results = {result_of(0, 5), result_of(1, 1, "stalled"), result_of(2, 3), result_of(3, kNaN)}};
  EXPECT_EQ(ranked(study), (std::vector<size_t>{2, 0, 3, 1}));
  study.is_greatest_best = true;
  EXPECT_EQ(ranked(study), (std::vector<size_t>{0, 2, 3, 1}));
  EXPECT_THROW(check_metric("orifice"), InputError);
}

TEST(ParameterStudy, APointIsAnotherOnceAFileOfItsSceneIs) {
  const TemporaryFolder folder;
  folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("ring.csv", "0,0,0\n1,0,0\n0,1,0\n");
  const auto scene = folder.write("scene.json", R"({"mesh": {"file": "mesh.obj"},
    "interventions": [{"type": "ring", "curve": "ring.csv"}],
    "terms": [{"type": "surface_tension", "tension": "1 N/mm"}],
    "solver": {"type": "newton"}})");
  const std::vector<Sweep> sweeps = {parse_sweep("solver.tolerance=1e-6,1e-8")};
  const auto keys = [&](const char* settings) {
    const std::vector<StudyPoint> points = study_points(scene, sweeps, settings);
    EXPECT_EQ(points.size(), 2u);
    return std::array{points[0].key, points[1].key};
  };
  const auto first = keys("newton");
  EXPECT_NE(first[0], first[1]);
  EXPECT_EQ(keys("newton"), first);
  EXPECT_NE(keys("lbfgs")[0], first[0]);
  folder.write("ring.csv", "0,0,0\n1,0,0\n0,2,0\n");
  EXPECT_NE(keys("newton")[0], first[0]);
}

TEST(ParameterStudy, ReadsBackAPointOfTheSameSceneOnly) {
  const TemporaryFolder folder;
  const PointResult written = result_of(7, 2.5);
  write_point(folder.path(), written);
  StudyPoint point{7, {"7"}, "", "k"};
  const auto read = read_point(folder.path(), point);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->metric("orifice_area_mm2"), 2.5);
  EXPECT_EQ(read->metric("coaptation_area_mm2"), std::nullopt);
  EXPECT_TRUE(read->has_converged());
  point.key = "another scene";
  EXPECT_FALSE(read_point(folder.path(), point).has_value());
  point.key = "k";
  folder.write("point.json", R"({"number": 7, "key": )");  // half written, by another program
  EXPECT_FALSE(read_point(folder.path(), point).has_value());
  folder.write("point.json",
               R"({"key": "k", "status": "converged", "message": "", "residual": 0, "iterations": 1e300,
                                 "wall_s": 1, "metrics": {}})");
  EXPECT_FALSE(read_point(folder.path(), point).has_value()) << "no count";
}

}  // namespace
}  // namespace coapt
