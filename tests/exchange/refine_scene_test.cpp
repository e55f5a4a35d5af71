// What a scene's surface, sets, supports and chords become on finer meshes.
#include "scene/build/refine_scene.hpp"

#include "exchange/import.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "scene/build/build.hpp"
#include "scene/build/coarsen_scene.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace coapt {
namespace {

class RefinedValve : public testing::Test {
 protected:
  RefinedValve() {
    write_valve_scene(mitral_valve({.triangles = 400, .preset = MitralPreset::Benchmark}), folder_.path(),
                      {});
    scene_ = load_scene(folder_.path() / "scene.json");
    geometry_ = scene_geometry(scene_);
    fine_ = refined(geometry_);
  }

  TemporaryFolder folder_;
  Scene scene_;
  SceneGeometry geometry_, fine_;
};

TEST_F(RefinedValve, IsTheSameSurfaceWithTheSameChords) {
  const Model a = build(scene_, geometry_), b = build(scene_, fine_);
  EXPECT_EQ(b.mesh.triangle_count(), 4 * a.mesh.triangle_count());
  EXPECT_NEAR(surface_area(b.X, b.mesh.triangles) / surface_area(a.X, a.mesh.triangles), 1, 1e-12);
  EXPECT_EQ(b.X.leftCols(b.mesh.vertex_count()), b.mesh.vertices);
  EXPECT_EQ(b.mesh.region_names, a.mesh.region_names);
  EXPECT_EQ(b.warnings, a.warnings);
  ASSERT_EQ(fine_.number.size(), static_cast<size_t>(a.X.cols()));
  for (int node = 0; node < a.X.cols(); ++node)
    EXPECT_EQ(b.X.col(fine_.number[static_cast<size_t>(node)]), a.X.col(node));
  ASSERT_EQ(a.lines.size(), b.lines.size());
  ASSERT_GT(a.lines.size(), 20u);
  for (size_t k = 0; k < a.lines.size(); ++k) {
    EXPECT_EQ(b.lines[k].a, fine_.number[static_cast<size_t>(a.lines[k].a)]);
    EXPECT_EQ(b.lines[k].b, fine_.number[static_cast<size_t>(a.lines[k].b)]);
    EXPECT_EQ(b.lines[k].rest_length, a.lines[k].rest_length);
  }
  EXPECT_EQ(b.sets.at("all").size(), static_cast<size_t>(b.X.cols()));
  ASSERT_EQ(b.sets.at("papillary").size(), a.sets.at("papillary").size());
  for (size_t k = 0; k < a.sets.at("papillary").size(); ++k)
    EXPECT_EQ(b.X.col(b.sets.at("papillary")[k]), a.X.col(a.sets.at("papillary")[k]));
}

// The annulus stays an ordered loop, with a middle behind each of its vertices, which goes where the mean of
// its ends goes.
TEST_F(RefinedValve, MovesTheMiddlesOfItsAnnulusWithTheirEnds) {
  const Model a = build(scene_, geometry_), b = build(scene_, fine_);
  const std::vector<int>&coarse = a.sets.at("annulus"), &finer = b.sets.at("annulus");
  ASSERT_EQ(finer.size(), 2 * coarse.size());
  for (const double t : {0.5, 1.0}) {
    const Points to = a.motion.positions(t), fine_to = b.motion.positions(t);
    for (size_t k = 0; k < coarse.size(); ++k) {
      const int here = coarse[k], next = coarse[(k + 1) % coarse.size()], middle = finer[2 * k + 1];
      EXPECT_EQ(finer[2 * k], fine_.number[static_cast<size_t>(here)]);
      EXPECT_TRUE(b.objective->fixed().col(middle).all());
      EXPECT_LT((b.X.col(middle) - 0.5 * (a.X.col(here) + a.X.col(next))).norm(), 1e-12);
      EXPECT_LT((fine_to.col(middle) - 0.5 * (to.col(here) + to.col(next))).norm(), 1e-9);
    }
  }
  EXPECT_GT((a.motion.positions(1) - a.X).cwiseAbs().maxCoeff(), 0.1);
  // Nothing else of the surface is held.
  const auto held = b.objective->fixed().leftCols(b.mesh.vertex_count()).count();
  EXPECT_EQ(held, 3 * static_cast<Eigen::Index>(finer.size()));
}

class RefinedSheet : public testing::Test {
 protected:
  SceneGeometry geometry(const TriangleMesh& mesh, const std::string& boundary,
                         const std::string& load = "") {
    write_mesh(folder_.path() / "sheet.obj", mesh);
    scene_ =
        load_scene(folder_.write("scene.json", R"({"mesh": {"file": "sheet.obj"}, "boundary": )" + boundary +
                                                   R"(, "terms": [{"type": "cst_stvk", "young": "1 MPa",
      "thickness": "0.1 mm"})" + load + "]}"));
    return scene_geometry(scene_);
  }

  TemporaryFolder folder_;
  Scene scene_;
};

