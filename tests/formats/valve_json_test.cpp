#include "formats/json/valve_json.hpp"

#include "core/error.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

Valve small_valve() {
  Valve valve;
  valve.name = "one \"leaflet\"";
  valve.leaflets.vertices.resize(3, 3);
  valve.leaflets.vertices << 0, 1.0 / 3, 0, 0, 0, 0.1, 0, 1e-17, 7;
  valve.leaflets.triangles.resize(3, 1);
  valve.leaflets.triangles << 0, 1, 2;
  valve.closed_reference = valve.leaflets;
  valve.closed_reference->vertices *= 1.1;
  valve.annulus = {2, 0};
  valve.annulus_closed = valve.leaflets.vertices.leftCols(2) * (1 / 7.0);
  valve.free_edge = {1};
  valve.commissures = {0, 2};
  valve.chords.papillary = Vec3(0.1, 0.2, -3);
  valve.chords.papillary_closed = Vec3(0.1, 0.2, -2.9);
  valve.chords.junctions = Vec3(0.3, 0.2, -1);
  valve.chords.chords = {
      {{ChordEnd::Kind::Papillary, 0}, {ChordEnd::Kind::Junction, 0}, 2.0 / 3, 0.7, "strut", 1},
      {{ChordEnd::Kind::Junction, 0}, {ChordEnd::Kind::Leaflet, 1}, 1.0 / 3, 0, "", 0}};
  valve.pressure = 0.016;
  valve.thickness = 0.65;
  return valve;
}

TEST(ValveJson, ReadsBackBitByBitWhatItWrote) {
  const TemporaryFolder folder;
  const Valve valve = small_valve();
  write_valve(folder.path() / "valve.json", valve);
  const Valve read = read_valve(folder.path() / "valve.json").valve;
  EXPECT_EQ(read.name, valve.name);
  EXPECT_EQ(read.leaflets.vertices, valve.leaflets.vertices);
  EXPECT_EQ(read.leaflets.triangles, valve.leaflets.triangles);
  EXPECT_EQ(read.closed_reference->vertices, valve.closed_reference->vertices);
  EXPECT_EQ(read.annulus, valve.annulus);
  EXPECT_EQ(read.annulus_closed, valve.annulus_closed);
  EXPECT_EQ(read.free_edge, valve.free_edge);
  EXPECT_EQ(read.commissures, valve.commissures);
  EXPECT_EQ(read.chords.papillary, valve.chords.papillary);
  EXPECT_EQ(read.chords.papillary_closed, valve.chords.papillary_closed);
  EXPECT_EQ(read.chords.junctions, valve.chords.junctions);
  ASSERT_EQ(read.chords.chords.size(), 2u);
  for (size_t k = 0; k < 2; ++k) {
    const Chord &a = read.chords.chords[k], &b = valve.chords.chords[k];
    EXPECT_EQ(a.from.kind, b.from.kind);
    EXPECT_EQ(a.to.index, b.to.index);
    EXPECT_EQ(a.rest_length, b.rest_length);
    EXPECT_EQ(a.area, b.area);
    EXPECT_EQ(a.material, b.material);
    EXPECT_EQ(a.level, b.level);
  }
  EXPECT_EQ(read.pressure, valve.pressure);
  EXPECT_EQ(read.thickness, valve.thickness);
}

TEST(ValveJson, ScalesTheUnitOfTheFile) {
  const TemporaryFolder folder;
  const auto path = folder.write("valve.json", R"({
    "units": "cm", "pressure": {"value": 120, "unit": "mmHg"}, "papillary": [[1, 2, 3]], "junctions": [[0, 0, 1]],
    "chords": [{"from": {"papillary": 0}, "to": {"junction": 0}, "rest_length": 3, "area": 0.01}],
    "waist_loop": [4, 5], "sets": {"fixAll": [1]}})");
  const ValveFile file = read_valve(path);
  EXPECT_EQ(file.valve.chords.papillary.col(0), Vec3(10, 20, 30));
  EXPECT_EQ(file.valve.chords.chords[0].rest_length, 30);
  EXPECT_EQ(file.valve.chords.chords[0].area, 1);
  EXPECT_DOUBLE_EQ(file.valve.pressure, 120 * 133.322387415e-6);
  EXPECT_EQ(file.sets.at("waist_loop"), (std::vector<int>{4, 5}));
  EXPECT_EQ(file.sets.at("fixAll"), (std::vector<int>{1}));
}

TEST(ValveJson, NamesEveryBadEntry) {
  const TemporaryFolder folder;
  const auto path = folder.write("valve.json", R"({
    "units": "parsec", "annulus": "all", "papillary": [[1, 2, 3]], "free_edge": [-1],
    "chords": [{"from": {"papillary": 1}, "to": {"leaflet": 0}, "rest_length": 3},
               {"from": {"papillary": 0}, "to": {"node": 0}, "rest_length": 3},
               {"from": {"papillary": 0}, "to": {"leaflet": 0}},
               {"from": {"papillary": 0}, "to": {"leaflet": 0}, "rest_length": -1}]})");
  try {
    read_valve(path);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string text = error.what();
    for (const char* part : {"units: unknown unit", "annulus: expected", "free_edge[0]: read -1",
                             "chords[0].from: papillary 1 does not exist", "chords[1].to: expected one of",
                             "chords[2].rest_length: missing", "chords[3].rest_length: is negative"})
      EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  }
}

