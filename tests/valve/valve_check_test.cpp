// Valves that are wrong in one thing, and right ones that look as if they were.
#include "valve/valve_check.hpp"

#include "support/trough_valve.hpp"
#include "valve/generators/mitral.hpp"
#include "valve/generators/rough_valve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

bool names(const std::vector<std::string>& doubts, const std::string& part) {
  return std::any_of(doubts.begin(), doubts.end(),
                     [&](const std::string& doubt) { return doubt.find(part) != std::string::npos; });
}

void turn_over(TriangleMesh& mesh, int from, int to) {
  for (int t = from; t < to; ++t) std::swap(mesh.triangles(0, t), mesh.triangles(1, t));
}

// A tube that hangs from the annulus and is as wide at its free edge, or `widening` wider: seen along its
// axis its area vectors all but cancel. Normals on the outside.
Valve tube(double widening) {
  constexpr int kAround = 24, kDown = 4;
  Valve valve;
  TriangleMesh& mesh = valve.leaflets;
  mesh.vertices.resize(3, kAround * (kDown + 1));
  for (int j = 0; j <= kDown; ++j)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * i / kAround, radius = 10 + widening * j / kDown;
      mesh.vertices.col(j * kAround + i) << radius * std::cos(angle), radius * std::sin(angle), -3.0 * j;
    }
  mesh.triangles.resize(3, 2 * kAround * kDown);
  for (int j = 0, t = 0; j < kDown; ++j)
    for (int i = 0; i < kAround; ++i) {
      const int a = j * kAround + i, b = j * kAround + (i + 1) % kAround, c = a + kAround, d = b + kAround;
      mesh.triangles.col(t++) << a, c, b;
      mesh.triangles.col(t++) << b, c, d;
    }
  for (int i = 0; i < kAround; ++i) valve.annulus.push_back(i);
  valve.chords.papillary.resize(3, 2);
  valve.chords.papillary << -3, 4, 1, -2, -30, -28;
  return valve;
}

// Three leaflets of a semilunar valve, each with its own vertices, on a crown-shaped annulus: 24 x 8 cells a
// leaflet. Normals to the outside, the aorta.
Valve semilunar() {
  Valve valve;
  for (int leaflet = 0; leaflet < 3; ++leaflet) {
    const TriangleMesh one = grid_sheet(24, 8, [&](double u, double v) {
      const double angle = 2 * std::numbers::pi * (leaflet + 0.005 + 0.99 * u) / 3, side = 2 * u - 1;
      const double bottom = 9 * side * side, top = 10, radius = 11 - 3 * v * (1 - side * side);
      return Vec3(radius * std::cos(angle), radius * std::sin(angle), bottom + v * (top - bottom));
    });
    const int first = valve.leaflets.vertex_count();
    append(valve.leaflets, one);
    for (int j = 0; j <= 8; ++j)
      for (int i = 0; i <= 24; ++i)
        if (j == 0 || i == 0 || i == 24) valve.annulus.push_back(first + j * 25 + i);
  }
  return valve;
}

TEST(PressureSide, IsToldWhereTheFreeEdgeIsAsWideAsTheAnnulus) {
  for (const double widening : {-9.0, -0.3, 0.0, 0.3, 4.0}) {
    Valve valve = tube(widening);
    EXPECT_TRUE(pressure_side_doubts(valve).empty()) << widening;
    turn_over(valve.leaflets, 0, valve.leaflets.triangle_count());
    EXPECT_TRUE(names(pressure_side_doubts(valve), "wrong side; turn all triangles over")) << widening;
  }
}

TEST(PressureSide, IsToldOfAPressureOnTheBack) {
  Valve valve = tube(0);
  EXPECT_TRUE(
      names(pressure_side_doubts(valve, {}, true), "on the wrong side and opens the valve; set the side"));
  turn_over(valve.leaflets, 0, valve.leaflets.triangle_count());
  EXPECT_TRUE(pressure_side_doubts(valve, {}, true).empty());
  valve = semilunar();
  turn_over(valve.leaflets, 0, valve.leaflets.triangle_count() / 3);
  EXPECT_TRUE(names(pressure_side_doubts(valve, {}, true), "2 of 3 leaflets"));
}

TEST(PressureSide, IsThatOfTheTipsWhereverTheLeafletsHang) {
  Valve valve = tube(0);
  valve.chords.papillary.row(2) *= -1;
  EXPECT_TRUE(names(pressure_side_doubts(valve), "wrong side"));
}

TEST(PressureSide, IsToldOfEachLeafletByItself) {
  Valve valve = semilunar();
  const int one = valve.leaflets.triangle_count() / 3;
  EXPECT_TRUE(pressure_side_doubts(valve).empty());
  turn_over(valve.leaflets, one, 2 * one);
  const std::vector<std::string> doubts = pressure_side_doubts(valve);
  EXPECT_TRUE(names(doubts, "1 of 3 leaflets (triangles: " + std::to_string(one) + " with triangle " +
                                std::to_string(one) + ")"));
  turn_over(valve.leaflets, 0, one);
  turn_over(valve.leaflets, 2 * one, 3 * one);
  EXPECT_TRUE(names(pressure_side_doubts(valve), "wrong side; turn all"));
}

