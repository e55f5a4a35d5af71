// xpbd on scenes: the constraints that terms become, and its options.
#include "core/error.hpp"
#include "energy/connected_parts.hpp"
#include "energy/term_access.hpp"
#include "formats/mesh_io.hpp"
#include "scene/build/build.hpp"
#include "scene/build/xpbd_body.hpp"
#include "support/temporary_folder.hpp"
#include "support/xpbd_bodies.hpp"
#include "xpbd/constraints.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Two equilateral triangles of side 2, in a scene with these terms.
class XpbdBodyTest : public testing::Test {
 protected:
  XpbdBodyTest() {
    TriangleMesh mesh;
    mesh.vertices.resize(3, 4);
    mesh.vertices.col(0) = Vec3(0, 0, 0);
    mesh.vertices.col(1) = Vec3(2, 0, 0);
    mesh.vertices.col(2) = Vec3(1, std::sqrt(3), 0);
    mesh.vertices.col(3) = Vec3(3, std::sqrt(3), 0);
    mesh.triangles.resize(3, 2);
    mesh.triangles << 0, 1, 1, 3, 2, 2;
    write_mesh(folder_.path() / "sheet.obj", mesh);
  }

  void build_with(const std::string& terms) {
    scene_ =
        load_scene(folder_.write("scene.json", R"({"mesh": {"file": "sheet.obj"}, "terms": [)" + terms +
                                                   "], \"boundary\": [{\"nodes\": [0], \"fix\": true}]}"));
    model_ = build(scene_);
    body_ = xpbd_body(model_, scene_.terms);
  }

  // Energy of the constraints at x.
  double energy(const Points& x) const {
    double sum = 0;
    for (const XpbdEdge& e : body_->edges)
      sum += 0.5 * e.stiffness * std::pow((x.col(e.a) - x.col(e.b)).norm() - e.length, 2);
    for (const XpbdArea& a : body_->areas)
      sum += 0.5 * a.stiffness * std::pow(triangle_area(x, a.nodes).value - a.area, 2);
    return sum;
  }

  // The first node, which is fixed, stays.
  Points strained(double e11, double e22, double e12) const {
    Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
    F(0, 0) += e11;
    F(1, 1) += e22;
    F(0, 1) = F(1, 0) = e12;
    const Vec3 held = model_.X.col(0);
    return (F * (model_.X.colwise() - held)).colwise() + held;
  }

  TemporaryFolder folder_;
  Scene scene_;
  Model model_;
  std::shared_ptr<const XpbdBody> body_;
};

TEST_F(XpbdBodyTest, HasTheModuliOfTheMembraneOnEquilateralTriangles) {
  for (const char* poisson : {"0.33333333", "0.45", "0.4999"}) {
    build_with(std::string(R"({"type": "cst_stvk", "young": "2 MPa", "thickness": "0.5 mm", "poisson": )") +
               poisson + "}");
    for (const auto& [e11, e22, e12] :
         {std::tuple{1e-5, 0.0, 0.0}, {1e-5, 1e-5, 0.0}, {0.0, 0.0, 1e-5}, {1e-5, -3e-5, 2e-5}}) {
      const Points x = strained(e11, e22, e12);
      EXPECT_NEAR(energy(x) / model_.objective->value(model_.objective->unknowns(x)), 1, 1e-3)
          << poisson << ": " << e11 << ", " << e22 << ", " << e12;
    }
  }
}

TEST_F(XpbdBodyTest, HasNoAreasBelowTheRatioThatEdgesHaveThemselves) {
  build_with(R"({"type": "cst_stvk", "young": "2 MPa", "thickness": "0.5 mm", "poisson": 0.2})");
  EXPECT_TRUE(body_->areas.empty());
  // Van Gelder: E h (sum of areas) / l^2, two triangles on the edge within.
  ASSERT_EQ(body_->edges.size(), 5U);
  for (const XpbdEdge& edge : body_->edges) {
    const bool is_inner = edge.a == 1 && edge.b == 2;
    EXPECT_NEAR(edge.stiffness, (is_inner ? 2 : 1) * std::sqrt(3) / 4, 1e-6);
    EXPECT_NEAR(edge.length, 2, 1e-6);
  }
}

