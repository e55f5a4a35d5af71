#include "scene/build/build.hpp"

#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/bending.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace coapt {
namespace {

constexpr const char* kDiscTerms = R"([
  {"type": "cst_stvk", "young": "1 MPa", "thickness": "1 mm", "prestress": "0.1 N/mm"},
  {"type": "load_pressure", "value": "1 kPa"}])";

// A disc of radius 10 mm, the files around it, and a scene of the parts given.
class BuildTest : public testing::Test {
 protected:
  BuildTest() {
    disc_ = disc(10, 200);
    write_mesh(folder_.path() / "disc.obj", disc_);
  }

  Model build_disc(const std::string& terms, const std::string& more) {
    return build(load_scene(folder_.write(
        "scene.json",
        R"({"mesh": {"file": "disc.obj", "sets": "sets.json"}, "terms": )" + terms + more + "}")));
  }

  std::string refusal(const std::string& terms, const std::string& more) {
    try {
      build_disc(terms, more);
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  TemporaryFolder folder_;
  TriangleMesh disc_;
  std::filesystem::path sets_ = folder_.write("sets.json", R"({"centre": [0], "far": [100000]})");
};

constexpr const char* kHeldRim = R"(, "boundary": [{"nodes": "boundary", "fix": true}])";

TEST_F(BuildTest, MakesADiscReadyToSolve) {
  Model model = build_disc(kDiscTerms, kHeldRim);
  EXPECT_TRUE(model.warnings.empty()) << model.warnings[0];
  const int rim = static_cast<int>(model.sets.at("boundary").size());
  EXPECT_EQ(model.objective->free_count(), 3 * (disc_.vertex_count() - rim));
  EXPECT_EQ(model.objective->terms().size(), 2u);
  EXPECT_DOUBLE_EQ(model.applied_pressure, 0.001);
  ASSERT_EQ(model.membrane.size(), static_cast<size_t>(disc_.triangle_count()));
  EXPECT_EQ(model.membrane[0].prestress, 0.1);
  EXPECT_EQ(model.sets.at("centre"), std::vector<int>{0});
  EXPECT_FALSE(model.sets.contains("far"));
  Vector g;
  model.objective->gradient(model.q0, g);
  EXPECT_GT(g.norm(), 0);
}

const EnergyTerm* find_term(const Model& model, std::string_view type) {
  for (const auto& term : model.objective->terms())
    if (term->type() == type) return term.get();
  return nullptr;
}

constexpr const char* kTensionField =
    R"({"type": "cst_tension_field", "young": "1 MPa", "poisson": 0.5e-12, "thickness": "1 mm"})";

TEST_F(BuildTest, GivesEveryInnerEdgeThePlateStiffnessOfItsMembraneWhateverTheOrderOfTerms) {
  const std::string bending = R"({"type": "bending"})", membrane = kTensionField;
  for (const std::string& terms : {bending + "," + membrane, membrane + "," + bending}) {
    const Model model = build_disc("[" + terms + "]", kHeldRim);
    const auto* hinges = dynamic_cast<const ElementTerm<BendingHinge>*>(find_term(model, "bending"));
    ASSERT_NE(hinges, nullptr);
    const int rim = static_cast<int>(model.sets.at("boundary").size());
    EXPECT_EQ(static_cast<int>(hinges->rest().size()), (3 * disc_.triangle_count() - rim) / 2);
    const int* n = hinges->stencils().nodes.data();
    const auto expected = BendingHinge::rest(model.X.col(n[0]), model.X.col(n[1]), model.X.col(n[2]),
                                             model.X.col(n[3]), 1.0 / 12);
    EXPECT_NEAR(hinges->rest()[0].stiffness, expected.stiffness, 1e-12);
    EXPECT_EQ(static_cast<int>(model.membrane_patches.at(0).triangles.size()), disc_.triangle_count());
  }
}

TEST_F(BuildTest, TakesBendingFromTheSceneWhereItSaysSo) {
  const auto stiffness = [&](const std::string& keys) {
    const Model model = build_disc(R"([{"type": "bending")" + keys + "}," + kTensionField + "]", kHeldRim);
    return dynamic_cast<const ElementTerm<BendingHinge>&>(*find_term(model, "bending")).rest()[0].stiffness;
  };
  const double physical = stiffness("");
  EXPECT_NEAR(stiffness(R"(, "stiffness": "1 N mm")") / physical, 12, 1e-10);
  EXPECT_NEAR(stiffness(R"(, "thickness": "2 mm")") / physical, 8, 1e-10);
  EXPECT_NEAR(stiffness(R"(, "scale": 0.1)") / physical, 0.1, 1e-12);
}

TEST_F(BuildTest, RefusesBendingWithoutAStiffness) {
  EXPECT_NE(refusal(R"([{"type": "bending"}, {"type": "surface_tension", "tension": "1 N/m"}])", kHeldRim)
                .find("no membrane term gives a modulus and a thickness"),
            std::string::npos);
  EXPECT_NE(refusal(R"([{"type": "bending", "stiffness": "1 N mm", "thickness": "1 mm"}, )" +
                        std::string(kTensionField) + "]",
                    kHeldRim)
                .find("has no meaning beside stiffness"),
            std::string::npos);
}

TEST_F(BuildTest, SolvesTheDiscToARoundedDome) {
  const Model model = build_disc(kDiscTerms, kHeldRim);
  const auto solver = scene_solvers().at("lbfgs")({});
  const Result result = solve(*solver, {*model.objective, model.q0, model.motion}, {.tolerance = 1e-6});
  EXPECT_EQ(result.status, Status::Converged) << result.message;
  const double height = model.objective->positions(result.q)(2, 0);
  // Without strain the prestressed disc would rise by p a^2 / (4 T) = 0.25 mm; stretching stiffens it.
  EXPECT_GT(height, 0.15);
  EXPECT_LT(height, 0.25);
}

// S2: seven digits of every coordinate are those of the offset.
TEST_F(BuildTest, S2SolvesAlikeFarFromTheOrigin) {
  const auto shape = [&](const Vec3& offset) {
    TriangleMesh moved = disc_;
    moved.vertices.colwise() += offset;
    write_mesh(folder_.path() / "disc.obj", moved);
    const Model model = build_disc(kDiscTerms, kHeldRim);
    const auto newton = scene_solvers().at("newton")({});
    const Result result = solve(*newton, {*model.objective, model.q0, model.motion}, {.tolerance = 1e-10});
    EXPECT_EQ(result.status, Status::Converged) << result.message;
    const Points x = model.objective->positions(result.q);
    return Points((x - model.X));
  };
  const Points near = shape(Vec3::Zero()), far = shape(Vec3(1e8, -1e8, 1e8));  // the disc has a radius of 10
  EXPECT_LT((near - far).lpNorm<Eigen::Infinity>(), 1e-8 * 20);
  EXPECT_GT(near.lpNorm<Eigen::Infinity>(), 0.1);
}

TEST_F(BuildTest, PushesAgainstTheNormalsFromTheFront) {
  for (const char* model_name : {"follower", "volume", "frozen"}) {
    const auto force_at_centre = [&](const char* side) {
      Model model = build_disc(R"([{"type": "cst_stvk", "young": "1 MPa", "thickness": "1 mm"},
          {"type": "load_pressure", "value": "1 kPa", "side": ")" +
                                   std::string(side) + R"(", "model": ")" + model_name + R"("}])",
                               kHeldRim);
      Vector g;
      model.objective->gradient(model.q0, g);
      return -g[2];  // the centre is node 0
    };
    EXPECT_GT(force_at_centre("back"), 0) << model_name;
    EXPECT_DOUBLE_EQ(force_at_centre("back"), -force_at_centre("front")) << model_name;
  }
}

