#include "valve/repair_valve.hpp"

#include "mesh/mesh_check.hpp"
#include "mesh/rim_order.hpp"
#include "valve/generators/mitral.hpp"
#include "valve/valve_check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <tuple>

namespace coapt {
namespace {

bool holds(const std::vector<int>& list, int v) {
  return std::find(list.begin(), list.end(), v) != list.end();
}

std::vector<bool> named_vertices(const Valve& valve) {
  std::vector<bool> named(static_cast<size_t>(valve.leaflets.vertex_count()), false);
  for (const std::vector<int>* list : {&valve.annulus, &valve.free_edge, &valve.commissures})
    for (const int v : *list) named[static_cast<size_t>(v)] = true;
  for (const Chord& chord : valve.chords.chords)
    if (chord.to.kind == ChordEnd::Kind::Leaflet) named[static_cast<size_t>(chord.to.index)] = true;
  return named;
}

// A generated valve whose reference is itself, pushed aside.
Valve sample() {
  Valve valve = mitral_valve({.triangles = 600, .preset = MitralPreset::Benchmark});
  valve.closed_reference = valve.leaflets;
  valve.closed_reference->vertices.row(2).array() += 5;
  valve.sets["all of it"] = {};
  for (int v = 0; v < valve.leaflets.vertex_count(); ++v) valve.sets["all of it"].push_back(v);
  return valve;
}

// Positions by which vertices are known again.
Points at(const Points& x, const std::vector<int>& list) { return x(Eigen::all, list); }

TEST(RepairValve, RenumbersAllThatNamesVertices) {
  Valve valve = sample();
  // An unnamed vertex goes close to a neighbour.
  const std::vector<bool> named = named_vertices(valve);
  int moved = -1, to = -1;
  for (int t = 0; t < valve.leaflets.triangle_count() && moved < 0; ++t)
    for (int k = 0; k < 3; ++k) {
      const int v = valve.leaflets.triangles(k, t), u = valve.leaflets.triangles((k + 1) % 3, t);
      if (!named[static_cast<size_t>(v)] && !named[static_cast<size_t>(u)])
        std::tie(moved, to) = std::tuple(v, u);
    }
  ASSERT_GE(moved, 0);
  Points& x = valve.leaflets.vertices;
  x.col(moved) = x.col(to) + 1e-6 * (x.col(moved) - x.col(to));
  const Valve before = valve;
  const ValveRepair repair = repair_valve(valve, kSliverAspect);
  ASSERT_TRUE(repair.leaflets.is_changed());
  EXPECT_TRUE(repair.leaflets.left.empty());
  EXPECT_EQ(valve.leaflets.vertex_count(), before.leaflets.vertex_count() - 1);
  EXPECT_TRUE(slivers(valve.leaflets, kSliverAspect).empty());
  EXPECT_EQ(at(valve.leaflets.vertices, valve.annulus), at(before.leaflets.vertices, before.annulus));
  EXPECT_EQ(valve.annulus_closed, before.annulus_closed);
  EXPECT_EQ(at(valve.leaflets.vertices, valve.free_edge), at(before.leaflets.vertices, before.free_edge));
  EXPECT_EQ(at(valve.leaflets.vertices, valve.commissures), at(before.leaflets.vertices, before.commissures));
  for (size_t k = 0; k < before.chords.chords.size(); ++k) {
    if (before.chords.chords[k].to.kind != ChordEnd::Kind::Leaflet) continue;
    EXPECT_EQ(valve.leaflets.vertices.col(valve.chords.chords[k].to.index),
              before.leaflets.vertices.col(before.chords.chords[k].to.index));
  }
  const std::vector<int>& all = valve.sets["all of it"];
  EXPECT_EQ(static_cast<int>(all.size()), valve.leaflets.vertex_count());
  // Each region lost the triangles at the short edge alone, and the reference is the same mesh.
  EXPECT_EQ(valve.leaflets.regions.size(), static_cast<size_t>(valve.leaflets.triangle_count()));
  ASSERT_TRUE(repair.has_reference);
  EXPECT_EQ(valve.closed_reference->triangles, valve.leaflets.triangles);
  Points aside = valve.leaflets.vertices;
  aside.row(2).array() += 5;
  EXPECT_LT((valve.closed_reference->vertices - aside).colwise().norm().maxCoeff(), 4);
  EXPECT_EQ(rim_loop(valve.annulus, valve.leaflets.triangles).is_reordered, false);
}

// A vertex of the second row goes to within 1e-6 of the rim between two of its vertices.
Valve flattened(const std::vector<int> Valve::*rim, int& apex) {
  Valve valve = sample();
  const std::vector<bool> named = named_vertices(valve);
  const std::vector<int>& loop = valve.*rim;
  apex = -1;
  for (const Edge& edge : edges(valve.leaflets.triangles)) {
    if (edge.triangles.size() != 1 || !holds(loop, edge.a) || !holds(loop, edge.b)) continue;
    const int v = valve.leaflets.triangles.col(edge.triangles[0]).sum() - edge.a - edge.b;
    if (named[static_cast<size_t>(v)]) continue;
    apex = v;
    Points& x = valve.leaflets.vertices;
    const Vec3 middle = 0.6 * x.col(edge.a) + 0.4 * x.col(edge.b);
    x.col(v) = middle + 1e-6 * (x.col(v) - middle);
    break;
  }
  return valve;
}

TEST(RepairValve, LeadsTheFreeEdgeThroughTheApexOfAFlatTriangle) {
  int apex = -1;
  Valve valve = flattened(&Valve::free_edge, apex);
  ASSERT_GE(apex, 0);
  const size_t before = valve.free_edge.size();
  const ValveRepair repair = repair_valve(valve, kSliverAspect);
  EXPECT_TRUE(repair.leaflets.left.empty());
  EXPECT_TRUE(slivers(valve.leaflets, kSliverAspect).empty());
  EXPECT_EQ(valve.free_edge.size(), before + 1);
  EXPECT_TRUE(holds(valve.free_edge, apex));
  EXPECT_FALSE(rim_loop(valve.free_edge, valve.leaflets.triangles).is_reordered);
}

TEST(RepairValve, TakesTheApexOfAFlatTriangleIntoTheAnnulusWithItsClosedPlace) {
  int apex = -1;
  Valve valve = flattened(&Valve::annulus, apex);
  ASSERT_GE(apex, 0);
  ASSERT_GT(valve.annulus_closed.cols(), 0);
  const size_t before = valve.annulus.size();
  repair_valve(valve, kSliverAspect);
  EXPECT_TRUE(slivers(valve.leaflets, kSliverAspect).empty());
  ASSERT_EQ(valve.annulus.size(), before + 1);
  ASSERT_EQ(valve.annulus_closed.cols(), static_cast<Eigen::Index>(before) + 1);
  const auto place = std::find(valve.annulus.begin(), valve.annulus.end(), apex) - valve.annulus.begin();
  const auto count = static_cast<Eigen::Index>(valve.annulus.size());
  const Vec3 previous = valve.annulus_closed.col((place + count - 1) % count),
             next = valve.annulus_closed.col((place + 1) % count);
  const double share = (valve.annulus_closed.col(place) - previous).norm() / (next - previous).norm();
  EXPECT_NEAR(std::min(share, 1 - share), 0.4, 1e-4);
  EXPECT_FALSE(rim_loop(valve.annulus, valve.leaflets.triangles).is_reordered);
}

bool says(const std::vector<std::string>& doubts, const std::string& part) {
  return std::any_of(doubts.begin(), doubts.end(),
                     [&](const std::string& doubt) { return doubt.find(part) != std::string::npos; });
}

// On a coarse mesh several strands of a fan end at one vertex: one of them is left.
Valve without_copies(unsigned seed = 0) {
  Valve valve = mitral_valve({.triangles = 400, .seed = seed, .preset = MitralPreset::Benchmark});
  std::set<std::array<int, 4>> seen;
  std::erase_if(valve.chords.chords, [&](const Chord& c) {
    return !seen.insert({int(c.from.kind), c.from.index, int(c.to.kind), c.to.index}).second;
  });
  return valve;
}

// Fans of chords end at one vertex where the mesh is coarser than they are wide.
TEST(ValveCheck, HasNoDoubtsAboutGeneratedValves) {
  for (const unsigned seed : {0u, 1u, 2u, 3u, 4u, 5u}) {
    const Valve valve =
        mitral_valve({.triangles = seed == 5 ? 250 : 400,
                      .seed = seed,
                      .preset = seed % 2 == 0 ? MitralPreset::Benchmark : MitralPreset::Closed});
    for (const auto& list :
         {chord_doubts(valve), size_doubts(valve), pressure_side_doubts(valve), fold_doubts(valve.leaflets)})
      EXPECT_TRUE(list.empty()) << seed << ": " << list.front();
  }
}

TEST(ValveCheck, NamesCopiedChordsBesideFansThatEndTogether) {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  const size_t count = valve.chords.chords.size();
  ASSERT_LT(without_copies().chords.chords.size(), count);
  Valve one = valve;
  one.chords.chords.push_back(one.chords.chords[0]);  // a trunk
  EXPECT_TRUE(says(chord_doubts(one), "chord " + std::to_string(count) + ": joins the same two points"));
  Valve all = valve;
  all.chords.chords.insert(all.chords.chords.end(), valve.chords.chords.begin(), valve.chords.chords.end());
  EXPECT_TRUE(says(chord_doubts(all), ": each joins the same two points"));
}

TEST(ValveCheck, NamesAStrandThatEndsWhereItsNeighbourDoesInANetworkOfFewFans) {
  Valve valve = without_copies();
  std::vector<Chord>& chords = valve.chords.chords;
  std::erase_if(chords,
                [](const Chord& c) { return c.from.kind == ChordEnd::Kind::Junction && c.from.index >= 6; });
  EXPECT_FALSE(says(chord_doubts(valve), "the same two points"));
  const auto is_strand = [](const Chord& c) {
    return c.from.kind == ChordEnd::Kind::Junction && c.to.kind == ChordEnd::Kind::Leaflet;
  };
  size_t k = 0;
  while (!is_strand(chords[k]) || !is_strand(chords[k + 1]) ||
         chords[k].from.index != chords[k + 1].from.index)
    ++k;
  chords[k + 1].to = chords[k].to;
  EXPECT_TRUE(says(chord_doubts(valve), "chord " + std::to_string(k + 1) + ": joins the same two points"));
}

TEST(ValveCheck, NamesChordsThatCannotBeMeant) {
  const Valve valve = without_copies();
  const std::string last = std::to_string(valve.chords.chords.size());
  Valve twice = valve;
  twice.chords.chords.push_back(twice.chords.chords[2]);
  EXPECT_TRUE(says(chord_doubts(twice), "chord " + last + ": joins the same two points"));
  Valve nothing = valve;
  nothing.chords.chords[3].rest_length = 0;
  EXPECT_TRUE(says(chord_doubts(nothing), "chord 3: of no rest length"));
  Valve loose = valve;
  const int end = static_cast<int>(loose.chords.junctions.cols());
  loose.chords.junctions.conservativeResize(3, end + 1);
  loose.chords.junctions.col(end) = loose.chords.papillary.col(0);
  loose.chords.chords.push_back({{ChordEnd::Kind::Junction, end}, {ChordEnd::Kind::Leaflet, 0}, 9, 1, "", 0});
  const std::vector<std::string> doubts = chord_doubts(loose);
  EXPECT_TRUE(says(doubts, "junction " + std::to_string(end) + ": ends a single chord"));
  EXPECT_TRUE(says(doubts, "chord " + last + ": no way along chords leads from a papillary tip"));
}

TEST(ValveCheck, NamesALeafletWithoutChords) {
  Valve valve = without_copies();
  std::vector<bool> is_posterior(static_cast<size_t>(valve.leaflets.vertex_count()), false);
  for (int t = 0; t < valve.leaflets.triangle_count(); ++t)
    if (valve.leaflets.region_names[static_cast<size_t>(valve.leaflets.regions[static_cast<size_t>(t)])] ==
        "posterior")
      for (const int v : valve.leaflets.triangles.col(t)) is_posterior[static_cast<size_t>(v)] = true;
  std::erase_if(valve.chords.chords, [&](const Chord& chord) {
    return chord.to.kind == ChordEnd::Kind::Leaflet && is_posterior[static_cast<size_t>(chord.to.index)];
  });
  EXPECT_TRUE(says(chord_doubts(valve), "region \"posterior\": no chord inserts there"));
}

TEST(ValveCheck, NamesChordsStretchedOpenAndClosed) {
  Valve valve = without_copies();
  for (Chord& chord : valve.chords.chords) chord.rest_length *= 0.75;
  EXPECT_TRUE(says(chord_doubts(valve), "insertions lie farther from the papillary tip"));
  // Where the tips come near as the valve closes, they are not.
  valve.chords.papillary_closed = valve.chords.papillary;
  Vec3 middle = Vec3::Zero();
  for (const int v : valve.free_edge) middle += valve.leaflets.vertices.col(v);
  middle /= static_cast<double>(valve.free_edge.size());
  valve.chords.papillary_closed.colwise() -= 0.5 * (valve.chords.papillary.rowwise().mean() - middle);
  EXPECT_FALSE(says(chord_doubts(valve), "farther"));
}

TEST(ValveCheck, NamesUnitsThatWereMisread) {
  const Valve valve = without_copies();
  Valve small = valve, large = valve;
  small.leaflets.vertices *= 1e-3;
  large.leaflets.vertices *= 1e3;
  EXPECT_TRUE(says(size_doubts(small), "mm across"));
  EXPECT_TRUE(says(size_doubts(large), "mm across"));
  Valve pressed = valve;
  pressed.pressure *= 1000;
  EXPECT_TRUE(says(size_doubts(pressed), "the pressure is 1.2e+05 mmHg"));
  Valve thick = valve;
  thick.thickness = 650;
  EXPECT_TRUE(says(size_doubts(thick), "650 mm thick"));
  Valve stout = valve;  // 3 mm across, and as thick as a human valve may be
  stout.leaflets.vertices *= 0.1;
  stout.thickness = 1.5;
  EXPECT_TRUE(says(size_doubts(stout), "1.5 mm thick and only"));
  stout.thickness = 0.1;
  EXPECT_TRUE(size_doubts(stout).empty());
  Valve wide = valve;
  for (Chord& chord : wide.chords.chords) chord.area *= 1e6;
  EXPECT_TRUE(says(size_doubts(wide), "cross-section"));
}

TEST(ValveCheck, NamesNeighboursThatAreFoldedOntoEachOther) {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 4);
  mesh.vertices << 0, 1, 0, 0.3, 0, 0, 1, 0.8, 0, 0, 0, 1e-3;
  mesh.triangles.resize(3, 2);
  mesh.triangles << 0, 1, 1, 0, 2, 3;
  EXPECT_TRUE(says(fold_doubts(mesh), "folded onto each other: (0, 1)"));
  mesh.triangles.col(1) << 0, 1, 3;  // turned over
  EXPECT_TRUE(says(fold_doubts(mesh), "folded onto each other: (0, 1)"));
  mesh.vertices(2, 3) = 0.4;  // 0.8 wide: 153 degrees
  EXPECT_TRUE(says(fold_doubts(mesh), "folded onto each other: (0, 1)"));
  mesh.vertices(2, 3) = 0.5;  // 148
  EXPECT_TRUE(fold_doubts(mesh).empty());
  mesh.vertices.col(3) << 0.3, -0.8, 0;
  EXPECT_TRUE(fold_doubts(mesh).empty());
}

TEST(ValveCheck, NamesNormalsThatPointAwayFromTheTips) {
  Valve valve = without_copies();
  valve.leaflets.triangles.row(0).swap(valve.leaflets.triangles.row(1));
  EXPECT_TRUE(says(pressure_side_doubts(valve), "wrong side"));
}

}  // namespace
}  // namespace coapt