// All vertices of a strip are on its boundary, but the middles of the edges across it are not.
TEST_F(RefinedSheet, HoldsItsBoundaryAloneThoughInnerEdgesJoinPlacesOfIt) {
  const SceneGeometry coarse = geometry(rectangle(4, 1, 8), R"([{"nodes": "boundary", "fix": true}])");
  ASSERT_TRUE(coarse.prescribed.fixed.all());
  const SceneGeometry fine = refined(coarse), finer = refined(fine);
  for (const SceneGeometry* level : {&fine, &finer}) {
    const auto loops = boundary_loops(level->model.mesh.triangles);
    ASSERT_EQ(loops.size(), 1u);
    EXPECT_EQ(level->prescribed.fixed.count(), 3 * static_cast<Eigen::Index>(loops[0].size()));
    for (const int v : loops[0]) EXPECT_TRUE(level->prescribed.fixed.col(v).all());
    EXPECT_EQ(level->model.sets.at("boundary").size(), loops[0].size());
  }
}

TEST_F(RefinedSheet, HoldsCoordinatesOneByOneAndInnerNodesToo) {
  const SceneGeometry coarse = geometry(
      square(10, 200), R"([{"nodes": {"box": {"min": [-1, -1, -1], "max": [5.5, 11, 1]}}, "fix": ["z"]}])");
  const SceneGeometry fine = refined(coarse);
  for (int v = 0; v < fine.model.X.cols(); ++v) {
    EXPECT_EQ(fine.prescribed.fixed(2, v), fine.model.X(0, v) < 5.01) << fine.model.X.col(v).transpose();
    EXPECT_FALSE(fine.prescribed.fixed(0, v));
  }
}

