// Membranes of springs from the scene file to the result.
#include "core/error.hpp"
#include "energy/kernels/bending.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "results/fields.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "scene/build/masses.hpp"
#include "solve/solve_scene.hpp"
#include "support/meshes.hpp"
#include "support/spring_sheet.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <sstream>

namespace coapt {
namespace {

constexpr const char* kLinear = R"({"type": "spring", "young": "2 MPa", "thickness": "0.5 mm"})";

class SpringScene : public testing::Test {
 protected:
  // A square of 10 mm, irregular, in the regions left and right.
  SpringScene() {
    mesh_ = square(10, 64, CellPattern::Cross);
    perturb_in_plane(mesh_, 0.3, 5, [](const Vec3& X) {
      return X.head<2>().minCoeff() > 0.1 && X.head<2>().maxCoeff() < 9.9;
    });
    mesh_.region_names = {"left", "right"};
    for (const auto& t : mesh_.triangles.colwise())
      mesh_.regions.push_back(mesh_.vertices(0, t[0]) + mesh_.vertices(0, t[1]) + mesh_.vertices(0, t[2]) >
                              15);
    write_mesh(folder_.path() / "sheet.obj", mesh_);
  }

  Model model(const std::string& terms, const std::string& more = "") {
    return build(load_scene(folder_.write(
        "scene.json", R"({"mesh": {"file": "sheet.obj"}, "terms": [)" + terms +
                          R"(], "boundary": [{"nodes": "boundary", "fix": true}])" + more + "}")));
  }

  bool refuses(const std::string& terms, const std::string& part) {
    try {
      model(terms);
      std::printf("accepted\n");
    } catch (const InputError& error) {
      if (std::string(error.what()).find(part) != std::string::npos) return true;
      std::printf("said: %s\n", error.what());
    }
    return false;
  }

  // Energy of the internal terms at a stretched, shaken state.
  static double energy(const Model& model) {
    const Points x = shaken(1.15 * model.X, 0.1, 8);
    Sink sink;
    double sum = 0;
    for (const auto& term : model.objective->terms())
      if (term->role() == TermRole::Internal) sum += term->evaluate(x, sink);
    return sum;
  }

