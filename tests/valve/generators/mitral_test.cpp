#include "valve/generators/mitral.hpp"

#include "core/error.hpp"
#include "support/smallest_angle.hpp"
#include "valve/generators/mitral_mesh.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <queue>
#include <set>

namespace coapt {
namespace {

constexpr int kSizes[] = {625, 2500, 10000, 40000, 160000};
constexpr int kChordsPerMuscle = 12;

Vec3 position(const Valve& valve, const ChordEnd& end) {
  if (end.kind == ChordEnd::Kind::Papillary) return valve.chords.papillary.col(end.index);
  if (end.kind == ChordEnd::Kind::Junction) return valve.chords.junctions.col(end.index);
  return valve.leaflets.vertices.col(end.index);
}

double loop_area(const Points& loop) {  // of the polygon, seen along its own normal
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < loop.cols(); ++i)
    sum += 0.5 * Vec3(loop.col(i)).cross(Vec3(loop.col((i + 1) % loop.cols())));
  return sum.norm();
}

Points points_of(const Valve& valve, const std::vector<int>& ids) {
  return valve.leaflets.vertices(Eigen::all, ids);
}

// Does the segment from p to q cross the triangle's inside? (Moeller & Trumbore 1997)
bool pierces(const Vec3& p, const Vec3& q, const Points& x, const Eigen::Vector3i& t) {
  const Vec3 a = x.col(t[0]), ab = Vec3(x.col(t[1])) - a, ac = Vec3(x.col(t[2])) - a, d = q - p;
  const Vec3 h = d.cross(ac), s = p - a, g = s.cross(ab);
  const double determinant = ab.dot(h);
  if (std::abs(determinant) < 1e-14) return false;
  const double u = s.dot(h) / determinant, v = d.dot(g) / determinant, w = ac.dot(g) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && w > 0 && w < 1;
}

bool has_corner(const Eigen::Vector3i& t, int v) { return t[0] == v || t[1] == v || t[2] == v; }

bool intersects_itself(const TriangleMesh& mesh) {
  for (const Edge& edge : edges(mesh.triangles))
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      const Eigen::Vector3i triangle = mesh.triangles.col(t);
      if (has_corner(triangle, edge.a) || has_corner(triangle, edge.b)) continue;
      if (pierces(mesh.vertices.col(edge.a), mesh.vertices.col(edge.b), mesh.vertices, triangle)) return true;
    }
  return false;
}

int chords_through_the_leaflets(const Valve& valve) {
  int count = 0;
  for (const Chord& chord : valve.chords.chords)
    for (int t = 0; t < valve.leaflets.triangle_count(); ++t) {
      const Eigen::Vector3i triangle = valve.leaflets.triangles.col(t);
      if (chord.to.kind == ChordEnd::Kind::Leaflet && has_corner(triangle, chord.to.index)) continue;
      if (pierces(position(valve, chord.from), position(valve, chord.to), valve.leaflets.vertices, triangle))
        ++count;
    }
  return count;
}

void expect_sound_leaflets(const Valve& valve) {
  const TriangleMesh& mesh = valve.leaflets;
  std::set<std::pair<int, int>> directed;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k)
      ASSERT_TRUE(directed.emplace(mesh.triangles(k, t), mesh.triangles((k + 1) % 3, t)).second)
          << "edge used twice in one direction at triangle " << t;
  auto loops = boundary_loops(mesh.triangles);
  ASSERT_EQ(loops.size(), 2u);
  EXPECT_TRUE((loops[0] == valve.annulus && loops[1] == valve.free_edge) ||
              (loops[1] == valve.annulus && loops[0] == valve.free_edge));
  const int edge_count = static_cast<int>(edges(mesh.triangles).size());
  EXPECT_EQ(mesh.vertex_count() - edge_count + mesh.triangle_count(), 0);  // an annulus, in one piece
  EXPECT_GT(smallest_angle(mesh), 25);
}

