#include "mesh/remesh/coarsen.hpp"

#include "mesh/mesh_check.hpp"
#include "mesh/mesh_topology.hpp"
#include "mesh/remesh/prolong.hpp"
#include "support/meshes.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

namespace coapt {
namespace {

double worst_quality(const TriangleMesh& mesh) {
  double worst = 1;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    double sum = 0;
    for (int k = 0; k < 3; ++k)
      sum += (mesh.vertices.col(mesh.triangles(k, t)) - mesh.vertices.col(mesh.triangles((k + 1) % 3, t)))
                 .squaredNorm();
    worst =
        std::min(worst, 4 * std::sqrt(3.0) * area_vector(mesh.vertices, mesh.triangles.col(t)).norm() / sum);
  }
  return worst;
}

// A bent sheet with the two regions left and right of x = 0.5.
TriangleMesh two_regions() {
  TriangleMesh mesh = grid_mesh(24, 24);
  mesh.region_names = {"left", "right"};
  for (int t = 0; t < mesh.triangle_count(); ++t)
    mesh.regions.push_back(mesh.vertices(Eigen::all, mesh.triangles.col(t)).row(0).mean() > 0.5);
  mesh.vertices.row(2) = (3 * mesh.vertices.row(0).array()).sin() * 0.2;
  return mesh;
}

Vec3 total_area_vector(const TriangleMesh& mesh) {
  Vec3 sum = Vec3::Zero();
  for (int t = 0; t < mesh.triangle_count(); ++t) sum += area_vector(mesh.vertices, mesh.triangles.col(t));
  return sum;
}

TEST(Coarsen, ReachesAQuarterOfTheTrianglesInGoodShape) {
  for (const TriangleMesh& mesh : {grid_mesh(30, 20), disc_mesh(16), sphere_mesh(4), two_regions()}) {
    const Coarsening c = coarsen(mesh);
    EXPECT_NEAR(c.mesh.triangle_count(), 0.25 * mesh.triangle_count(), 0.02 * mesh.triangle_count());
    EXPECT_TRUE(check_mesh(c.mesh).empty()) << check_mesh(c.mesh)[0].message;
    EXPECT_GE(worst_quality(c.mesh), 0.29);
    EXPECT_EQ(connected_components(c.mesh).count, 1);
    EXPECT_EQ(boundary_loops(c.mesh.triangles).size(), boundary_loops(mesh.triangles).size());
    EXPECT_NEAR(surface_area(c.mesh.vertices, c.mesh.triangles), surface_area(mesh.vertices, mesh.triangles),
                0.03 * surface_area(mesh.vertices, mesh.triangles));
  }
}

TEST(Coarsen, KeepsAFlatSheetWithItsCornersUnfolded) {
  const TriangleMesh mesh = grid_mesh(30, 20);
  const Coarsening c = coarsen(mesh);
  for (int t = 0; t < c.mesh.triangle_count(); ++t)
    EXPECT_GT(area_vector(c.mesh.vertices, c.mesh.triangles.col(t)).z(), 0);
  EXPECT_NEAR(total_area_vector(c.mesh).z(), 1, 1e-14);  // all of the square, once
}

TEST(Coarsen, ItsVerticesAreFineOnesAndEveryOtherHasAHost) {
  const TriangleMesh mesh = two_regions();
  const Coarsening c = coarsen(mesh);
  ASSERT_TRUE(std::is_sorted(c.kept.begin(), c.kept.end()));
  EXPECT_EQ(c.mesh.vertices, Points(mesh.vertices(Eigen::all, c.kept)));
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const int number = c.number[static_cast<size_t>(v)], host = c.host[static_cast<size_t>(v)];
    EXPECT_NE(number < 0, host < 0) << v;
    if (host < 0) {
      EXPECT_EQ(c.kept[static_cast<size_t>(number)], v);
      continue;
    }
    EXPECT_NEAR(c.weights.col(v).sum(), 1, 1e-14);
    EXPECT_GE(c.weights.col(v).minCoeff(), -1e-14);
    const Vec3 on = c.mesh.vertices(Eigen::all, c.mesh.triangles.col(host)) * c.weights.col(v);
    EXPECT_LT((on - mesh.vertices.col(v)).norm(), 0.01);
  }
}