// A value on each vertex or triangle, through two cuts and back to a coarser mesh.
TEST_F(RefinedSheet, CarriesValuesThroughCutsAndCascades) {
  const SceneGeometry own =
      geometry(square(10, 800, CellPattern::Cross), R"([{"nodes": "boundary", "fix": true}])");
  const Vec3 slope(0.3, -0.7, 0);
  const auto linear = [&](const Points& x) { return Vector((slope.transpose() * x).transpose()); };
  const auto centres = [](const SceneGeometry& level) {
    Points c(3, level.model.mesh.triangle_count());
    for (int t = 0; t < c.cols(); ++t)
      c.col(t) = level.model.X(Eigen::all, level.model.mesh.triangles.col(t)).rowwise().mean();
    return c;
  };
  const Vector at_nodes = linear(own.model.X), in_facets = linear(centres(own));
  const SceneGeometry fine = refined(own), finer = refined(fine);
  int parts = 1;
  for (const SceneGeometry* level : {&own, &fine, &finer}) {
    EXPECT_EQ(scene_mesh(*level).triangle_count(), own.model.mesh.triangle_count());
    EXPECT_LT((at_vertices(at_nodes, *level) - linear(level->model.X)).cwiseAbs().maxCoeff(), 1e-12);
    const Vector here = on_triangles(in_facets, *level);
    ASSERT_EQ(here.size(), parts * in_facets.size());
    for (Eigen::Index t = 0; t < here.size(); ++t) EXPECT_EQ(here[t], in_facets[t / parts]);

    const Coarsening coarsening = coarsen(level->model.mesh, coarsen_options(scene_, *level));
    const SceneGeometry thin = coarsened(*level, coarsening.mesh, coarsening.kept);
    ASSERT_LT(thin.model.mesh.triangle_count(), level->model.mesh.triangle_count() / 2);
    EXPECT_EQ(scene_mesh(thin).triangle_count(), own.model.mesh.triangle_count());
    EXPECT_LT((at_vertices(at_nodes, thin) - linear(thin.model.X)).cwiseAbs().maxCoeff(), 1e-12);
    const Vector wide = on_triangles(in_facets, thin);
    // The mean over the triangles around a vertex is that of places within one edge of it.
    EXPECT_LT((wide - linear(centres(thin))).cwiseAbs().maxCoeff(),
              slope.norm() * mean_edge_length(own.model.X, own.model.mesh.triangles));
    EXPECT_NEAR(on_triangles(Vector::Constant(in_facets.size(), 3), thin).minCoeff(), 3, 1e-12);
    EXPECT_NEAR(on_triangles(Vector::Constant(in_facets.size(), 3), thin).maxCoeff(), 3, 1e-12);
    parts *= 4;
  }
}

double total_force(const Scene& scene, const SceneGeometry& level) {
  const Model model = build(scene, level);
  Points forces = Points::Zero(3, model.X.cols());
  Sink sink(forces.data());
  for (const auto& term : model.objective->terms())
    if (term->role() == TermRole::Load) term->evaluate(model.X, sink);
  return forces.row(2).sum();
}

// Forces that the scene gives by node are shared out: their sum stays, also on a coarser mesh of a finer one.
TEST_F(RefinedSheet, KeepsTheWholeOfForcesThatAreGivenByNode) {
  const SceneGeometry own = geometry(square(10, 800), R"([{"nodes": {"nearest": [0, 0, 0]}, "fix": true}])",
                                     R"(, {"type": "load_field", "direction": [0, 0, -1], "force": "1 mN"})");
  const SceneGeometry fine = refined(own);
  const Coarsening coarsening = coarsen(fine.model.mesh, coarsen_options(scene_, fine));
  const SceneGeometry thin = coarsened(fine, coarsening.mesh, coarsening.kept);
  const double whole = total_force(scene_, own);
  EXPECT_GT(std::abs(whole), 0.1);
  EXPECT_NEAR(total_force(scene_, fine) / whole, 1, 1e-12);
  EXPECT_NEAR(total_force(scene_, thin) / whole, 1, 1e-12);
}

// Nodes that a scene lists are those of its own mesh on all others too, chord points among them.
TEST_F(RefinedValve, KeepsListedNodesWhatTheyAre) {
  NodeSelection listed;
  listed.kind = NodeSelection::Kind::Indices;
  listed.indices = {3, static_cast<int>(geometry_.model.X.cols()) - 1};
  const SceneGeometry finer = refined(fine_);
  const Coarsening coarsening = coarsen(fine_.model.mesh, coarsen_options(scene_, fine_));
  const SceneGeometry thin = coarsened(fine_, coarsening.mesh, coarsening.kept);
  for (const SceneGeometry* level : std::initializer_list<const SceneGeometry*>{&fine_, &finer}) {
    const std::vector<int> nodes = selected_nodes(listed, *level, "");
    ASSERT_EQ(nodes.size(), 2u);
    for (size_t k = 0; k < 2; ++k)
      EXPECT_EQ(level->model.X.col(nodes[k]), geometry_.model.X.col(listed.indices[k]));
  }
  const std::vector<int> left = selected_nodes(listed, thin, "");
  ASSERT_FALSE(left.empty());
  EXPECT_EQ(thin.model.X.col(left.back()), geometry_.model.X.col(listed.indices[1]));
}

}  // namespace
}  // namespace coapt