TEST(ValveJson, IsNotWrittenWithNumbersThatJsonHasNoWordFor) {
  const TemporaryFolder folder;
  Valve valve = small_valve();
  valve.chords.papillary(1, 0) = kNaN;
  valve.chords.chords[1].rest_length = kInfinity;
  valve.leaflets.vertices(0, 2) = 1e200;
  try {
    write_valve(folder.path() / "valve.json", valve);
    FAIL() << "written";
  } catch (const InputError& error) {
    for (const char* part :
         {"papillary[0]: a coordinate", "chords[1].rest_length: is not finite", "leaflets[2]: a coordinate"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(ValveJson, RefusesNumbersThatOverflow) {
  const TemporaryFolder folder;
  try {
    read_valve(folder.write("valve.json", R"({"units": "m", "papillary": [[1e308, 0, 0], [0, 0, 0]],
      "chords": [{"from": {"papillary": 0}, "to": {"papillary": 1}, "rest_length": 1e308, "area": 1e200}]})"));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    for (const char* part :
         {"papillary[0]: a coordinate", "chords[0].rest_length: is greater", "chords[0].area: is greater"})
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

constexpr const char* kSquare = R"(v 0 0 0
v 1 0 0
v 2 0 0
v 0 1 0
v 1 1 0
v 2 1 0
v 0 2 0
v 1 2 0
v 2 2 0
f 1 2 5 4
f 2 3 6 5
f 4 5 8 7
f 5 6 9 8
)";

TEST(ValveJson, PutsAnAnnulusInTheOrderOfItsRimWithItsClosedPositions) {
  const TemporaryFolder folder;
  folder.write("l.obj", kSquare);
  const ValveFile file = read_valve(folder.write("valve.json", R"({"leaflets": "l.obj",
    "annulus": [0, 1, 2, 3, 5, 6, 7, 8], "annulus_closed": [[0, 0, 10], [0, 0, 11], [0, 0, 12], [0, 0, 13],
    [0, 0, 15], [0, 0, 16], [0, 0, 17], [0, 0, 18]]})"));
  ASSERT_EQ(file.valve.annulus.size(), 8u);
  for (size_t k = 0; k < 8; ++k) {
    const int v = file.valve.annulus[k], next = file.valve.annulus[(k + 1) % 8];
    EXPECT_EQ((file.valve.leaflets.vertices.col(v) - file.valve.leaflets.vertices.col(next)).norm(), 1);
    EXPECT_EQ(file.valve.annulus_closed(2, static_cast<int>(k)), 10 + v);
  }
  EXPECT_EQ(file.sets.at("annulus"), file.valve.annulus);
  EXPECT_EQ(file.points.at("annulus_closed"), file.valve.annulus_closed);
  ASSERT_EQ(file.warnings.size(), 2u) << "polygons were cut";
  EXPECT_NE(file.warnings[1].find("annulus: its vertices did not follow one another"), std::string::npos);
}

struct DataFile {
  const char* path;
  int vertices;
  size_t chords;
};

class ValveData : public testing::TestWithParam<DataFile> {};

TEST_P(ValveData, IsReadWhole) {
  const std::filesystem::path path = std::filesystem::path(COAPT_SHARED_DIR) / "data" / GetParam().path;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "skipped: data not found";
  const Valve valve = read_valve(path).valve;
  EXPECT_EQ(valve.leaflets.vertex_count(), GetParam().vertices);
  EXPECT_EQ(valve.chords.chords.size(), GetParam().chords);
  EXPECT_FALSE(valve.annulus.empty());
  EXPECT_FALSE(valve.pressure == 0);
}

INSTANTIATE_TEST_SUITE_P(Files, ValveData,
                         testing::Values(DataFile{"trivalve11-healthy/valve.json", 8587, 1836},
                                         DataFile{"trivalve11-healthy/valve_coarse.json", 964, 507},
                                         DataFile{"mitral-ct-normal1/valve_n32.json", 208, 56},
                                         DataFile{"mitral-ct-normal1/valve_n64.json", 672, 120},
                                         DataFile{"mitral-ct-normal1/valve_n128.json", 2500, 248},
                                         DataFile{"bhv-trileaflet/valve_coarse.json", 1071, 0},
                                         DataFile{"bhv-trileaflet/valve_fine.json", 4059, 0}));

TEST(ValveJson, FindsNamedSetsInOtherDescriptions) {
  const std::filesystem::path data = std::filesystem::path(COAPT_SHARED_DIR) / "data";
  if (!std::filesystem::exists(data)) GTEST_SKIP() << "skipped: data not found";
  EXPECT_EQ(read_valve(data / "mem4py-benchmarks/henky.json", ValveMeshes::Skip).sets.at("fixAll").size(),
            76u);
  EXPECT_EQ(read_valve(data / "kratos-4point-tent/tent.json", ValveMeshes::Skip).sets.at("fixed").size(),
            40u);
  EXPECT_EQ(read_valve(data / "cloth-skirt/skirt.json", ValveMeshes::Skip).sets.at("waist_loop").size(), 43u);
}

}  // namespace
}  // namespace coapt