TEST_F(XpbdBodyTest, PushesBackOnlyWhereTheMembraneDoes) {
  const std::string tail = R"(", "young": "2 MPa", "thickness": "0.5 mm"})";
  build_with(R"({"type": "cst_tension_field)" + tail);
  EXPECT_TRUE(body_->edges[0].only_tension);
  EXPECT_TRUE(body_->areas[0].only_growth);
  build_with(R"({"type": "cst_stvk)" + tail);
  EXPECT_FALSE(body_->edges[0].only_tension);
  EXPECT_FALSE(body_->areas[0].only_growth);
}

TEST_F(XpbdBodyTest, TakesLinesHingesFilmsAndContactFromTheirTerms) {
  build_with(R"({"type": "cst_stvk", "young": "2 MPa", "thickness": "0.5 mm", "prestress": "0.3 N/mm"},
    {"type": "bending"}, {"type": "surface_tension", "tension": "0.2 N/mm"},
    {"type": "cable", "edges": [0, 1], "young": "10 MPa", "area": "0.4 mm2", "smoothing": 0},
    {"type": "cable_toe", "edges": [0, 2], "young": "10 MPa", "area": "0.4 mm2", "recruitment_strain": 0.05,
     "intercept": 0.02, "exponent": 30},
    {"type": "cable", "edges": [1, 3], "tension": "3 N"},
    {"type": "tether_cubic", "edges": [2, 3], "strength": "2 mJ", "scale": "0.5 mm"},
    {"type": "load_pressure", "value": "1 kPa", "model": "frozen"}, {"type": "contact_facet"})");
  EXPECT_TRUE(body_->has_contact);
  EXPECT_NEAR(body_->pressure, 1e-3, 1e-12);
  ASSERT_EQ(body_->hinges.size(), 1U);
  EXPECT_NEAR(body_->hinges[0].angle, 0, 1e-6);
  EXPECT_GT(body_->hinges[0].stiffness, 0);
  ASSERT_EQ(body_->films.size(), 4U);
  ASSERT_EQ(body_->tethers.size(), 4U);
  // Forces of the objective's terms at a stretched state are those of the tethers.
  const Points x = 1.1 * model_.X;
  size_t k = 0;
  for (const char* name : {"cable", "cable_toe", "cable_2", "tether_cubic"}) {
    const XpbdTether& tether = body_->tethers[k++];
    const double l = (x.col(tether.a) - x.col(tether.b)).norm();
    double greatest = 0;
    for (const auto& term : model_.objective->terms())
      if (term->name() == name) greatest = nodal_forces(*term, x).colwise().norm().maxCoeff();
    ASSERT_GT(greatest, 1e-6) << name;
    const double force = tether.law ? tether.law(l).force : tether.stiffness * (l - tether.length);
    EXPECT_NEAR(force / greatest, 1, 1e-9) << name;
  }
}