  TemporaryFolder folder_;
  TriangleMesh mesh_;
};

const ElementTerm<Spring>& springs_of(const Model& model) {
  for (const auto& term : model.objective->terms())
    if (const auto* found = dynamic_cast<const ElementTerm<Spring>*>(term.get())) return *found;
  throw std::logic_error("no springs");
}

TEST_F(SpringScene, MakesEveryEdgeOneSpringOfItsTrianglesAreas) {
  const Model built = model(kLinear);
  const ElementTerm<Spring>& springs = springs_of(built);
  const std::vector<Edge> all = edges(mesh_.triangles);
  ASSERT_EQ(springs.rest().size(), all.size());
  for (size_t k = 0; k < all.size(); ++k) {
    EXPECT_EQ(springs.stencils().nodes[2 * k], all[k].a);
    EXPECT_EQ(springs.stencils().nodes[2 * k + 1], all[k].b);
    double area = 0;
    for (const int t : all[k].triangles) area += area_vector(mesh_.vertices, mesh_.triangles.col(t)).norm();
    const double length = (mesh_.vertices.col(all[k].b) - mesh_.vertices.col(all[k].a)).norm();
    const Spring::Rest& rest = springs.rest()[k];
    EXPECT_NEAR(rest.law.young * rest.area / rest.length, 2 * 0.5 * area / (length * length), 1e-7);
    EXPECT_FALSE(rest.resists);
    EXPECT_EQ(rest.smoothing, 0.002);
  }
  EXPECT_TRUE(
      springs_of(model(R"({"type": "spring", "young": "2 MPa", "thickness": 1, "compression": "resisted"})"))
          .rest()[0]
          .resists);
}

TEST_F(SpringScene, RegionsAddUpToTheWhole) {
  const auto part = [](const char* region, const char* name) {
    return std::string(R"({"type": "spring", "young": "2 MPa", "thickness": "0.5 mm", "region": ")") +
           region + R"(", "name": ")" + name + "\"}";
  };
  const Model whole = model(kLinear), parts = model(part("left", "a") + ", " + part("right", "b"));
  EXPECT_TRUE(parts.warnings.empty());
  EXPECT_NEAR(energy(parts) / energy(whole), 1, 1e-12);
  EXPECT_GT(energy(whole), 1);
}

TEST_F(SpringScene, TakesNumbersFromTriangleToTriangle) {
  std::ostringstream numbers;
  numbers << "young_pre [MPa],thickness,transition_strain\n";
  double expected = 0;
  const Points x = shaken(1.15 * mesh_.vertices, 0.1, 8);
  for (int t = 0; t < mesh_.triangle_count(); ++t) {
    const double young = 1 + 0.1 * t, thickness = 0.5 + 0.01 * t, transition = t % 2 == 0 ? 0.1 : 0.2;
    numbers << young << "," << thickness << "," << transition << "\n";
    SpringSheet sheet = linear_springs(young, thickness);
    sheet.fibre.knee = sheet.cross.knee = {6 - young, transition, 0.005};
    sheet.resists = false;
    Sink sink;
    expected += spring_term(mesh_.vertices, mesh_.triangles.col(t), sheet)->evaluate(x, sink);
  }
  folder_.write("numbers.csv", numbers.str());
  const Model built = model(R"({"type": "spring", "young_pre": "1 MPa", "young_post": "6 MPa",
      "transition_strain": 0.1, "thickness": 1, "triangle_values": "numbers.csv"})");
  EXPECT_NEAR(energy(built) / expected, 1, 1e-6);  // the mesh file has fewer digits
  EXPECT_GT(springs_of(built).rest().size(), edges(mesh_.triangles).size());  // knees that differ stay apart
  EXPECT_NEAR(built.membrane[7].young, 1.7, 1e-12);
  EXPECT_NEAR(built.membrane[7].thickness, 0.57, 1e-12);
}

// cos^2 of the edge to the fibre, whose direction the scene gives.
TEST_F(SpringScene, MixesTheCurvesByTheDirectionOfTheFibre) {
  const Model built = model(R"({"type": "spring", "fibre_young_pre": "1 MPa", "fibre_young_post": "6 MPa",
      "fibre_transition": 0.2, "cross_young_pre": "0.25 MPa", "cross_young_post": "2 MPa",
      "cross_transition": 0.3, "thickness": 1})",
                            R"(, "fibres": {"defaults": "none",
                                "directions": [{"nodes": "boundary", "direction": [3, 4, 0]}]})");
  const ElementTerm<Spring>& springs = springs_of(built);
  ASSERT_EQ(springs.rest().size(), edges(mesh_.triangles).size());
  for (size_t k = 0; k < springs.rest().size(); ++k) {
    const Vec3 along =
        built.X.col(springs.stencils().nodes[2 * k + 1]) - built.X.col(springs.stencils().nodes[2 * k]);
    const double share = std::pow(along.normalized().dot(Vec3(0.6, 0.8, 0)), 2);
    const BlendedLine& law = springs.rest()[k].law;
    EXPECT_NEAR(law.young, share + 0.25 * (1 - share), 1e-6);
    EXPECT_NEAR(law.first.modulus, 5 * share, 1e-6);
    EXPECT_NEAR(law.second.modulus, 1.75 * (1 - share), 1e-6);
  }
  EXPECT_NEAR(built.membrane[0].young, 0.5, 1e-12);
}

TEST_F(SpringScene, GivesMassBendingAndContactWhatTheyNeed) {
  const Model built = model(std::string(kLinear) + R"(, {"type": "bending"}, {"type": "contact_barrier"})");
  EXPECT_TRUE(built.lines.empty());  // they are no chords
  EXPECT_NEAR(lumped_masses(built, 1e-9).sum(), 1e-9 * 0.5 * 100, 1e-15);
  for (const auto& term : built.objective->terms())
    if (const auto* hinges = dynamic_cast<const ElementTerm<BendingHinge>*>(term.get())) {
      const int* n = hinges->stencils().nodes.data();
      const double d = 2 * 0.125 / (12 * (1 - 1.0 / 9));
      EXPECT_NEAR(hinges->rest()[0].stiffness / BendingHinge::rest(built.X.col(n[0]), built.X.col(n[1]),
                                                                   built.X.col(n[2]), built.X.col(n[3]), d)
                                                    .stiffness,
                  1, 1e-12);
    }
  EXPECT_TRUE(built.warnings.empty());
}