TEST_F(BuildTest, MovesNodesAlongStraightLinesInSteps) {
  const Model model = build_disc(kDiscTerms, R"(, "boundary": [
      {"nodes": "boundary", "move_to": [{"translate": [0, 0, 4]}, {"translate": [2, 0, 4]}]}])");
  ASSERT_TRUE(model.motion.positions != nullptr);
  const int node = model.sets.at("boundary")[0];
  const Vec3 X = model.X.col(node);
  EXPECT_LT((model.motion.positions(0.25).col(node) - X - Vec3(0, 0, 2)).norm(), 1e-14);
  EXPECT_LT((model.motion.positions(0.75).col(node) - X - Vec3(1, 0, 4)).norm(), 1e-14);
  EXPECT_LT((model.motion.positions(1).col(node) - X - Vec3(2, 0, 4)).norm(), 1e-14);
  EXPECT_EQ(model.motion.steps, 2);  // one for each station
}

TEST_F(BuildTest, ReadsTargetsFromAFileInItsUnit) {
  folder_.write("to.csv", "x,y,z\n0.001, 0.002, 0.003\n");
  const Model model = build_disc(kDiscTerms, R"(, "boundary": [{"nodes": "boundary", "fix": true},
      {"nodes": "centre", "move_to": "to.csv", "unit": "m"}])");
  EXPECT_EQ(model.motion.positions(1).col(0), Vec3(1, 2, 3));
  folder_.write("to.csv", "1 2 3\n4 5 6\n");
  EXPECT_NE(refusal(kDiscTerms, R"(, "boundary": [{"nodes": "centre", "move_to": "to.csv"}])")
                .find("has 2 positions for 1 nodes"),
            std::string::npos);
  folder_.write("to.csv", "1 2 3\n4 5 nan\n");
  EXPECT_NE(refusal(kDiscTerms, R"(, "boundary": [{"nodes": "centre", "move_to": "to.csv"}])")
                .find("to.csv:2: expected three finite numbers"),
            std::string::npos);
}

