#include "mesh/remesh/repair_slivers.hpp"

#include "mesh/distance/surface_distance.hpp"
#include "mesh/mesh_check.hpp"
#include "mesh/mesh_topology.hpp"
#include "support/mesh_samples.hpp"
#include "valve/generators/mitral.hpp"
#include "valve/repair_valve.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <random>

namespace coapt {
namespace {

// Two squares of two triangles each, side by side; the vertex 6 lies close to the middle of the edge 1-4.
//   3---4---5
//   | / | / |
//   0---1---2
TriangleMesh two_squares() {
  TriangleMesh mesh;
  mesh.vertices.resize(3, 6);
  mesh.vertices << 0, 1, 2, 0, 1, 2, 0, 0, 0, 1, 1, 1, 0, 0, 0, 0, 0, 0;
  mesh.triangles.resize(3, 4);
  mesh.triangles << 0, 0, 1, 1, 1, 4, 2, 5, 4, 3, 5, 4;
  return mesh;
}

int count_of(const MeshRepair& repair, RepairKind kind) {
  return static_cast<int>(std::count_if(repair.steps.begin(), repair.steps.end(),
                                        [kind](const RepairStep& step) { return step.kind == kind; }));
}

// Both surfaces lie within the bound of each other, the mesh is as manifold as it was and all face one side.
void expect_sound(const TriangleMesh& before, const MeshRepair& repair) {
  const double most =
      std::max(surface_distance(before, repair.mesh).max, surface_distance(repair.mesh, before).max);
  EXPECT_LE(most, repair.surface_move * (1 + 1e-9) + 1e-14);
  for (const MeshDefect& defect : check_mesh(repair.mesh))
    EXPECT_TRUE(defect.kind == MeshDefectKind::SeveralComponents) << defect.message;
  EXPECT_EQ(boundary_loops(before.triangles).size(), boundary_loops(repair.mesh.triangles).size());
  for (const RepairStep& step : repair.steps) EXPECT_LE(step.moved, repair.surface_move);
}

TEST(RepairSlivers, LeavesAGoodMeshAsItIs) {
  const TriangleMesh mesh = wavy_sheet(20);
  const MeshRepair repair = repair_slivers(mesh);
  EXPECT_FALSE(repair.is_changed());
  EXPECT_EQ(repair.mesh.vertices, mesh.vertices);
  EXPECT_EQ(repair.mesh.triangles, mesh.triangles);
  EXPECT_EQ(repair.surface_move, 0);
}

TEST(RepairSlivers, FlipsTheLongEdgeOfAFlatTriangleInside) {
  TriangleMesh mesh = two_squares();
  mesh.vertices.col(5) << 1 + 1e-5, 0.4, 0;  // of (1, 5, 4), whose long edge belongs to (0, 1, 4) too
  mesh.triangles.col(2) << 1, 2, 5;
  const MeshRepair repair = repair_slivers(mesh);
  EXPECT_EQ(repair.slivers, std::vector<int>{3});
  EXPECT_TRUE(repair.left.empty());
  ASSERT_EQ(repair.steps.size(), 1u);
  EXPECT_EQ(repair.steps[0].kind, RepairKind::Flip);
  EXPECT_EQ(repair.steps[0].apex, 5);
  EXPECT_EQ(repair.largest_move, 0);
  EXPECT_LE(repair.surface_move, 1.01e-5);
  EXPECT_GT(repair.surface_move, 0.99e-5);
  expect_sound(mesh, repair);
}

TEST(RepairSlivers, CutsAFlatTriangleOffTheRim) {
  TriangleMesh mesh = wavy_sheet(4);
  mesh.vertices.row(2).setZero();
  mesh.vertices.col(6) << 0.1, 1e-6, 0;  // inside, beside the rim between vertices 0 and 1
  const std::vector<int> flat = slivers(mesh, 1e3);
  ASSERT_EQ(flat.size(), 1u);
  const MeshRepair repair = repair_slivers(mesh);
  EXPECT_EQ(count_of(repair, RepairKind::Cut), 1);
  EXPECT_EQ(repair.mesh.vertex_count(), mesh.vertex_count());
  EXPECT_EQ(repair.mesh.triangle_count(), mesh.triangle_count() - 1);
  EXPECT_TRUE(repair.left.empty());
  expect_sound(mesh, repair);

  RepairConstraints held;
  held.roles.assign(static_cast<size_t>(mesh.vertex_count()), 0);
  held.roles[0] = held.roles[1] = 2;
  held.uncut_roles = 2;
  EXPECT_EQ(repair_slivers(mesh, held).left, flat);
}

// A vertex split in two: needles on both sides of the short edge.
TriangleMesh with_needles(double share) {
  TriangleMesh mesh = wavy_sheet(6);
  const Vec3 to = mesh.vertices.col(16);
  mesh.vertices.col(17) = to + share * (mesh.vertices.col(17) - to);
  return mesh;
}

TEST(RepairSlivers, CollapsesTheShortEdgeOfNeedles) {
  const TriangleMesh mesh = with_needles(1e-6);
  ASSERT_EQ(slivers(mesh, 1e3).size(), 2u);
  const MeshRepair repair = repair_slivers(mesh);
  ASSERT_EQ(count_of(repair, RepairKind::Collapse), 1);
  EXPECT_EQ(repair.mesh.vertex_count(), mesh.vertex_count() - 1);
  EXPECT_EQ(repair.mesh.triangle_count(), mesh.triangle_count() - 2);
  EXPECT_EQ(repair.number[16], repair.number[17]);
  EXPECT_EQ(repair.number.back(), repair.mesh.vertex_count() - 1);
  EXPECT_GT(repair.largest_move, 0);
  EXPECT_LE(repair.largest_move, 1e-6);
  expect_sound(mesh, repair);
}

TEST(RepairSlivers, MergesOnlyWhereTheRolesAllowIt) {
  const TriangleMesh mesh = with_needles(1e-6);
  RepairConstraints constraints;
  constraints.stays.assign(static_cast<size_t>(mesh.vertex_count()), false);
  constraints.stays[16] = true;
  MeshRepair repair = repair_slivers(mesh, constraints);
  ASSERT_FALSE(repair.steps.empty());
  EXPECT_EQ(repair.steps[0].edge, (std::array{17, 16}));
  constraints.stays[17] = true;
  repair = repair_slivers(mesh, constraints);
  EXPECT_EQ(count_of(repair, RepairKind::Collapse), 0);
  constraints.stays.clear();
  constraints.roles.assign(static_cast<size_t>(mesh.vertex_count()), 0);
  constraints.roles[16] = 1;
  constraints.roles[17] = 3;
  repair = repair_slivers(mesh, constraints);
  ASSERT_EQ(count_of(repair, RepairKind::Collapse), 1);
  EXPECT_EQ(repair.steps[0].edge, (std::array{16, 17}));
}

TEST(RepairSlivers, TakesOutWhatHasNoAreaAtAll) {
  const TriangleMesh mesh = with_needles(0);
  const MeshRepair repair = repair_slivers(mesh);
  EXPECT_TRUE(repair.left.empty());
  EXPECT_EQ(repair.largest_move, 0);
  EXPECT_EQ(repair.surface_move, 0);
  EXPECT_TRUE(check_mesh(repair.mesh).empty());
}

TEST(RepairSlivers, DropsRepeatedTriangles) {
  TriangleMesh mesh = wavy_sheet(3);
  mesh.triangles.conservativeResize(3, mesh.triangle_count() + 2);
  mesh.triangles.col(mesh.triangle_count() - 2) << 1, 1, 5;
  mesh.triangles.col(mesh.triangle_count() - 1) = mesh.triangles.col(4);
  const MeshRepair repair = repair_slivers(mesh);
  EXPECT_EQ(count_of(repair, RepairKind::Drop), 2);
  EXPECT_EQ(repair.mesh.triangles, wavy_sheet(3).triangles);
}

TEST(RepairSlivers, NamesWhatItCannotRepair) {
  TriangleMesh mesh;  // a triangle alone
  mesh.vertices.resize(3, 3);
  mesh.vertices << 0, 1, 0.5, 0, 0, 1e-7, 0, 0, 0;
  mesh.triangles.resize(3, 1);
  mesh.triangles << 0, 1, 2;
  const MeshRepair repair = repair_slivers(mesh);
  EXPECT_FALSE(repair.is_changed());
  EXPECT_EQ(repair.left, std::vector<int>{0});
}

// Vertices are drawn toward neighbours, edges and each other until triangles are as thin as 1e-3 to 1e-12.
TEST(RepairSlivers, RepairsSpoiltSheetsWithinItsBound) {
  int repaired = 0, left = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    std::mt19937 random(seed);
    const auto share = [&] { return static_cast<double>(random() % 100000) / 1e5; };
    TriangleMesh mesh = wavy_sheet(8);
    for (int k = 0; k < 6; ++k) {
      const int t = static_cast<int>(random() % static_cast<unsigned>(mesh.triangle_count()));
      const int corner = static_cast<int>(random() % 3);
      const int v = mesh.triangles(corner, t);
      const Vec3 a = mesh.vertices.col(mesh.triangles((corner + 1) % 3, t)),
                 b = mesh.vertices.col(mesh.triangles((corner + 2) % 3, t));
      const Vec3 on_edge = random() % 2 == 0 ? a : Vec3(a + (0.2 + 0.6 * share()) * (b - a));
      mesh.vertices.col(v) = on_edge + std::pow(10.0, -4 - 8 * share()) * (mesh.vertices.col(v) - on_edge);
    }
    const MeshRepair repair = repair_slivers(mesh);
    repaired += static_cast<int>(repair.slivers.size());
    left += static_cast<int>(repair.left.size());
    EXPECT_EQ(slivers(repair.mesh, 1e3).size(), repair.left.size()) << seed;
    const double most =
        std::max(surface_distance(mesh, repair.mesh).max, surface_distance(repair.mesh, mesh).max);
    EXPECT_LE(most, repair.surface_move * (1 + 1e-9) + 1e-14) << seed;
    for (const Edge& edge : edges(repair.mesh.triangles)) ASSERT_LE(edge.triangles.size(), 2u) << seed;
    EXPECT_TRUE(bowtie_vertices(repair.mesh).empty()) << seed;
    EXPECT_EQ(boundary_loops(repair.mesh.triangles).size(), 1u) << seed;
    EXPECT_EQ(consistent_orientation(repair.mesh).flip_count, 0) << seed;
  }
  EXPECT_GT(repaired, 1000);
  EXPECT_LT(left, repaired / 20);
}

TEST(RepairSlivers, LeavesGeneratedAndGivenValvesAsTheyAre) {
  for (const unsigned seed : {0u, 3u, 7u}) {
    Valve valve = mitral_valve({.triangles = 600, .seed = seed, .preset = MitralPreset::Benchmark});
    EXPECT_FALSE(repair_valve(valve, kSliverAspect).leaflets.is_changed()) << seed;
  }
  int missing = 0;
  for (const char* name :
       {"trivalve11-healthy/leaflets_open.obj", "trivalve11-healthy/leaflets_open_coarse.obj",
        "bhv-trileaflet/leaflets_coarse.obj", "bhv-trileaflet/leaflets_fine.obj", "cloth-skirt/skirt.obj",
        "mitral-ct-normal1/leaflets_relaxed_n32.obj", "mem4py-benchmarks/parachute.obj"}) {
    const std::string file = std::string("data/") + name;
    if (!is_shared(file)) {
      ++missing;
      continue;
    }
    EXPECT_FALSE(repair_slivers(read_mesh(shared_path(file)).mesh).is_changed()) << name;
  }
  if (missing > 0) GTEST_SKIP() << "the generated valves alone: " << missing << " given meshes not found";
}

TEST(RepairSlivers, RepairsTheRelaxedMitralLeaflets) {
  for (const char* size : {"n64", "n128"}) {
    const std::string file = std::string("data/mitral-ct-normal1/leaflets_relaxed_") + size + ".obj";
    if (!is_shared(file)) GTEST_SKIP() << kDataNotFound;
    const TriangleMesh mesh = read_mesh(shared_path(file)).mesh;
    const MeshRepair repair = repair_slivers(mesh);
    EXPECT_GE(repair.slivers.size(), 4u);
    EXPECT_TRUE(repair.left.empty());
    EXPECT_EQ(repair.largest_move, 0);
    EXPECT_LT(repair.surface_move, 0.01);
    expect_sound(mesh, repair);
  }
}

}  // namespace
}  // namespace coapt