// Leaflets that lie in the plane of their annulus hang to neither side.
TEST(PressureSide, IsLeftOpenWhereNothingTellsIt) {
  Valve valve = tube(-6);
  valve.chords.papillary.resize(3, 0);
  valve.leaflets.vertices.row(2) *= 1e-3;
  turn_over(valve.leaflets, 0, valve.leaflets.triangle_count());
  EXPECT_TRUE(pressure_side_doubts(valve).empty());
  valve.annulus.clear();
  EXPECT_TRUE(pressure_side_doubts(valve).empty());
}

Valve without_regions() {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  valve.leaflets.region_names.clear();
  valve.leaflets.regions.clear();
  return valve;
}

TEST(BareLeaflets, AreNamedWithoutAnyChord) {
  Valve valve = without_regions();
  valve.chords.chords.clear();
  EXPECT_TRUE(names(chord_doubts(valve), "has 8 papillary tips and no chords"));
  EXPECT_TRUE(names(chord_doubts(valve), "coapt chords"));
  valve.chords.papillary.resize(3, 0);  // a semilunar valve has none
  EXPECT_TRUE(chord_doubts(valve).empty());
}

TEST(BareLeaflets, AreNamedByTheRunOfTheFreeEdge) {
  Valve valve = without_regions();
  EXPECT_FALSE(names(chord_doubts(valve), "no chord inserts"));
  Valve mixed = valve;  // whose sides change along the rim
  turn_over(mixed.leaflets, 0, mixed.leaflets.triangle_count() / 3);
  EXPECT_FALSE(names(chord_doubts(mixed), "no chord inserts"));
  std::erase_if(valve.chords.chords, [&](const Chord& chord) {
    return chord.to.kind == ChordEnd::Kind::Leaflet && valve.leaflets.vertices(1, chord.to.index) < 0;
  });
  EXPECT_TRUE(names(chord_doubts(valve), "the free edge from vertex "));
}

TEST(BareLeaflets, AreNamedByPieces) {
  Valve valve = semilunar();
  valve.chords.papillary = Vec3(0, 0, 30);
  const int leaflet = valve.leaflets.vertex_count() / 3;
  const int free = 8 * 25;  // first vertex of the free edge of a leaflet
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i <= 24; i += 4)
      valve.chords.chords.push_back(
          {{ChordEnd::Kind::Papillary, 0}, {ChordEnd::Kind::Leaflet, k * leaflet + free + i}, 25, 1, "", 0});
  const std::vector<std::string> doubts = chord_doubts(valve);
  EXPECT_TRUE(names(doubts, "the leaflet of triangle 768 (384 triangles): no chord inserts there"));
  EXPECT_FALSE(names(doubts, "of triangle 0"));
  EXPECT_FALSE(names(doubts, "free edge from"));
}

TEST(ChordLengths, AreAllSlackInAnotherUnit) {
  for (const double unit : {10.0, 25.4, 1000.0}) {
    Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
    for (Chord& chord : valve.chords.chords) chord.rest_length *= unit;
    EXPECT_TRUE(names(chord_doubts(valve), "all chords are slack")) << unit;
  }
  Valve loose = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  for (Chord& chord : loose.chords.chords) chord.rest_length *= 1.5;
  EXPECT_FALSE(names(chord_doubts(loose), "slack"));
}

TEST(ChordLengths, AreJudgedByTheClosedPositionAlone) {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  const Vec3 middle = valve.leaflets.vertices.rowwise().mean();
  const Vec3 away = (valve.chords.papillary.rowwise().mean() - middle).normalized();
  EXPECT_FALSE(names(chord_doubts(valve), "farther"));
  valve.chords.papillary_closed = valve.chords.papillary.colwise() + 12 * away;
  EXPECT_TRUE(names(chord_doubts(valve), "to it are long, in the closed position; worst"));
}

TEST(ChordLengths, AreJudgedByWhatTheLawBears) {
  Valve valve = mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark});
  valve.chords.papillary_closed.resize(3, 0);                          // tips that stay
  for (Chord& chord : valve.chords.chords) chord.rest_length *= 0.87;  // 15 %
  EXPECT_FALSE(names(chord_doubts(valve), "farther"));
  ChordLimits limits;
  for (const Chord& chord : valve.chords.chords) limits.by_material[chord.material] = 0.07;
  EXPECT_TRUE(names(chord_doubts(valve, limits), "more than 1000 MPa (from 7 % on)"));
  // One soft part of each way takes the strain of the others.
  limits.by_material[valve.chords.chords.front().material] = 1;
  EXPECT_FALSE(names(chord_doubts(valve, limits), "farther"));
}

TEST(ValveCheck, HasNoDoubtsAboutRoughValves) {
  for (const RoughKind kind : {RoughKind::Mitral, RoughKind::Tricuspid})
    for (unsigned seed = 1; seed <= 20; ++seed) {
      const Valve valve = rough_valve({.kind = kind, .seed = seed, .triangles = 300});
      EXPECT_TRUE(pressure_side_doubts(valve).empty()) << seed;
      EXPECT_TRUE(fold_doubts(valve.leaflets).empty()) << seed;
      const std::vector<std::string> doubts = chord_doubts(valve);
      for (const char* part : {"no chord inserts", "slack", "farther"})
        EXPECT_FALSE(names(doubts, part)) << seed << part;
    }
}

}  // namespace
}  // namespace coapt