TEST_F(BuildTest, SelectsNodesByWhereTheyLie) {
  const Model model = build_disc(kDiscTerms, R"(, "sets": {
      "axis": {"plane": {"axis": "x"}}, "quarter": {"box": {"min": [-20, -20, -1], "max": [0, "0 mm", 1]}},
      "rightmost": {"nearest": [100, 0, 0]}}, "boundary": [{"nodes": "axis", "fix": ["x"]}])");
  for (const int node : model.sets.at("axis")) EXPECT_LT(std::abs(model.X(0, node)), 1e-5);
  for (const int node : model.sets.at("quarter")) EXPECT_LE(model.X.col(node).head<2>().maxCoeff(), 0);
  EXPECT_DOUBLE_EQ(model.X(0, model.sets.at("rightmost").at(0)), 10);
  EXPECT_TRUE(model.objective->fixed()(0, model.sets.at("axis")[0]));
  EXPECT_FALSE(model.objective->fixed()(1, model.sets.at("axis")[0]));
}

std::vector<int> nodes_with(const Model& model, const std::function<bool(const Vec3&)>& test) {
  std::vector<int> nodes;
  for (int node = 0; node < model.X.cols(); ++node)
    if (test(model.X.col(node) + model.origin)) nodes.push_back(node);
  return nodes;
}

