#include "formats/json/closed_curve.hpp"

#include "core/error.hpp"
#include "formats/json/markups.hpp"
#include "formats/json/valve_json.hpp"
#include "mesh/curve_match.hpp"
#include "mesh/distance/intersections.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

// Of a circle of radius 15, the first `part`.
Points arc(int count, double part) {
  Points points(3, count);
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * part * k / count;
    points.col(k) << 15 * std::cos(angle), 15 * std::sin(angle), 0;
  }
  return points;
}

std::string refusal(const std::filesystem::path& path) {
  try {
    read_closed_curve(path);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(ClosedCurve, IsReadFromMarkupsAndNumbers) {
  const TemporaryFolder folder;
  const auto mrk = folder.path() / "ring.mrk.json";
  const Points ring = arc(24, 1), tips = Points::Ones(3, 9);
  write_markups(mrk, {{"tips", "Fiducial", tips, {}}, {"ring", "ClosedCurve", ring, {}}});
  EXPECT_EQ(read_closed_curve(mrk), ring) << "points and curve in one file";
  EXPECT_EQ(papillary_points(mrk), tips);
  write_markups(mrk, {{"ring", "ClosedCurve", arc(24, 0.5), {}}});
  EXPECT_EQ(read_closed_curve(mrk).cols(), 24) << "it says that it is closed";
  const auto csv = folder.write("ring.csv", "x,y,z\n1,0,0\n0,1,0\n-1,0,0\n0,-1,0\n1,0,0\n");
  EXPECT_EQ(read_closed_curve(csv).cols(), 5);
}

TEST(ClosedCurve, IsRefusedWhereItIsOpen) {
  const TemporaryFolder folder;
  const auto mrk = folder.path() / "ring.mrk.json";
  for (const char* type : {"Curve", "Fiducial"}) {
    write_markups(mrk, {{"ring", type, arc(24, 0.8), {}}});
    EXPECT_NE(refusal(mrk).find("ring.mrk.json: the curve is open: its ends are"), std::string::npos)
        << refusal(mrk);
    write_markups(mrk, {{"ring", type, arc(24, 0.95), {}}});
    EXPECT_EQ(refusal(mrk), "accepted");
  }
  const auto csv = folder.write("ring.csv", "1 0 0\n2 0 0\n3 0 0\n4 0 0\n5 0 0\n6 0 0\n");
  EXPECT_NE(refusal(csv).find("5 mm apart, its neighbours at most 1 mm"), std::string::npos) << refusal(csv);
  EXPECT_NE(refusal(folder.write("bad.csv", "1 0 0\n2 0\n")).find("bad.csv:2: expected three"),
            std::string::npos);
  EXPECT_NE(refusal(folder.path() / "gone.csv").find("no such file"), std::string::npos);
}

// A human annulus with eight papillary roots from CT. It is flat, so the tips tell where the ventricle is;
// the leaflets that the data's authors hung into it tell which side is anterior.
TEST(RealAnnulus, CarriesAGeneratedValve) {
  const auto data = std::filesystem::path(COAPT_SHARED_DIR) / "data" / "mitral-ct-normal1";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "skipped: data not found";
  const ValveFile skeleton = read_valve(data / "ct_skeleton.json", ValveMeshes::Skip);
  const Points& annulus = skeleton.points.at("annulus");
  const Points& tips = skeleton.points.at("papillary");
  const Valve valve = mitral_valve({.triangles = 2500, .preset = MitralPreset::Benchmark},
                                   {.name = "ct", .annulus = annulus, .papillary = tips});
  EXPECT_LT(mean_distance(valve.leaflets.vertices(Eigen::all, valve.annulus), annulus), 1e-9);
  EXPECT_TRUE(intersections(valve.leaflets.vertices, valve.leaflets.triangles).empty());
  EXPECT_EQ(valve.chords.papillary.cols(), 8);

  const Valve theirs = read_valve(data / "valve_n32.json").valve;
  const auto anterior_middle = [](const Valve& v) {
    Vec3 sum = Vec3::Zero();
    int count = 0;
    const auto& names = v.leaflets.region_names;
    for (int t = 0; t < v.leaflets.triangle_count(); ++t)
      if (names[static_cast<size_t>(v.leaflets.regions[static_cast<size_t>(t)])] == "anterior")
        for (const int corner : v.leaflets.triangles.col(t)) {
          sum += v.leaflets.vertices.col(corner);
          ++count;
        }
    return Vec3(sum / count);
  };
  const Vec3 centre = annulus.rowwise().mean();
  const Vec3 ours = anterior_middle(valve) - centre, known = anterior_middle(theirs) - centre;
  EXPECT_GT(ours.normalized().dot(known.normalized()), 0.8);
}

}  // namespace
}  // namespace coapt