void expect_sound_chords(const Valve& valve) {
  const ChordNetwork& network = valve.chords;
  std::vector<int> trunks(static_cast<size_t>(network.junctions.cols()), 0);
  std::vector<double> branch_area(trunks.size(), 0), trunk_area(trunks.size(), 0);
  for (const Chord& chord : network.chords) {
    const Chord& c = chord;
    EXPECT_EQ(c.level, c.from.kind == ChordEnd::Kind::Papillary ? 1 : 2);
    EXPECT_LE((position(valve, c.to) - position(valve, c.from)).norm(), c.rest_length * (1 + 1e-9));
    EXPECT_GT(c.rest_length, 0);
    EXPECT_GT(c.area, 0);
    if (c.level == 1) {
      ASSERT_LT(c.from.index, network.papillary.cols());
      ASSERT_EQ(c.to.kind, ChordEnd::Kind::Junction);
      ASSERT_LT(c.to.index, network.junctions.cols());
      ++trunks[c.to.index];
      trunk_area[c.to.index] = c.area;
      // Tips and junctions of the anterolateral muscle come first.
      EXPECT_EQ(c.from.index < 4, c.to.index < kChordsPerMuscle);
    } else {
      ASSERT_EQ(c.to.kind, ChordEnd::Kind::Leaflet);
      ASSERT_LT(c.to.index, valve.leaflets.vertex_count());
      branch_area[c.from.index] += c.area;
      // No chord crosses to the other muscle's side.
      const double side = c.from.index < kChordsPerMuscle ? 1 : -1;
      EXPECT_GT(side * valve.leaflets.vertices(0, c.to.index), -1e-9);
    }
  }
  for (size_t i = 0; i < trunks.size(); ++i) {
    EXPECT_EQ(trunks[i], 1) << "junction " << i << " hangs on no anchor or on several";
    EXPECT_NEAR(branch_area[i], trunk_area[i], 1e-12);
  }
}

TEST(MitralValve, MeetsEachCountWithinATwentiethAndIsSound) {
  for (const int wanted : kSizes) {
    SCOPED_TRACE(wanted);
    const Valve valve = mitral_valve({.triangles = wanted, .preset = MitralPreset::Benchmark});
    EXPECT_NEAR(valve.leaflets.triangle_count(), wanted, 0.05 * wanted);
    expect_sound_leaflets(valve);
    expect_sound_chords(valve);
  }
}

TEST(MitralValve, HasTheDimensionsOfTheMeanValve) {
  const Valve valve = mitral_valve({.triangles = 10000, .preset = MitralPreset::Benchmark});
  const Points ring = points_of(valve, valve.annulus);
  EXPECT_NEAR(ring.row(0).maxCoeff() - ring.row(0).minCoeff(), 36, 0.05);
  EXPECT_NEAR(ring.row(1).maxCoeff() - ring.row(1).minCoeff(), 0.81 * 36, 0.3);
  EXPECT_NEAR(ring.row(2).maxCoeff() - ring.row(2).minCoeff(), 0.13 * 36, 0.05);
  const double annulus = loop_area(ring);
  const double closed = loop_area(valve.annulus_closed);
  EXPECT_NEAR(closed / annulus, 0.92, 0.01);
  EXPECT_GT(valve.annulus_closed.row(2).maxCoeff() - valve.annulus_closed.row(2).minCoeff(), 0.16 * 36);
  const double ratio = surface_area(valve.leaflets.vertices, valve.leaflets.triangles) / annulus;
  EXPECT_GT(ratio, 1.4);
  EXPECT_LT(ratio, 1.8);
  EXPECT_NEAR(valve.pressure, 120 * 133.322368e-6, 1e-8);
  EXPECT_EQ(valve.annulus_closed.cols(), static_cast<int>(valve.annulus.size()));
  EXPECT_EQ(valve.chords.papillary_closed.cols(), valve.chords.papillary.cols());
}