TEST_F(BuildTest, SelectsNodesByPlanesSpheresAndConditions) {
  const Model model = build_disc(kDiscTerms, R"(, "sets": {
      "slanted": {"plane": {"normal": [2, -2, 0], "within": 0.7}},
      "shifted": {"plane": {"normal": [3, 4, 0], "point": [1, 1, 0], "at": "0.3 cm", "within": 0.7}},
      "beyond": {"half_space": {"normal": [3, 4, 0], "point": [1, 1, 0], "at": "0.3 cm"}},
      "right": {"half_space": {"axis": "x"}},
      "ball": {"sphere": {"centre": [5, 0, 1], "radius": "3 mm"}},
      "ring": {"where": "x^2 + y^2 > 0.3 cm^2 && !(abs(y) < 2 mm) "}})");
  const auto height = [](const Vec3& x) { return 0.6 * (x[0] - 1) + 0.8 * (x[1] - 1) - 3; };
  const auto same = [&](const char* name, const std::function<bool(const Vec3&)>& test) {
    const std::vector<int> wanted = nodes_with(model, test);
    EXPECT_GT(wanted.size(), 3u) << name;
    EXPECT_LT(wanted.size(), static_cast<size_t>(model.X.cols())) << name;
    EXPECT_EQ(model.sets.at(name), wanted) << name;
  };
  same("slanted", [](const Vec3& x) { return std::abs(x[0] - x[1]) / std::sqrt(2.0) <= 0.7; });
  same("shifted", [&](const Vec3& x) { return std::abs(height(x)) <= 0.7; });
  same("beyond", [&](const Vec3& x) { return height(x) >= -1e-5; });
  same("right", [](const Vec3& x) { return x[0] >= -1e-5; });
  same("ball", [](const Vec3& x) { return (x - Vec3(5, 0, 1)).norm() <= 3; });
  same("ring", [](const Vec3& x) { return x[0] * x[0] + x[1] * x[1] > 30 && std::abs(x[1]) >= 2; });
}

TEST_F(BuildTest, ListsTheKnownNamesForAnUnknownOne) {
  const std::string set = refusal(kDiscTerms, R"(, "boundary": [{"nodes": "boundery", "fix": true},
                                                                {"nodes": [5000], "fix": true}])");
  EXPECT_NE(set.find("boundary[0].nodes: no node set \"boundery\"; known sets: all, boundary, centre"),
            std::string::npos)
      << set;
  EXPECT_NE(set.find("node 5000 does not exist"), std::string::npos) << set;
  const std::string region =
      refusal(R"([{"type": "surface_tension", "tension": "1 N/m", "region": "anterior"}])", "");
  EXPECT_NE(region.find("terms[0].region: the mesh has no region \"anterior\""), std::string::npos) << region;
  const std::string points =
      refusal(kDiscTerms, R"(, "boundary": [{"nodes": "centre", "move_to": "closed"}])");
  EXPECT_NE(points.find("no positions \"closed\""), std::string::npos) << points;
}

double annulus_area(const Model& model) {
  const std::vector<int>& loop = model.sets.at("annulus");
  Vec3 area = Vec3::Zero();
  for (size_t k = 0; k < loop.size(); ++k)
    area += 0.5 * Vec3(model.X.col(loop[k])).cross(Vec3(model.X.col(loop[(k + 1) % loop.size()])));
  return area.norm();
}

TEST_F(BuildTest, PutsAnAnnulusInTheOrderOfItsRim) {
  const std::vector<int> rim = boundary_loops(disc_.triangles)[0];
  std::vector<int> shuffled = rim;
  for (size_t k = 0; k < rim.size(); ++k) shuffled[k] = rim[k * 7 % rim.size()];
  ASSERT_NE(rim.size() % 7, 0u);
  std::string text = R"({"annulus": [)";
  for (size_t k = 0; k < rim.size(); ++k) text += (k == 0 ? "" : ", ") + std::to_string(shuffled[k]);
  text += R"(], "annulus_closed": [)";
  for (size_t k = 0; k < rim.size(); ++k)
    text += (k == 0 ? "[0, 0, " : ", [0, 0, ") + std::to_string(shuffled[k]) + "]";
  folder_.write("sets.json", text + "]}");
  const Model model =
      build_disc(kDiscTerms, R"(, "boundary": [{"nodes": "annulus", "move_to": "annulus_closed"}])");
  EXPECT_NEAR(annulus_area(model), 314, 5);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("scene.json: annulus: its vertices did not follow"), std::string::npos);
  const Points moved = model.motion.positions(1);
  for (const int v : rim) EXPECT_EQ(moved(2, v), v) << "each has its own closed position still";
}

