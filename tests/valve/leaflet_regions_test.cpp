#include "valve/leaflet_regions.hpp"

#include "core/error.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace coapt {
namespace {

constexpr double kOuter = 10, kInner = 4;

// A flat ring, its outer rim the annulus: `around` cells around, `down` from the rim to the free edge. Vertex
// around * j + i stands in row j and column i.
TriangleMesh ring(int around, int down) {
  const TriangleMesh flat = grid_mesh(around, down);
  const auto rolled = [=](int node) { return node % (around + 1) % around + node / (around + 1) * around; };
  TriangleMesh mesh;
  mesh.triangles = flat.triangles.unaryExpr(rolled);
  mesh.vertices.resize(3, around * (down + 1));
  for (int v = 0; v < flat.vertex_count(); ++v) {
    const double angle = 2 * std::numbers::pi * flat.vertices(0, v),
                 radius = kOuter + (kInner - kOuter) * flat.vertices(1, v);
    mesh.vertices.col(rolled(v)) << radius * std::cos(angle), radius * std::sin(angle), 0;
  }
  return mesh;
}

std::vector<int> first(int count) {
  std::vector<int> nodes(static_cast<size_t>(count));
  std::iota(nodes.begin(), nodes.end(), 0);
  return nodes;
}

double angle_of(const TriangleMesh& mesh, int t) {
  const Vec3 centre = mesh.vertices(Eigen::all, mesh.triangles.col(t)).rowwise().mean();
  const double angle = std::atan2(centre.y(), centre.x());
  return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

// Two leaflets, the first a quarter of the ring.
TriangleMesh two_leaflets(int around, int down) {
  TriangleMesh mesh = ring(around, down);
  mesh.region_names = {"small", "large"};
  for (int t = 0; t < mesh.triangle_count(); ++t)
    mesh.regions.push_back(angle_of(mesh, t) > std::numbers::pi / 2);
  return mesh;
}

std::map<std::string, double> areas(const TriangleMesh& mesh, const LeafletRegions& regions) {
  std::map<std::string, double> sums;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    sums[regions.names.at(static_cast<size_t>(regions.of_triangle[static_cast<size_t>(t)]))] +=
        area_vector(mesh.vertices, mesh.triangles.col(t)).norm();
  return sums;
}

TEST(LeafletRegions, AreSectorsOfEqualAreaInZonesOfEqualDepth) {
  constexpr int kAround = 120, kDown = 24;
  const TriangleMesh mesh = ring(kAround, kDown);
  const LeafletRegions regions = leaflet_regions(mesh, first(kAround), 8, 2);
  ASSERT_EQ(regions.of_triangle.size(), static_cast<size_t>(mesh.triangle_count()));
  ASSERT_EQ(regions.names.size(), 8u);
  EXPECT_EQ(regions.names.front(), "leaflet/annulus/1");
  EXPECT_EQ(regions.names.back(), "leaflet/edge/4");
  // The zones meet halfway between the rims.
  const double middle = 0.5 * (kOuter + kInner), pi = std::numbers::pi;
  for (const auto& [name, area] : areas(mesh, regions)) {
    const bool is_outer = name.find("annulus") != std::string::npos;
    const double zone = is_outer ? kOuter * kOuter - middle * middle : middle * middle - kInner * kInner;
    EXPECT_NEAR(area / (pi * zone / 4), 1, 0.05) << name;
  }
  // A sector is a run of angles: its triangles lie within a quarter of the circle and a cell.
  for (int r = 0; r < 8; ++r) {
    std::vector<double> angles;
    for (int t = 0; t < mesh.triangle_count(); ++t)
      if (regions.of_triangle[static_cast<size_t>(t)] == r) angles.push_back(angle_of(mesh, t));
    std::sort(angles.begin(), angles.end());
    double gap = angles.front() + 2 * pi - angles.back();
    for (size_t k = 1; k < angles.size(); ++k) gap = std::max(gap, angles[k] - angles[k - 1]);
    EXPECT_NEAR(gap, 1.5 * pi, 0.15) << regions.names[static_cast<size_t>(r)];
  }
}

TEST(LeafletRegions, AreSharedOutByLeafletArea) {
  constexpr int kAround = 80;
  const TriangleMesh mesh = two_leaflets(kAround, 12);
  const LeafletRegions regions = leaflet_regions(mesh, first(kAround), 24, 3);
  ASSERT_EQ(regions.names.size(), 24u);
  std::map<std::string, int> of_leaflet;
  for (const std::string& name : regions.names) ++of_leaflet[name.substr(0, name.find('/'))];
  EXPECT_EQ(of_leaflet["small"], 3 * 2);
  EXPECT_EQ(of_leaflet["large"], 3 * 6);
  EXPECT_EQ(std::count(regions.names.begin(), regions.names.end(), "large/belly/6"), 1);
  // No region reaches into the other leaflet, and none is empty.
  std::vector<int> count(regions.names.size(), 0);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto r = static_cast<size_t>(regions.of_triangle[static_cast<size_t>(t)]);
    ++count[r];
    EXPECT_EQ(regions.names[r].substr(0, regions.names[r].find('/')),
              mesh.region_names[static_cast<size_t>(mesh.regions[static_cast<size_t>(t)])]);
  }
  EXPECT_GT(*std::min_element(count.begin(), count.end()), 0);
  // A leaflet however small has a sector.
  TriangleMesh sliver = mesh;
  for (int t = 0; t < mesh.triangle_count(); ++t)
    sliver.regions[static_cast<size_t>(t)] = angle_of(mesh, t) > 0.1;
  const LeafletRegions uneven = leaflet_regions(sliver, first(kAround), 4, 1);
  EXPECT_EQ(uneven.names, (std::vector<std::string>{"small/annulus/1", "large/annulus/1", "large/annulus/2",
                                                    "large/annulus/3"}));
}

// A closed cap has no free edge: its zones go by the distance from the annulus to the farthest vertex. What
// does not hang on the annulus counts as edge.
TEST(LeafletRegions, DoWithoutAFreeEdgeAndWithLoosePieces) {
  const TriangleMesh cap = disc_mesh(12);
  std::vector<int> rim;
  for (int v = cap.vertex_count() - 6 * 12; v < cap.vertex_count(); ++v) rim.push_back(v);
  const LeafletRegions regions = leaflet_regions(cap, rim, 2, 2);
  for (int t = 0; t < cap.triangle_count(); ++t) {
    const double radius = cap.vertices(Eigen::all, cap.triangles.col(t)).rowwise().mean().norm();
    if (radius > 0.6) {
      EXPECT_EQ(regions.of_triangle[static_cast<size_t>(t)], 0) << radius;
    }
    if (radius < 0.4) {
      EXPECT_EQ(regions.of_triangle[static_cast<size_t>(t)], 1) << radius;
    }
  }
  const TriangleMesh both = joined(cap, moved(disc_mesh(2), Vec3(5, 0, 0)));
  const LeafletRegions loose = leaflet_regions(both, rim, 2, 2);
  for (int t = cap.triangle_count(); t < both.triangle_count(); ++t)
    EXPECT_EQ(loose.names[static_cast<size_t>(loose.of_triangle[static_cast<size_t>(t)])], "leaflet/edge/1");
}

// More sectors than there are triangles in a zone: those that would be empty are left out.
TEST(LeafletRegions, AreNeverEmpty) {
  const TriangleMesh mesh = ring(6, 2);
  const LeafletRegions regions = leaflet_regions(mesh, first(6), 100, 2);
  EXPECT_LE(regions.names.size(), static_cast<size_t>(mesh.triangle_count()));
  const auto sums = areas(mesh, regions);
  EXPECT_EQ(sums.size(), regions.names.size());
}

TEST(LeafletRegions, SayWhichNumbersAreOutOfTheQuestion) {
  const TriangleMesh mesh = two_leaflets(40, 4);
  const auto refuses = [&](int wanted, int zones, const std::string& part) {
    try {
      leaflet_regions(mesh, first(40), wanted, zones);
    } catch (const InputError& error) {
      return std::string(error.what()).find(part) != std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refuses(7, 2, "7 regions cannot be made of 2 leaflets with 2 zones each"));
  EXPECT_TRUE(refuses(2, 2, "at least 4"));
  EXPECT_TRUE(refuses(4, 0, "one zone at least, not 0"));
  EXPECT_FALSE(refuses(4, 2, ""));
}

TEST(LeafletRegions, NeedAnAnnulusOfVerticesThatLeavesSome) {
  const TriangleMesh mesh = two_leaflets(40, 4);
  const auto refusal = [&](const std::vector<int>& annulus) -> std::string {
    try {
      leaflet_regions(mesh, annulus, 4, 2);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  std::vector<int> beyond = first(40), before = beyond;
  beyond.push_back(mesh.vertex_count());
  before.push_back(-1);
  EXPECT_NE(refusal(beyond).find("node " + std::to_string(mesh.vertex_count())), std::string::npos);
  EXPECT_NE(refusal(before).find("node -1"), std::string::npos);
  EXPECT_NE(refusal(first(mesh.vertex_count())).find("every vertex"), std::string::npos);
  EXPECT_EQ(refusal(first(mesh.vertex_count() - 1)), "");
}

}  // namespace
}  // namespace coapt