TEST(MitralValve, FacesTheVentricleWithItsOutside) {
  const Valve valve = mitral_valve({.triangles = 2500, .preset = MitralPreset::Benchmark});
  for (int t = 0; t < valve.leaflets.triangle_count(); ++t) {
    const Vec3 normal = area_vector(valve.leaflets.vertices, valve.leaflets.triangles.col(t));
    const Vec3 at = valve.leaflets.vertices.col(valve.leaflets.triangles(0, t));
    EXPECT_LT(normal.normalized().z(), 0.1) << t;  // upright at most, near the commissures
    EXPECT_GT(normal.x() * at.x() + normal.y() * at.y(), 0) << t;
  }
}

TEST(MitralValve, HasTwoConnectedLeafletsThatMeetAtTheCommissures) {
  const Valve valve = mitral_valve({.triangles = 2500, .preset = MitralPreset::Benchmark});
  ASSERT_EQ(valve.leaflets.region_names, (std::vector<std::string>{"anterior", "posterior"}));
  ASSERT_EQ(valve.leaflets.regions.size(), static_cast<size_t>(valve.leaflets.triangle_count()));
  for (const int commissure : valve.commissures) {
    EXPECT_NE(std::find(valve.annulus.begin(), valve.annulus.end(), commissure), valve.annulus.end());
    std::set<int> regions;
    for (int t = 0; t < valve.leaflets.triangle_count(); ++t)
      if (has_corner(valve.leaflets.triangles.col(t), commissure)) regions.insert(valve.leaflets.regions[t]);
    EXPECT_EQ(regions.size(), 2u);
  }
  int region_changes = 0;  // along the annulus: one at each commissure
  std::vector<int> along;
  for (size_t i = 0; i < valve.annulus.size(); ++i) {
    const int a = valve.annulus[i], b = valve.annulus[(i + 1) % valve.annulus.size()];
    for (int t = 0; t < valve.leaflets.triangle_count(); ++t)
      if (has_corner(valve.leaflets.triangles.col(t), a) && has_corner(valve.leaflets.triangles.col(t), b))
        along.push_back(valve.leaflets.regions[t]);
  }
  for (size_t i = 0; i < along.size(); ++i) region_changes += along[i] != along[(i + 1) % along.size()];
  EXPECT_EQ(region_changes, 2);
}

TEST(MitralValve, HasTheSameChordsAtEveryMeshSize) {
  const Valve fine = mitral_valve({.triangles = kSizes[4], .preset = MitralPreset::Benchmark});
  for (const int wanted : kSizes) {
    SCOPED_TRACE(wanted);
    const Valve valve = mitral_valve({.triangles = wanted, .preset = MitralPreset::Benchmark});
    EXPECT_EQ(valve.chords.papillary, fine.chords.papillary);
    ASSERT_EQ(valve.chords.chords.size(), fine.chords.chords.size());
    const double cell = mean_edge_length(valve.leaflets.vertices, valve.leaflets.triangles);
    for (size_t i = 0; i < fine.chords.chords.size(); ++i) {
      const Chord &a = valve.chords.chords[i], &b = fine.chords.chords[i];
      EXPECT_EQ(a.material, b.material);
      EXPECT_EQ(a.area, b.area);
      EXPECT_EQ(a.from.index, b.from.index);
      EXPECT_EQ(a.to.kind, b.to.kind);
      if (a.to.kind == ChordEnd::Kind::Leaflet) {
        EXPECT_LT((position(valve, a.to) - position(fine, b.to)).norm(), 1.5 * cell) << i;
      }
      EXPECT_NEAR(a.rest_length, b.rest_length, 1.5 * cell) << i;
    }
  }
}