TEST(Coarsen, KeepsRegionsAndTheLineBetweenThem) {
  const TriangleMesh mesh = two_regions();
  const Coarsening c = coarsen(mesh);
  EXPECT_EQ(c.mesh.region_names, mesh.region_names);
  for (int t = 0; t < c.mesh.triangle_count(); ++t) {
    const Eigen::Vector3d x = c.mesh.vertices(Eigen::all, c.mesh.triangles.col(t)).row(0);
    const bool is_left = c.mesh.regions[static_cast<size_t>(t)] == 0;
    EXPECT_TRUE(is_left ? x.maxCoeff() <= 0.5 + 1e-12 : x.minCoeff() >= 0.5 - 1e-12) << t;
  }
}

TEST(Coarsen, KeepsTheVerticesThatItIsTold) {
  const TriangleMesh mesh = grid_mesh(24, 24);
  CoarsenOptions options;
  for (int k = 0; k < 20; ++k) options.keep.push_back(grid_node(24, 10 + k % 5, 7 + k / 5));
  const Coarsening c = coarsen(mesh, options);
  for (const int v : options.keep) EXPECT_GE(c.number[static_cast<size_t>(v)], 0) << v;
  EXPECT_TRUE(check_mesh(c.mesh).empty());
}

TEST(Coarsen, ThinsSupportsAmongThemselvesAndKeepsTheirEnds) {
  const int n = 24;
  const TriangleMesh mesh = grid_mesh(n, n);
  CoarsenOptions options;
  options.kinds.assign(static_cast<size_t>(mesh.vertex_count()), 0);
  for (int i = 6; i <= 18; ++i) options.kinds[static_cast<size_t>(grid_node(n, i, 0))] = 7;
  const Coarsening c = coarsen(mesh, options);
  EXPECT_GE(c.number[static_cast<size_t>(grid_node(n, 6, 0))], 0);
  EXPECT_GE(c.number[static_cast<size_t>(grid_node(n, 18, 0))], 0);
  int left = 0;
  for (int i = 6; i <= 18; ++i) left += c.number[static_cast<size_t>(grid_node(n, i, 0))] >= 0;
  EXPECT_LT(left, 13);
}

TEST(Coarsen, KeepsALineOfCables) {
  const int n = 24;
  const TriangleMesh mesh = grid_mesh(n, n);
  CoarsenOptions options;
  for (int j = 0; j < n; ++j) options.lines.push_back({grid_node(n, 8, j), grid_node(n, 8, j + 1)});
  const Coarsening c = coarsen(mesh, options);
  double length = 0;
  for (const Edge& edge : edges(c.mesh.triangles)) {
    const Vec3 a = c.mesh.vertices.col(edge.a), b = c.mesh.vertices.col(edge.b);
    if (std::abs(a.x() - 8.0 / n) < 1e-9 && std::abs(b.x() - 8.0 / n) < 1e-9) length += (a - b).norm();
  }
  EXPECT_NEAR(length, 1, 1e-12);
}

TEST(Coarsen, GivesTheSameMeshEachTime) {
  const TriangleMesh mesh = two_regions();
  const Coarsening a = coarsen(mesh), b = coarsen(mesh);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(a.weights, b.weights);
}

TEST(Coarsen, DoesNotDependOnTheFrame) {
  TriangleMesh mesh = two_regions(), turned;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.01, 0.01);
  for (double& x : mesh.vertices.reshaped()) x += shift(random);
  turned = mesh;
  turned.vertices = Eigen::AngleAxisd(0.5, Vec3(1, 2, 3).normalized()).toRotationMatrix() * mesh.vertices;
  EXPECT_EQ(coarsen(mesh).kept, coarsen(turned).kept);
}

std::multiset<std::set<int>> corner_sets(const TriangleMesh& mesh) {
  std::multiset<std::set<int>> sets;
  for (const auto& t : mesh.triangles.colwise()) sets.insert({t.begin(), t.end()});
  return sets;
}

// The same surface with its vertices, triangles and corners in another order.
struct Reordered {
  TriangleMesh mesh;
  std::vector<int> vertex;  // given one of each
};

