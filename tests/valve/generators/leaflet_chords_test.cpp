#include "valve/generators/leaflet_chords.hpp"

#include "core/error.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace coapt {
namespace {

constexpr int kColumns = 60, kRows = 8;  // of the funnel; row 0 is the annulus

// A funnel around z with the annulus of radius 15 in z = 0 and the free edge of radius 9 at z = -18; three
// tips below it, so that it may be any valve. The rims are not named.
Valve funnel() {
  Valve valve;
  TriangleMesh& mesh = valve.leaflets;
  mesh.vertices.resize(3, kColumns * (kRows + 1));
  mesh.triangles.resize(3, 2 * kColumns * kRows);
  int t = 0;
  for (int j = 0; j <= kRows; ++j)
    for (int i = 0; i < kColumns; ++i) {
      const double q = 2 * std::numbers::pi * i / kColumns, s = static_cast<double>(j) / kRows,
                   r = 15 - 6 * s;
      mesh.vertices.col(j * kColumns + i) << r * std::cos(q), r * std::sin(q), -18 * s;
      if (j == kRows) continue;
      const int a = j * kColumns + i, b = j * kColumns + (i + 1) % kColumns;
      mesh.triangles.col(t++) << a, a + kColumns, b;
      mesh.triangles.col(t++) << b, a + kColumns, b + kColumns;
    }
  valve.chords.papillary.resize(3, 3);
  for (int k = 0; k < 3; ++k) {
    const double q = 2 * std::numbers::pi * (k + 0.31) / 3;
    valve.chords.papillary.col(k) << 10 * std::cos(q), 10 * std::sin(q), -30;
  }
  return valve;
}

Valve funnel_with_rims() {
  Valve valve = funnel();
  find_rims(valve);
  return valve;
}

Vec3 place(const Valve& valve, const ChordNetwork& network, const ChordEnd& end) {
  if (end.kind == ChordEnd::Kind::Leaflet) return valve.leaflets.vertices.col(end.index);
  return end.kind == ChordEnd::Kind::Papillary ? network.papillary.col(end.index)
                                               : network.junctions.col(end.index);
}

TEST(LeafletChordsTest, FindsTheRims) {
  const Valve valve = funnel_with_rims();
  ASSERT_EQ(valve.annulus.size(), static_cast<size_t>(kColumns));
  ASSERT_EQ(valve.free_edge.size(), static_cast<size_t>(kColumns));
  EXPECT_LT(*std::max_element(valve.annulus.begin(), valve.annulus.end()), kColumns);
  EXPECT_GE(*std::min_element(valve.free_edge.begin(), valve.free_edge.end()), kColumns * kRows);
  Valve disc = funnel();
  disc.leaflets.triangles.conservativeResize(3, 2);
  EXPECT_THROW(find_rims(disc), InputError);
}

TEST(LeafletChordsTest, FindsTheRimsOfAMitralValve) {
  const Valve known = mitral_valve({.triangles = 625, .preset = MitralPreset::Benchmark});
  Valve valve;
  valve.leaflets = known.leaflets;
  valve.chords.papillary = known.chords.papillary;
  find_rims(valve);
  EXPECT_EQ(std::set<int>(valve.annulus.begin(), valve.annulus.end()),
            std::set<int>(known.annulus.begin(), known.annulus.end()));
  EXPECT_EQ(std::set<int>(valve.free_edge.begin(), valve.free_edge.end()),
            std::set<int>(known.free_edge.begin(), known.free_edge.end()));
}

// Straight chords: the scale times the distance from the tip to the vertex, lifted to the depth below z = 0.
TEST(LeafletChordsTest, MeasuresStraightChordsFromTheAnnulusPlane) {
  const Valve valve = funnel_with_rims();
  const ChordNetwork network = leaflet_chords(valve, {.count = 20, .scale = 0.9, .depth = 4});
  ASSERT_EQ(network.chords.size(), 20u);
  EXPECT_EQ(network.junctions.cols(), 0);
  std::set<int> ends, tips;
  for (const Chord& chord : network.chords) {
    ASSERT_EQ(chord.from.kind, ChordEnd::Kind::Papillary);
    ASSERT_EQ(chord.to.kind, ChordEnd::Kind::Leaflet);
    Vec3 expected = valve.leaflets.vertices.col(chord.to.index);
    const Vec3 tip = network.papillary.col(chord.from.index);
    for (int k = 0; k < 3; ++k)
      EXPECT_LE((tip - expected).norm(), (network.papillary.col(k) - expected).norm() + 1e-12);
    expected.z() = -4;
    EXPECT_NEAR(chord.rest_length, 0.9 * (tip - expected).norm(), 1e-10);
    EXPECT_EQ(chord.material, "primary");
    EXPECT_EQ(chord.area, 0.4);
    EXPECT_EQ(chord.level, 1);
    ends.insert(chord.to.index);
    tips.insert(chord.from.index);
  }
  EXPECT_EQ(ends.size(), 20u);
  EXPECT_GE(*ends.begin(), kColumns * kRows);
  EXPECT_EQ(tips.size(), 3u);
  for (auto a = ends.begin(), b = std::next(a); b != ends.end(); ++a, ++b)
    EXPECT_EQ(*b - *a, 3);  // equal steps
}

// Walczak et al. 2019, section 3.5: by hand. A tip as far below the centroid of its insertions as that is
// below the plane; a chord as long as the distances of its insertion from plane and tip together.
TEST(LeafletChordsTest, PlacesTipsThatNobodySawByTheInsertions) {
  Valve valve = funnel();
  valve.chords.papillary.resize(3, 0);
  find_rims(valve);
  ASSERT_EQ(*std::max_element(valve.annulus.begin(), valve.annulus.end()),
            kColumns - 1);  // encloses the most
  const int edge = kColumns * kRows, body = kColumns * kRows / 2;
  const std::vector<int> right{edge, edge + 5, body + 58}, left{edge + 30, edge + 27, body + 33};
  std::vector<int> all = right;
  all.insert(all.end(), left.begin(), left.end());
  valve.commissures = {30, 0};  // from left to right
  for (const bool in_groups : {true, false}) {
    const ChordNetwork network =
        leaflet_chords(valve, {.scale = 1.1,
                               .lengths = ChordLengths::Sum,
                               .insertions = in_groups ? std::vector<std::vector<int>>{left, right}
                                                       : std::vector<std::vector<int>>{all}});
    ASSERT_EQ(network.papillary.cols(), 2);
    ASSERT_EQ(network.chords.size(), 6u);
    for (const auto& [tip, ends] : {std::pair{0, left}, {1, right}}) {
      Vec3 expected = valve.leaflets.vertices(Eigen::all, ends).rowwise().mean();
      expected.z() *= 2;  // the plane is z = 0
      EXPECT_LT((network.papillary.col(tip) - expected).norm(), 1e-9);
    }
    for (const Chord& chord : network.chords) {
      const Vec3 end = valve.leaflets.vertices.col(chord.to.index),
                 tip = network.papillary.col(chord.from.index);
      EXPECT_NEAR(chord.rest_length, 1.1 * (-end.z() + (end - tip).norm()), 1e-9);
      EXPECT_EQ(chord.from.index, end.x() > 0 ? 1 : 0);
      EXPECT_EQ(chord.material, chord.to.index >= edge ? "primary" : "secondary");
    }
  }
}

// Where nobody names insertions either: half of the chords of each zone to each tip, by the longest diameter.
TEST(LeafletChordsTest, PlacesTipsByInsertionsOfItsOwn) {
  Valve valve = funnel();
  valve.leaflets.vertices.row(1) *= 1.3;
  valve.chords.papillary.resize(3, 0);
  find_rims(valve);
  const ChordNetwork network =
      leaflet_chords(valve, {.zones = {chord_zone("free_edge"), chord_zone("rough")}, .count = 10});
  ASSERT_EQ(network.papillary.cols(), 2);
  EXPECT_LT(network.papillary(1, 0) * network.papillary(1, 1), -16);
  EXPECT_LT(network.papillary.row(0).cwiseAbs().maxCoeff(), 1);
  int of_first = 0;
  for (const Chord& chord : network.chords) {
    of_first += chord.from.index == 0 ? 1 : 0;
    EXPECT_GT(valve.leaflets.vertices(1, chord.to.index) * network.papillary(1, chord.from.index), -9);
  }
  EXPECT_EQ(of_first, 10);
}

TEST(LeafletChordsTest, TakesTheClosedRimAndTipsWhereTheyAreKnown) {
  Valve valve = funnel_with_rims();
  for (const int v : valve.annulus) {
    valve.annulus_closed.conservativeResize(3, valve.annulus_closed.cols() + 1);
    valve.annulus_closed.rightCols<1>() = valve.leaflets.vertices.col(v) + Vec3(0, 0, 2);
  }
  valve.chords.papillary_closed = valve.chords.papillary.colwise() + Vec3(1, 0, -1);
  const ChordNetwork network = leaflet_chords(valve, {.count = 10});
  for (const Chord& chord : network.chords) {
    Vec3 expected = valve.leaflets.vertices.col(chord.to.index);
    expected.z() = 2;
    const Vec3 tip = valve.chords.papillary_closed.col(chord.from.index);
    EXPECT_NEAR(chord.rest_length, (tip - expected).norm(), 1e-10);
  }
}

TEST(LeafletChordsTest, BranchesLevelByLevel) {
  const Valve valve = funnel_with_rims();
  const ChordNetwork network =
      leaflet_chords(valve, {.zones = {chord_zone("free_edge")}, .count = 5, .levels = 3, .branches = 2});
  std::map<int, int> counts;
  std::map<int, double> areas;
  for (const Chord& chord : network.chords) {
    ++counts[chord.level];
    areas[chord.level] += chord.area;
    EXPECT_GT(chord.rest_length, 0);
  }
  EXPECT_EQ(counts, (std::map<int, int>{{1, 5}, {2, 10}, {3, 20}}));
  for (const auto& [level, area] : areas) EXPECT_NEAR(area, 5 * 0.4, 1e-12) << level;
  EXPECT_EQ(network.junctions.cols(), 15);
  std::vector<int> ends(15, 0);  // chords at each junction: one from the tip's side, two to the leaflet's
  for (const Chord& chord : network.chords)
    for (const ChordEnd& end : {chord.from, chord.to})
      if (end.kind == ChordEnd::Kind::Junction) ++ends[static_cast<size_t>(end.index)];
  EXPECT_EQ(ends, std::vector<int>(15, 3));
  const ChordNetwork given =
      leaflet_chords(valve, {.count = 5, .levels = 2, .branches = 4, .level_areas = {0.7, 0.3}});
  for (const Chord& chord : given.chords) EXPECT_EQ(chord.area, chord.level == 1 ? 0.7 : 0.3);
}

TEST(LeafletChordsTest, StartsWithSlackChordsWhereTheyAreLongEnough) {
  const Valve valve = funnel_with_rims();
  for (const int levels : {1, 2, 3}) {
    const ChordNetwork network =
        leaflet_chords(valve, {.count = 6, .levels = levels, .branches = 3, .depth = 3});
    for (const Chord& chord : network.chords)
      EXPECT_LE((place(valve, network, chord.from) - place(valve, network, chord.to)).norm(),
                chord.rest_length * (1 + 1e-9));
  }
}

TEST(LeafletChordsTest, PutsZonesAtTheirHeights) {
  const Valve valve = funnel_with_rims();
  const ChordNetwork network = leaflet_chords(
      valve, {.zones = {chord_zone("free_edge"), chord_zone("rough"), chord_zone("basal")}, .count = 12});
  const std::map<std::string, double> rows{
      {"primary", kRows}, {"secondary", 0.65 * kRows}, {"tertiary", 0.25 * kRows}};
  std::map<std::string, std::set<int>> columns;
  for (const Chord& chord : network.chords) {
    EXPECT_NEAR(chord.to.index / kColumns, rows.at(chord.material), 0.5 + 1e-9) << chord.material;
    columns[chord.material].insert(chord.to.index % kColumns);
  }
  for (const auto& [material, places] : columns) EXPECT_EQ(places.size(), 12u) << material;
}

// A funnel that is longer on one side: its cells are oblique.
Valve oblique_funnel(bool has_other_diagonals) {
  Valve valve = funnel_with_rims();
  for (auto x : valve.leaflets.vertices.colwise()) x[2] *= (14 - 8 * std::cos(std::atan2(x[1], x[0]))) / 18;
  valve.chords.papillary.row(2).setConstant(-40);
  if (has_other_diagonals)
    for (int t = 0; t < valve.leaflets.triangle_count(); t += 2) {
      const int a = valve.leaflets.triangles(0, t), below = valve.leaflets.triangles(1, t),
                b = valve.leaflets.triangles(2, t), below_b = valve.leaflets.triangles(2, t + 1);
      valve.leaflets.triangles.col(t) << a, below, below_b;
      valve.leaflets.triangles.col(t + 1) << a, below_b, b;
    }
  return valve;
}

TEST(LeafletChordsTest, EndsWhereItDidOnTheSameVerticesWithOtherTriangles) {
  std::vector<int> ends[2];
  for (const bool has_other_diagonals : {false, true})
    for (const Chord& chord :
         leaflet_chords(oblique_funnel(has_other_diagonals), {.zones = {chord_zone("rough")}}).chords)
      ends[has_other_diagonals ? 1 : 0].push_back(chord.to.index);
  EXPECT_EQ(ends[0], ends[1]);
}

// Of the rest lengths, if the free edge hangs by this height. The funnel's columns are straight.
double greatest_error_of_coapted_lengths(const Valve& valve, double height) {
  const LeafletChordOptions options = {.zones = {chord_zone("free_edge"), {"secondary", 0.8, 0.8}},
                                       .scale = 0.9,
                                       .depth = 1,
                                       .lengths = ChordLengths::ToCoapted};
  double error = 0;
  for (const Chord& chord : leaflet_chords(valve, options).chords) {
    Vec3 expected = valve.leaflets.vertices.col(chord.to.index);
    const double from_edge = (18 + expected.z()) * std::sqrt(6 * 6 + 18 * 18) / 18;
    expected.z() = -1 - std::max(0.0, height - from_edge);
    const Vec3 tip = valve.chords.papillary.col(chord.from.index);
    error = std::max(error, std::abs(chord.rest_length - 0.9 * (tip - expected).norm()));
  }
  return error;
}

TEST(LeafletChordsTest, ExpectsTheFreeEdgeToHangByHalfOfTheAreaThatIsLeftOver) {
  Valve valve = funnel_with_rims();
  const double side = std::sin(std::numbers::pi / kColumns),
               area = surface_area(valve.leaflets.vertices, valve.leaflets.triangles),
               annulus = 0.5 * kColumns * 15 * 15 * std::sin(2 * std::numbers::pi / kColumns),
               edge = kColumns * 2 * 9 * side;
  EXPECT_LT(greatest_error_of_coapted_lengths(valve, 0.5 * (area - annulus) / edge), 1e-10);
  // A wide closed annulus leaves nothing over.
  for (const int v : valve.annulus) {
    valve.annulus_closed.conservativeResize(3, valve.annulus_closed.cols() + 1);
    valve.annulus_closed.rightCols<1>() = 2 * valve.leaflets.vertices.col(v);
  }
  EXPECT_LT(greatest_error_of_coapted_lengths(valve, 0), 1e-10);
  // Ends stay above the middle of the way to the tips.
  valve.annulus_closed.resize(3, 0);
  valve.chords.papillary.row(2).setConstant(-9);
  EXPECT_LT(greatest_error_of_coapted_lengths(valve, 0.5 * (9 - 1)), 1e-10);
}

TEST(LeafletChordsTest, RepeatsASeedAndOnlyThat) {
  const Valve valve = funnel_with_rims();
  const auto ends = [&](unsigned seed) {
    std::vector<int> list;
    for (const Chord& chord : leaflet_chords(valve, {.count = 15, .seed = seed}).chords)
      list.push_back(chord.to.index);
    return list;
  };
  EXPECT_EQ(ends(7), ends(7));
  EXPECT_NE(ends(7), ends(8));
  EXPECT_NE(ends(7), ends(0));
}

TEST(LeafletChordsTest, NamesEveryDefect) {
  const auto defects = [](const Valve& valve, const LeafletChordOptions& options) -> size_t {
    try {
      leaflet_chords(valve, options);
    } catch (const InputError& error) {
      return error.defects().size();
    }
    return 0;
  };
  const Valve valve = funnel_with_rims();
  EXPECT_EQ(defects(valve, {.count = 0, .levels = 9, .branches = 1, .scale = 0, .depth = -1}), 5u);
  EXPECT_EQ(defects(valve, {.levels = 2, .level_areas = {1}}), 1u);
  EXPECT_EQ(defects(valve, {.zones = {chord_zone("free_edge"), chord_zone("free_edge")}, .count = 61}), 2u);
  EXPECT_EQ(defects(Valve(), {}), 2u);
  const int last = valve.leaflets.vertex_count() - 1;
  EXPECT_EQ(defects(valve, {.insertions = {{-1, last + 1, 0, last, last}}}), 4u);  // 0 is on the annulus
  EXPECT_EQ(defects(valve, {.insertions = {{last}, {last - 9}}}), 1u);             // two groups, three tips
  EXPECT_EQ(defects(valve, {.levels = 2, .lengths = ChordLengths::Sum, .insertions = {{last}}}), 2u);
  Valve unseen = valve;
  unseen.chords.papillary.resize(3, 0);
  EXPECT_EQ(defects(unseen, {.insertions = {{last}, {}}}), 1u);  // an empty half
  Valve flat = unseen;
  flat.leaflets.vertices.row(2) *= -1e-3;
  for (int k = 0; k < kColumns; ++k) flat.leaflets.vertices(2, kColumns + k) = -5;  // the body, not the edge
  EXPECT_EQ(defects(flat, {}), 2u);              // both centroids above the plane
  EXPECT_EQ(defects(valve, {.depth = 30}), 3u);  // each tip
  Valve above = valve;
  above.chords.papillary(2, 1) = 3;
  EXPECT_EQ(defects(above, {}), 1u);
  for (const double bad : {kNaN, kInfinity, 1e200}) {
    Valve far = valve;
    far.chords.papillary(0, 1) = bad;
    EXPECT_EQ(defects(far, {}), 1u) << bad;
    far = valve;
    far.chords.papillary_closed = valve.chords.papillary;
    far.chords.papillary_closed(2, 0) = -bad;
    EXPECT_EQ(defects(far, {}), 1u) << bad;
  }
  EXPECT_THROW(chord_zone("fre_edge"), InputError);
}

}  // namespace
}  // namespace coapt