// Springs have no stress, and no triangle is slack for want of it.
TEST_F(SpringScene, SaysNothingOfStress) {
  const std::string left = R"({"type": "spring", "young": "2 MPa", "thickness": 1, "region": "left"})",
                    right = R"({"type": "cst_stvk", "young": "2 MPa", "thickness": 1, "region": "right"})";
  for (const std::string& terms : {std::string(kLinear), left + ", " + right}) {
    const Scene scene = load_scene(folder_.write(
        "solve.json",
        R"({"mesh": {"file": "sheet.obj"}, "boundary": [{"nodes": "boundary", "fix": true}], "terms": [)" +
            terms + R"(, {"type": "load_pressure", "value": "1 kPa"}], "solver": {"type": "newton"}})"));
    RunOptions options;
    options.folder = folder_.path() / "out";
    const RunReport done = run(scene, scene_solvers(), options);
    EXPECT_EQ(done.report.result.status, Status::Converged) << done.report.result.message;
    EXPECT_EQ(done.report.fields.principal_stress.cols(), 0);
    EXPECT_EQ(done.report.fields.cauchy_stress.cols(), 0);
    EXPECT_TRUE(done.report.fields.regime.empty());
    EXPECT_EQ(done.report.fields.principal_strain.cols(), mesh_.triangle_count());
    EXPECT_FALSE(done.report.metrics.slack_area_mm2 || done.report.metrics.max_chord_force_n);
    const std::string json = result_json(done.model, done.report);
    const size_t count = springs_of(done.model).rest().size();
    EXPECT_NE(json.find("\"spring_elements\": " + std::to_string(count)), std::string::npos);
    EXPECT_NE(json.find("\"cable_elements\": 0"), std::string::npos);
  }
}

TEST_F(SpringScene, RefusesWhatMakesNoSense) {
  const auto spring = [](const std::string& keys) {
    return R"({"type": "spring", "thickness": 1, )" + keys + "}";
  };
  EXPECT_TRUE(refuses(R"({"type": "spring", "thickness": 1})", "young"));
  EXPECT_TRUE(refuses(R"({"type": "spring", "young": "1 MPa"})", "thickness: missing"));
  EXPECT_TRUE(refuses(spring(R"("young": "1 MPa", "young_pre": "1 MPa")"), "young_pre"));
  EXPECT_TRUE(refuses(spring(R"("young": "0 MPa")"), "young"));
  EXPECT_TRUE(refuses(spring(R"("young": "1 MPa", "poisson": 0.3)"), "unknown key"));
  EXPECT_TRUE(refuses(spring(R"("young": "1 MPa", "knee": 0.1)"), "knee: has no meaning beside young"));
  EXPECT_TRUE(refuses(spring(R"("young": "1 MPa", "transition_strain": 0.1)"),
                      "transition_strain: has no meaning without young_pre"));
  EXPECT_TRUE(refuses(spring(R"("young_pre": "1 MPa", "young_post": "2 MPa")"),
                      "transition_strain: missing; young_pre needs it"));
  EXPECT_TRUE(refuses(spring(R"("fibre_young_pre": "1 MPa")"),
                      "cross_young_post: missing; fibre_young_pre needs it"));
  EXPECT_TRUE(refuses(spring(R"("young": "1 MPa", "compression": "resisted", "smoothing": 0.01)"),
                      "smoothing: has no meaning where compression is resisted"));
  EXPECT_TRUE(
      refuses(spring(R"("young_pre": "1 MPa", "young_post": "2 MPa", "transition_strain": 0.1, "knee": 0.2)"),
              "knee: is greater than transition_strain"));
  EXPECT_TRUE(
      refuses(spring(R"("young": "1 MPa", "region": "middle")"), "the mesh has no region \"middle\""));
}

// An edge of next to no length would be a spring of next to infinite stiffness; one of none is no mesh.
TEST_F(SpringScene, RefusesEdgesOfNextToNoLength) {
  mesh_.vertices.col(1) = mesh_.vertices.col(0) + Vec3(1e-7, 0, 0);
  const auto shared = edges(mesh_.triangles);
  ASSERT_TRUE(std::any_of(shared.begin(), shared.end(), [](const Edge& e) { return e.a == 0 && e.b == 1; }));
  const auto write = [&] {
    std::ofstream out(folder_.path() / "sheet.obj");
    out.precision(17);
    for (const auto& v : mesh_.vertices.colwise()) out << "v " << v.transpose() << "\n";
    for (const auto& t : mesh_.triangles.colwise()) out << "f " << (t.array() + 1).transpose() << "\n";
  };
  write();
  EXPECT_TRUE(refuses(kLinear, "edge 1-2 of triangle 1, counted from 1"));
  mesh_.vertices.col(1) = mesh_.vertices.col(0);
  write();
  EXPECT_TRUE(refuses(kLinear, "sheet.obj"));
}

}  // namespace
}  // namespace coapt