TEST_F(BuildTest, RefusesAnAnnulusOfTwoRims) {
  TriangleMesh two = disc_;
  two.vertices.conservativeResize(3, 2 * disc_.vertex_count());
  two.vertices.rightCols(disc_.vertex_count()) = disc_.vertices.colwise() + Vec3(0, 0, 5);
  two.triangles.conservativeResize(3, 2 * disc_.triangle_count());
  two.triangles.rightCols(disc_.triangle_count()) = disc_.triangles.array() + disc_.vertex_count();
  write_mesh(folder_.path() / "disc.obj", two);
  EXPECT_NE(refusal(kDiscTerms, std::string(R"(, "sets": {"annulus": "boundary"})") + kHeldRim)
                .find("annulus: its vertices lie on 2 rims of the mesh"),
            std::string::npos);
}

TEST_F(BuildTest, WarnsOfAPartThatNothingHolds) {
  const Model model = build_disc(kDiscTerms, "");
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("rigid-body modes"), std::string::npos);
}

TEST_F(BuildTest, HoldsIsolatedVerticesAndSaysSo) {
  TriangleMesh mesh = disc_;
  mesh.vertices.conservativeResize(3, mesh.vertex_count() + 1);
  mesh.vertices.rightCols(1) = Vec3(0, 0, 50);
  write_mesh(folder_.path() / "disc.obj", mesh);
  const Model model = build_disc(kDiscTerms, kHeldRim);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find(std::to_string(disc_.vertex_count())), std::string::npos);
  EXPECT_TRUE(model.objective->fixed().col(disc_.vertex_count()).all());
}

TEST_F(BuildTest, TakesTheContactStrengthFromThePressure) {
  const std::string held = kHeldRim;
  const Model model = build_disc(R"([{"type": "contact_facet"}, {"type": "load_pressure", "value": "1 kPa"},
      {"type": "cst_stvk", "young": "1 MPa", "thickness": "1 mm"}])",
                                 held);
  EXPECT_NEAR(model.contact_range, 0.5 * mean_edge_length(disc_.vertices, disc_.triangles), 1e-12);
  EXPECT_NE(refusal(R"([{"type": "contact_facet"}, {"type": "surface_tension", "tension": "1 N/m"}])", held)
                .find("terms[0].strength: missing"),
            std::string::npos);
}

TEST_F(BuildTest, LaysConstantForceCablesAlongTheBoundaryOnly) {
  const Model model = build_disc(R"([{"type": "surface_tension", "tension": "1 N/mm"},
      {"type": "cable", "edges": "boundary", "tension": "10 N"}])",
                                 R"(, "boundary": [{"nodes": {"nearest": [10, 0, 0]}, "fix": true}])");
  EXPECT_EQ(model.lines.size(), model.sets.at("boundary").size());
}

TEST_F(BuildTest, MovesAFarMeshToZero) {
  TriangleMesh mesh = disc_;
  mesh.vertices.colwise() += Vec3(1e6, -2e6, 3e6);
  write_mesh(folder_.path() / "disc.obj", mesh);
  const Model model = build_disc(kDiscTerms, kHeldRim);
  EXPECT_LT(model.X.cwiseAbs().maxCoeff(), 11);
  EXPECT_LT((model.X.col(0) + model.origin - Vec3(1e6, -2e6, 3e6)).norm(), 1e-8);
  EXPECT_EQ(model.mesh.vertices, model.X);
}

constexpr const char* kChain = R"({"papillary": [[0, 0, 0], [10, 0, 0]], "junctions": [[5, 0, -1]],
  "chords": [{"from": {"papillary": 0}, "to": {"junction": 0}, "rest_length": 6, "area": 1, "material": "a"},
             {"from": {"junction": 0}, "to": {"papillary": 1}, "rest_length": %, "area": 1, "material": "b"}]})";