// A link resists both ways. What has no length of its own is a clip, whatever the contact made of it.
TEST_F(XpbdBodyTest, TakesLinksForClipsWhereTheyHaveNoLength) {
  const std::string contact = R"(, {"type": "contact_facet", "range": "0.3 mm", "strength": "1 N/mm^3"})",
                    link = R"({"type": "link", "nodes": [0], "to": [3], "stiffness": "7 N/mm")";
  struct Case {
    std::string terms;
    double length;
    bool is_clip;
  };
  for (const Case& given : {Case{link + "}", 0, true}, Case{link + "}" + contact, 0.3, true},
                            Case{link + R"(, "length": 0})" + contact, 0, false},
                            Case{link + R"(, "length": "1 mm"})" + contact, 1, false},
                            Case{link + R"(, "keeps_distance": true})", 2 * std::sqrt(3), false}}) {
    build_with(given.terms);
    ASSERT_EQ(body_->tethers.size(), 1U);
    const XpbdTether& tether = body_->tethers[0];
    EXPECT_EQ(tether.kind, TetherKind::Link);
    EXPECT_FALSE(tether.only_tension);
    EXPECT_FALSE(tether.law);
    EXPECT_EQ(tether.stiffness, 7);
    EXPECT_NEAR(tether.length, given.length, 1e-6) << given.terms;
    EXPECT_EQ(tether.is_clip, given.is_clip) << given.terms;
    const auto& terms = model_.objective->terms();
    const EnergyTerm& term =
        **std::find_if(terms.begin(), terms.end(), [](const auto& each) { return each->name() == "link"; });
    const Points x = 1.1 * model_.X;
    const double l = (x.col(0) - x.col(3)).norm(), force = nodal_forces(term, x).col(0).norm();
    ASSERT_GT(force, 1);
    EXPECT_NEAR(tether.stiffness * (l - tether.length), force, 1e-9);
    EXPECT_NEAR(access_of(term)->line_law(0)(l).force, force, 1e-9);
  }
  EXPECT_TRUE(model_.lines.empty());  // of chord figures and views
}

// Springs note moduli of the triangles that they stand for: no membrane besides.
TEST_F(XpbdBodyTest, TakesSpringsForWhatTheyAreAndNothingElse) {
  build_with(R"({"type": "spring", "young": "2 MPa", "thickness": "0.5 mm", "compression": "resisted"})");
  EXPECT_TRUE(body_->edges.empty());
  EXPECT_TRUE(body_->areas.empty());
  ASSERT_EQ(body_->tethers.size(), 5U);
  const Points x = strained(0.02, -0.03, 0.01), forces = nodal_forces(*model_.objective->terms()[0], x);
  Points of_tethers = Points::Zero(3, x.cols());
  for (const XpbdTether& tether : body_->tethers) {
    EXPECT_FALSE(tether.only_tension);
    const Vec3 d = x.col(tether.b) - x.col(tether.a), pull = tether.law(d.norm()).force * d.normalized();
    of_tethers.col(tether.a) += pull;
    of_tethers.col(tether.b) -= pull;
  }
  EXPECT_GT(forces.norm(), 1e-3);
  EXPECT_LT((of_tethers - forces).norm(), 1e-12);
}

// What says that the comparison is one of methods and not of models.
TEST_F(XpbdBodyTest, IsExactWhereOnlyLinesAndFilmsAreLeft) {
  const std::string lines = R"({"type": "cable", "edges": [0, 1], "young": "10 MPa", "area": "0.4 mm2"},
    {"type": "spring", "young": "2 MPa", "thickness": "0.5 mm"}, {"type": "surface_tension", "tension": "0.2 N/mm"},
    {"type": "load_pressure", "value": "1 kPa", "model": "frozen"})";
  build_with(lines);
  EXPECT_TRUE(body_->is_exact);
  EXPECT_TRUE(xpbd_moves_the_scene_itself(scene_));
  XpbdOptions& options = editable(scene_.solver.xpbd);
  options.phase = HeartPhase::Diastole;
  EXPECT_FALSE(xpbd_moves_the_scene_itself(scene_));
  options = {};
  options.forces = XpbdForces::Paper;
  EXPECT_FALSE(xpbd_moves_the_scene_itself(scene_));
  options = {};
  options.stiffness = XpbdStiffness::Paper;
  EXPECT_FALSE(xpbd_moves_the_scene_itself(scene_));
  for (const char* more : {R"({"type": "cst_stvk", "young": "2 MPa", "thickness": "0.5 mm"})",
                           R"({"type": "contact_barrier"})", R"({"type": "bending", "stiffness": "1 mJ"})"}) {
    build_with(lines + ", " + more);
    EXPECT_FALSE(body_->is_exact) << more;
    EXPECT_FALSE(xpbd_moves_the_scene_itself(scene_)) << more;
  }
}