Reordered reordered(const TriangleMesh& mesh) {
  std::mt19937 random(3);
  Reordered other{mesh, std::vector<int>(static_cast<size_t>(mesh.vertex_count()))};
  std::iota(other.vertex.begin(), other.vertex.end(), 0);
  std::shuffle(other.vertex.begin(), other.vertex.end(), random);
  std::vector<int> number(other.vertex.size()), order(static_cast<size_t>(mesh.triangle_count()));
  for (size_t k = 0; k < number.size(); ++k)
    number[static_cast<size_t>(other.vertex[k])] = static_cast<int>(k);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  other.mesh.vertices = mesh.vertices(Eigen::all, other.vertex);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const int from = order[static_cast<size_t>(t)];
    for (int k = 0; k < 3; ++k)
      other.mesh.triangles(k, t) = number[static_cast<size_t>(mesh.triangles((k + t) % 3, from))];
    if (!mesh.regions.empty())
      other.mesh.regions[static_cast<size_t>(t)] = mesh.regions[static_cast<size_t>(from)];
  }
  return other;
}

TEST(Coarsen, DoesNotDependOnTheOrderOfVerticesAndTriangles) {
  for (const TriangleMesh& mesh : {grid_mesh(30, 20), disc_mesh(16), sphere_mesh(4), two_regions()}) {
    const Reordered other = reordered(mesh);
    const Coarsening a = coarsen(mesh), b = coarsen(other.mesh);
    std::vector<int> kept;
    for (const int v : b.kept) kept.push_back(other.vertex[static_cast<size_t>(v)]);
    std::sort(kept.begin(), kept.end());
    EXPECT_EQ(a.kept, kept);
    for (size_t k = 0; k < other.vertex.size(); ++k)
      EXPECT_EQ(a.weights.col(other.vertex[k]), b.weights.col(static_cast<Eigen::Index>(k)));
    EXPECT_EQ(edges(a.mesh.triangles).size(), edges(b.mesh.triangles).size());
  }
}

TEST(Coarsen, LeavesWhatItCannotCoarsenAsItIs) {
  TriangleMesh soup;  // triangles that share no vertex
  soup.vertices.resize(3, 30);
  soup.triangles.resize(3, 10);
  for (int t = 0; t < 10; ++t) {
    soup.vertices.middleCols(3 * t, 3) << 0, 1, 0, 0, 0, 1, t, t, t;
    soup.triangles.col(t) << 3 * t, 3 * t + 1, 3 * t + 2;
  }
  EXPECT_EQ(corner_sets(coarsen(soup).mesh), corner_sets(soup));

  TriangleMesh three_leaves;  // around one edge
  three_leaves.vertices = Points(3, 5);
  three_leaves.vertices << 0, 1, 0, 0, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 1;
  three_leaves.triangles = Triangles(3, 3);
  three_leaves.triangles << 0, 0, 0, 1, 1, 1, 2, 3, 4;
  EXPECT_EQ(corner_sets(coarsen(three_leaves).mesh), corner_sets(three_leaves));
}

TEST(Prolong, IsExactForAffineMotionsOfAFlatSheetAndRigidOnesOfAnySurface) {
  Eigen::Matrix3d stretch;
  stretch << 1.3, 0.2, 0, -0.1, 0.8, 0, 0.4, 0.3, 1;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 shift(5, -7, 3);
  struct Case {
    TriangleMesh mesh;
    Eigen::Matrix3d map;
  };
  for (const Case& c :
       {Case{disc_mesh(12), stretch}, Case{two_regions(), turn}, Case{sphere_mesh(4), turn}}) {
    const Coarsening coarsening = coarsen(c.mesh);
    ASSERT_LT(coarsening.mesh.triangle_count(), 0.3 * c.mesh.triangle_count());
    const Points x = (c.map * coarsening.mesh.vertices).colwise() + shift;
    const Points expected = (c.map * c.mesh.vertices).colwise() + shift;
    EXPECT_LT((prolonged(coarsening, c.mesh.vertices, x) - expected).cwiseAbs().maxCoeff(), 1e-12);
  }
}

}  // namespace
}  // namespace coapt
