#include "valve/separate_leaflets.hpp"

#include "core/error.hpp"
#include "mesh/distance/intersections.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

Valve open_valve() { return mitral_valve(MitralOptions{.triangles = 600}); }

// A stretch of the free edge, moved through the leaflet on the other side of the orifice.
Valve deeply_folded_valve() {
  Valve valve = open_valve();
  Points& x = valve.leaflets.vertices;
  const Vec3 middle =
      0.5 * (x(Eigen::all, valve.free_edge).rowwise().mean() + x(Eigen::all, valve.annulus).rowwise().mean());
  const Vec3 way = 4 * (middle - x.col(valve.free_edge.front()));
  for (size_t k = 0; k < 12; ++k) x.col(valve.free_edge[k]) += way;
  return valve;
}

// A vertex of the free edge, moved a little beyond a later one.
Valve slightly_folded_valve() {
  const Valve open = open_valve();
  for (size_t k = 0; k < open.free_edge.size(); ++k) {
    Valve valve = open;
    Points& x = valve.leaflets.vertices;
    const int a = open.free_edge[k], b = open.free_edge[(k + 3) % open.free_edge.size()];
    x.col(a) = x.col(b) + 0.05 * (x.col(b) - x.col(a)) + Vec3(0, 0, 0.02);
    if (!intersections(x, valve.leaflets.triangles).empty()) return valve;
  }
  return open;
}

TEST(SeparateLeaflets, LeavesLeafletsThatDoNotMeetAsTheyAre) {
  Valve valve = open_valve();
  const Points before = valve.leaflets.vertices;
  EXPECT_EQ(separate_leaflets(valve).pairs, 0);
  EXPECT_EQ((valve.leaflets.vertices - before).norm(), 0);
}

TEST(SeparateLeaflets, PushesAFoldApartAndHoldsTheAnnulus) {
  Valve valve = slightly_folded_valve();
  const Points before = valve.leaflets.vertices;
  ASSERT_GT(intersections(before, valve.leaflets.triangles).size(), 0u);
  const LeafletSeparation done = separate_leaflets(valve);
  EXPECT_GT(done.pairs, 0);
  EXPECT_GT(done.largest_move, 0);
  EXPECT_TRUE(intersections(valve.leaflets.vertices, valve.leaflets.triangles).empty());
  for (const int vertex : valve.annulus)
    EXPECT_EQ((valve.leaflets.vertices.col(vertex) - before.col(vertex)).norm(), 0);
}

TEST(SeparateLeaflets, SaysWhereADeepFoldIsAndWhatCanBeDone) {
  Valve valve = deeply_folded_valve();
  const Points before = valve.leaflets.vertices;
  ASSERT_GT(intersections(before, valve.leaflets.triangles).size(), 0u);
  try {
    separate_leaflets(valve);
    FAIL() << "was pushed apart";
  } catch (const InputError& error) {
    const std::string text = error.what();
    for (const char* piece : {"pass through themselves", "the first at (", "give a mask"})
      EXPECT_NE(text.find(piece), std::string::npos) << text;
  }
  EXPECT_EQ((valve.leaflets.vertices - before).norm(), 0);
}

}  // namespace
}  // namespace coapt