Model build_chain(const TemporaryFolder& folder, const std::string& rest, const std::string& keys,
                  const std::string& law = R"("cable", "young": "1 MPa")") {
  std::string chain = kChain;
  chain.replace(chain.find('%'), 1, rest);
  folder.write("chain.json", chain);
  return build(load_scene(folder.write("scene.json", R"({"terms": [
      {"type": )" + law + R"(, "network": "chain.json")" +
                                                         keys + R"(},
      {"type": "load_field", "direction": [0, 0, -1], "force": "1 N", "nodes": "junctions"}]})")));
}

TEST(BuildNetwork, HangsAChainWithoutAMeshFromItsAnchors) {
  const TemporaryFolder folder;
  const Model model = build_chain(folder, "6", "");
  EXPECT_EQ(model.X.cols(), 3);
  EXPECT_EQ(model.lines.size(), 2u);
  EXPECT_EQ(model.sets.at("junctions"), std::vector<int>{2});
  EXPECT_EQ(model.objective->free_count(), 3);
  EXPECT_TRUE(model.warnings.empty());
  EXPECT_EQ(build_chain(folder, "6", R"(, "materials": "b")").lines.size(), 1u);
  EXPECT_EQ(build_chain(folder, "6", R"(, "length_scale": 0.5)").lines[0].rest_length, 3);
}

// S5, whichever law the chords have.
TEST(BuildNetwork, S5LeavesOutAnElasticChordOfZeroLengthWithAWarning) {
  const TemporaryFolder folder;
  const char* const laws[] = {
      R"("cable", "young": "1 MPa")",
      R"("cable_bilinear", "young_pre": "1 MPa", "young_post": "60 MPa", "transition_strain": 0.1)",
      R"("cable_ogden", "mu": ["1 MPa"], "alpha": [2])",
      R"("cable_toe", "young": "1 MPa", "recruitment_strain": 0.1, "intercept": 0.05, "exponent": 20)",
      R"("cable_crimped_fibre", "fibre_young": "1 MPa", "crimp_ratio": 12, "radius_ratio": 3)"};
  for (const std::string law : laws) {
    const Model model = build_chain(folder, "0", "", law);
    EXPECT_EQ(model.lines.size(), 1u) << law;
    ASSERT_EQ(model.warnings.size(), 1u) << law;
    EXPECT_NE(model.warnings[0].find("chords[1]: the rest length is zero"), std::string::npos)
        << model.warnings[0];
    EXPECT_NE(model.warnings[0].find("left out"), std::string::npos);
    Vector g;
    EXPECT_TRUE(std::isfinite(model.objective->gradient(model.q0, g)) && g.allFinite()) << law;
  }
}

// A tether's law knows no rest length to divide by: it stays, and the warning says what it is.
TEST(BuildNetwork, S5KeepsATetherOfZeroLengthWithAWarning) {
  const TemporaryFolder folder;
  const Model model = build_chain(folder, "0", "", R"("tether_cubic", "strength": "1 mJ", "scale": "1 mm")");
  EXPECT_EQ(model.lines.size(), 2u);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(model.warnings[0].find("the tether has length zero"), std::string::npos) << model.warnings[0];
}

TEST(BuildNetwork, NamesTheChordThatEndsAtAMissingVertex) {
  const TemporaryFolder folder;
  folder.write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("net.json", R"({"papillary": [[0, 0, -5]], "chords": [
      {"from": {"papillary": 0}, "to": {"leaflet": 3}, "rest_length": 5, "area": 1}]})");
  try {
    build(load_scene(folder.write("scene.json", R"({"mesh": {"file": "mesh.obj"}, "terms": [
        {"type": "cable", "network": "net.json", "young": "1 MPa"}]})")));
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("net.json: chords[0].to.leaflet: vertex 3 does not exist"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace coapt