class Unknown final : public EnergyTerm {
 public:
  using EnergyTerm::EnergyTerm;
  std::string_view type() const override { return "soap"; }
  TermRole role() const override { return TermRole::Internal; }
  const Stencils& stencils() const override { return stencils_; }
  double evaluate(const Points&, Sink&) const override { return 0; }

 private:
  Stencils stencils_;
};

TEST_F(XpbdBodyTest, RefusesTermsThatItHasNoConstraintFor) {
  Model model;
  model.X = Points::Zero(3, 1);
  std::vector<std::unique_ptr<EnergyTerm>> terms;
  terms.push_back(std::make_unique<Unknown>("first"));
  terms.push_back(std::make_unique<Unknown>("second"));
  model.objective = std::make_unique<Objective>(model.X, FixedMask::Constant(3, 1, false), std::move(terms));
  try {
    xpbd_body(model, {});
    FAIL();
  } catch (const InputError& error) {
    ASSERT_EQ(error.defects().size(), 2U);
    EXPECT_NE(error.defects()[1].find("\"second\" (soap)"), std::string::npos) << error.what();
  }
}

TEST_F(XpbdBodyTest, ReadsItsOptionsFromTheScene) {
  build_with(R"({"type": "surface_tension", "tension": "1 N/mm"})");
  const Scene read = parse_scene(R"({"mesh": {"file": "sheet.obj"}, "terms": [{"type": "surface_tension",
    "tension": "1 N/mm"}], "solver": {"type": "xpbd", "threads": 2, "xpbd": {"time_step": "2 ms",
    "iterations": 3, "steps": 7, "damping": 0.1, "thickness": "0.2 mm", "stiffness": "paper",
    "forces": "paper", "phase": "diastole", "motion_time": "50 ms", "paper": {"stretch": 0.2, "bending": 0.3,
    "area": 0.4, "tether": 0.5, "contact": 0.6, "compliance": 2e-5, "flow": 60, "pressure": 90,
    "tether_compliance": 3e-5, "contact_compliance": 4e-5, "rest_angle": "flat", "radial": 70},
    "contact_features": "vertices", "rest_move": "0.02 mm"}}})",
                                 folder_.path() / "other.json");
  const XpbdOptions& options = *read.solver.xpbd;
  EXPECT_EQ(read.solver.type, "xpbd");
  EXPECT_EQ(options.time_step, 0.002);
  EXPECT_EQ(options.iterations, 3);
  EXPECT_EQ(options.steps, 7);
  EXPECT_EQ(options.damping, 0.1);
  EXPECT_EQ(options.thickness, 0.2);
  EXPECT_EQ(options.threads, 2);
  EXPECT_EQ(options.stiffness, XpbdStiffness::Paper);
  EXPECT_EQ(options.forces, XpbdForces::Paper);
  EXPECT_EQ(options.phase, HeartPhase::Diastole);
  EXPECT_EQ(options.motion_time, 0.05);
  EXPECT_EQ(options.paper.stretch, 0.2);
  EXPECT_EQ(options.paper.bending, 0.3);
  EXPECT_EQ(options.paper.area, 0.4);
  EXPECT_EQ(options.paper.tether, 0.5);
  EXPECT_EQ(options.paper.contact, 0.6);
  EXPECT_EQ(options.paper.compliance, 2e-5);
  EXPECT_EQ(options.paper.flow, 60);
  EXPECT_EQ(options.paper.pressure, 90);
  EXPECT_EQ(options.paper.tether_compliance, 3e-5);
  EXPECT_EQ(options.paper.contact_compliance, 4e-5);
  EXPECT_EQ(options.paper.rest_angle, HingeRest::Flat);
  EXPECT_EQ(options.paper.radial, 70);
  EXPECT_EQ(options.features, XpbdContactFeatures::Vertices);
  EXPECT_EQ(options.rest_move, 0.02);
}