TEST(MitralValve, IsValidAndDifferentForEachOfTwentySeeds) {
  std::set<double> areas;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Valve valve = mitral_valve({.triangles = 625, .seed = seed, .preset = MitralPreset::Benchmark});
    EXPECT_NEAR(valve.leaflets.triangle_count(), 625, 0.05 * 625);
    expect_sound_leaflets(valve);
    expect_sound_chords(valve);
    EXPECT_FALSE(intersects_itself(valve.leaflets));
    EXPECT_EQ(chords_through_the_leaflets(valve), 0);
    const double area = surface_area(valve.leaflets.vertices, valve.leaflets.triangles);
    const double ratio = area / loop_area(points_of(valve, valve.annulus));
    EXPECT_GT(ratio, 1.4);
    EXPECT_LT(ratio, 1.9);
    areas.insert(area);
    const MitralShape shape = mitral_shape(mitral_dimensions(seed, MitralPreset::Benchmark));
    for (int i = 0; i < 200; ++i) EXPECT_GT(mitral_coaptation_height(shape, i / 200.0), 2) << i;
  }
  EXPECT_EQ(areas.size(), 20u);
}

TEST(MitralValve, NeitherMeshNorChordsPassThroughTheLeafletsOfTheMeanValve) {
  for (const int wanted : {625, 2500}) {
    const Valve valve = mitral_valve({.triangles = wanted, .preset = MitralPreset::Benchmark});
    EXPECT_FALSE(intersects_itself(valve.leaflets));
    EXPECT_EQ(chords_through_the_leaflets(valve), 0);
  }
}

TEST(MitralValve, IsReproducedBitByBitFromItsSeed) {
  const Valve a = mitral_valve({.triangles = 625, .seed = 7, .preset = MitralPreset::Benchmark}),
              b = mitral_valve({.triangles = 625, .seed = 7, .preset = MitralPreset::Benchmark});
  EXPECT_EQ(a.leaflets.vertices, b.leaflets.vertices);
  EXPECT_EQ(a.chords.junctions, b.chords.junctions);
  // The generator's output is fixed by the C++ standard: this number must not depend on the platform.
  EXPECT_NEAR(mitral_dimensions(1, MitralPreset::Benchmark).commissural_diameter,
              36 + 4 * (2 * (1791095845 / 4294967296.0) - 1), 1e-12);
}

TEST(ClosedPreset, IsTheDefaultAndSoundForEachOfTwentySeeds) {
  for (unsigned seed = 0; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    const Valve valve = mitral_valve({.triangles = 625, .seed = seed});
    expect_sound_leaflets(valve);
    expect_sound_chords(valve);
    EXPECT_FALSE(intersects_itself(valve.leaflets));
    EXPECT_EQ(chords_through_the_leaflets(valve), 0);
    const double area = surface_area(valve.leaflets.vertices, valve.leaflets.triangles);
    const double ratio = area / loop_area(points_of(valve, valve.annulus));
    EXPECT_GT(ratio, 1.95 - 0.40);  // Chaput et al. 2008
    EXPECT_LT(ratio, 1.95 + 0.40);
  }
}

// Branches that do not end at the free edge and leave their vertex on the side of the atrium.
int branches_on_the_wrong_side(const Valve& valve) {
  const TriangleMesh& mesh = valve.leaflets;
  Points normals = Points::Zero(3, mesh.vertex_count());
  for (int t = 0; t < mesh.triangle_count(); ++t)
    for (const int v : Eigen::Vector3i(mesh.triangles.col(t)))
      normals.col(v) += area_vector(mesh.vertices, mesh.triangles.col(t));
  const std::set<int> edge(valve.free_edge.begin(), valve.free_edge.end());
  return static_cast<int>(
      std::count_if(valve.chords.chords.begin(), valve.chords.chords.end(), [&](const Chord& chord) {
        return chord.to.kind == ChordEnd::Kind::Leaflet && !edge.contains(chord.to.index) &&
               normals.col(chord.to.index).dot(position(valve, chord.from) - position(valve, chord.to)) <= 0;
      }));
}