// An empty object of the scene gives what the library has, and that is what table 1 and section 3.3 have.
TEST_F(XpbdBodyTest, HasTheNumbersOfThePaper) {
  build_with(R"({"type": "surface_tension", "tension": "1 N/mm"})");
  const XpbdOptions defaults, fallback = *parse_scene(R"({"mesh": {"file": "sheet.obj"}, "terms": [
    {"type": "surface_tension", "tension": "1 N/mm"}], "solver": {"xpbd": {"stiffness": "paper", "paper": {}}}})",
                                                      folder_.path() / "other.json")
                                              .solver.xpbd;
  EXPECT_EQ(fallback.time_step, defaults.time_step);
  EXPECT_EQ(fallback.iterations, defaults.iterations);
  EXPECT_EQ(fallback.steps, defaults.steps);
  EXPECT_EQ(fallback.damping, defaults.damping);
  EXPECT_EQ(fallback.thickness, defaults.thickness);
  EXPECT_EQ(xpbd_time_step(fallback), 0.005);
  EXPECT_EQ(fallback.iterations, 20);
  EXPECT_EQ(fallback.thickness, 0.5);
  for (const XpbdPaper& paper : {defaults.paper, fallback.paper}) {
    EXPECT_EQ(paper.stretch, 0.1);
    EXPECT_EQ(paper.bending, 0.1);
    EXPECT_EQ(paper.tether, 1);
    EXPECT_EQ(paper.area, 1);
    EXPECT_EQ(paper.contact, 1);
    EXPECT_EQ(paper.compliance, 1e-5);
    EXPECT_EQ(paper.tether_compliance, 0);   // eq. 15
    EXPECT_EQ(paper.contact_compliance, 0);  // section 3.3
    EXPECT_EQ(paper.rest_angle, HingeRest::Initial);
    EXPECT_EQ(paper.flow, 50);
    EXPECT_EQ(paper.pressure, 100);
    EXPECT_EQ(paper.radial, 0);  // eq. 16-19 know none
  }
}

// A key that is given holds against the model.
TEST_F(XpbdBodyTest, TakesTheModelOfThePaperAndWhatIsSaidBeside) {
  build_with(R"({"type": "surface_tension", "tension": "1 N/mm"})");
  const auto read = [&](const std::string& keys) {
    return *parse_scene(R"({"mesh": {"file": "sheet.obj"}, "terms": [{"type": "surface_tension",
      "tension": "1 N/mm"}], "solver": {"type": "xpbd", "xpbd": {)" +
                            keys + "}}}",
                        folder_.path() / "other.json")
                .solver.xpbd;
  };
  const XpbdOptions paper = read(R"("model": "walczak-2019")");
  EXPECT_EQ(paper.stiffness, XpbdStiffness::Paper);
  EXPECT_EQ(paper.forces, XpbdForces::Paper);
  EXPECT_EQ(paper.damping, 0);  // eq. 8-10
  EXPECT_EQ(paper.iterations, 3);
  EXPECT_EQ(paper.features, XpbdContactFeatures::Vertices);
  EXPECT_EQ(xpbd_time_step(paper), 0.005);
  EXPECT_EQ(paper.rest_move, walczak_2019().rest_move);
  EXPECT_EQ(paper.steps, walczak_2019().steps);
  const XpbdOptions other = read(R"("model": "walczak-2019", "damping": 0.05, "iterations": 20, "steps": 9,
    "stiffness": "material", "forces": "scene", "contact_features": "vertices_and_edges", "motion_time": "1 s",
    "rest_move": "1 um")");
  EXPECT_EQ(other.stiffness, XpbdStiffness::Material);
  EXPECT_EQ(other.forces, XpbdForces::Scene);
  EXPECT_EQ(other.damping, 0.05);
  EXPECT_EQ(other.iterations, 20);
  EXPECT_EQ(other.steps, 9);
  EXPECT_EQ(other.motion_time, 1);
  EXPECT_EQ(other.rest_move, 1e-3);
  EXPECT_EQ(other.features, XpbdContactFeatures::VerticesAndEdges);
  EXPECT_EQ(read("").damping, XpbdOptions{}.damping);
}

}  // namespace
}  // namespace coapt