TEST(ClosedPreset, LeadsNoChordThroughALeafletAtAnySize) {
  for (const int wanted : {160, 630, 2500})
    for (unsigned seed = 0; seed <= 20; ++seed) {
      SCOPED_TRACE(std::to_string(wanted) + " triangles, seed " + std::to_string(seed));
      const Valve valve = mitral_valve({.triangles = wanted, .seed = seed});
      EXPECT_EQ(chords_through_the_leaflets(valve), 0);
      EXPECT_EQ(branches_on_the_wrong_side(valve), 0);
    }
}

TEST(ClosedPreset, HasTissueAndTrunksAtEveryMeshSize) {
  const Valve fine = mitral_valve({.triangles = 10000});
  for (const int wanted : {625, 2500}) {
    const Valve valve = mitral_valve({.triangles = wanted});
    EXPECT_EQ(valve.chords.papillary, fine.chords.papillary);
    EXPECT_EQ(valve.chords.chords.size(), fine.chords.chords.size());
    for (const std::string& region : valve.leaflets.region_names) {
      ASSERT_TRUE(valve.membranes.contains(region));
      EXPECT_EQ(valve.membranes.at(region).type, "cst_tension_field");
    }
  }
  EXPECT_TRUE(mitral_valve({.triangles = 625, .preset = MitralPreset::Benchmark}).membranes.empty());
}

TEST(ClosedPreset, HoldsTheRoughZoneAtTheLineOfCoaptation) {
  const MitralDimensions dimensions = mitral_dimensions(0);
  const MitralShape shape = mitral_shape(dimensions);
  const Valve valve = mitral_valve({.triangles = 2500});
  const MitralMesh mesh = mitral_mesh(shape, 2500);
  int below = 0;  // chords that end between the line and the free edge
  for (const Chord& chord : valve.chords.chords) {
    if (chord.to.kind != ChordEnd::Kind::Leaflet) continue;
    const Eigen::Vector2d at = mesh.coordinates.col(chord.to.index);
    below += at[1] < 1 && at[1] > mitral_line_place(shape, at[0]);
  }
  EXPECT_GT(below, 2 * 9);  // a pair for each fan of the rough zone, less where two share a vertex
  EXPECT_THROW(mitral_preset("healthy"), InputError);
}

TEST(MitralValve, MeridiansKeepTheirLengthInBothShapes) {
  const MitralShape shape = mitral_shape(mitral_dimensions(0, MitralPreset::Benchmark));
  constexpr int kSteps = 2000;
  for (const double u : {0.05, 0.2, 0.5, 0.7, 0.9}) {
    double open = 0, closed = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double from = double(i) / kSteps, to = double(i + 1) / kSteps;
      open += (mitral_open_point(shape, u, to) - mitral_open_point(shape, u, from)).norm();
      closed += (mitral_closed_point(shape, u, to) - mitral_closed_point(shape, u, from)).norm();
    }
    EXPECT_NEAR(closed / open, 1, 0.01) << u;
  }
}

TEST(MitralValve, MeetsInTheClosedShape) {
  const MitralShape shape = mitral_shape(mitral_dimensions(0, MitralPreset::Benchmark));
  for (const double fraction : {0.2, 0.4, 0.5, 0.7}) {
    const double anterior = mitral_coordinate(shape, MitralLeaflet::Anterior, fraction);
    const double posterior = mitral_coordinate(shape, MitralLeaflet::Posterior, 1 - fraction);
    EXPECT_NEAR((mitral_closed_point(shape, anterior, 1) - mitral_closed_point(shape, posterior, 1)).norm(),
                0, 0.02);
    EXPECT_NEAR(mitral_coaptation_height(shape, anterior), mitral_coaptation_height(shape, posterior), 0.02);
  }
}

TEST(MitralValve, RefusesTooFewTrianglesAndBranchesOutOfRangeTogether) {
  try {
    mitral_valve({.triangles = 50, .branches = 9, .preset = MitralPreset::Benchmark});
    FAIL() << "an impossible valve was made";
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 2u);
  }
}

}  // namespace
}  // namespace coapt
