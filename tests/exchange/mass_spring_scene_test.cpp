// Springs in place of membranes: which numbers they take, and what they refuse.
#include "exchange/mass_spring_scene.hpp"

#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

class MassSpringTest : public testing::Test {
 protected:
  Scene scene(const std::string& terms) {
    TriangleMesh mesh = square(4, 32);
    mesh.region_names = {"left", "right"};
    for (int t = 0; t < mesh.triangle_count(); ++t) mesh.regions.push_back(t % 2);
    write_mesh(folder_.path() / "mesh.obj", mesh);
    return load_scene(folder_.write("scene.json", R"({ "mesh": { "file": "mesh.obj" },
      "boundary": [{ "nodes": "boundary", "fix": true }], "terms": [)" +
                                                      terms + "] }"));
  }

  std::string refusal(const std::string& terms) {
    const Scene membranes = scene(terms);
    try {
      mass_spring_scene(membranes);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

constexpr const char* kPressure = R"({ "type": "load_pressure", "value": "1 kPa" })";

TEST_F(MassSpringTest, KeepsAllButMembranesBendingAndSolver) {
  const Scene before = scene(std::string(R"({ "type": "cst_tension_field", "name": "sheet", "young": "2 MPa",
    "thickness": "0.3 mm", "region": "left" }, { "type": "surface_tension", "tension": "1 N/m" },
    { "type": "bending" }, )") +
                             kPressure);
  const Scene after = mass_spring_scene(before);
  ASSERT_EQ(after.terms.size(), 3U);
  EXPECT_EQ(after.terms[0].type, "spring");
  EXPECT_EQ(after.terms[0].name, "sheet");
  const Parameters& p = after.terms[0].parameters;
  EXPECT_EQ(p.where(), before.terms[0].parameters.where());
  EXPECT_EQ(p.number("young"), 2);
  EXPECT_EQ(p.number("thickness"), 0.3);
  EXPECT_EQ(p.texts("region"), std::vector<std::string>{"left"});
  EXPECT_EQ(p.text("compression"), "relaxed");
  for (const char* other : {"poisson", "prestress", "residual_stiffness", "knee"}) EXPECT_FALSE(p.has(other));
  EXPECT_EQ(after.terms[1].type, "surface_tension");
  EXPECT_EQ(after.terms[2].type, "load_pressure");
  EXPECT_EQ(after.solver.type, "mass-spring");
  EXPECT_EQ(before.solver.type, "newton");
  EXPECT_EQ(after.boundary.size(), before.boundary.size());
  EXPECT_TRUE(has_springs_alone(after));
  EXPECT_FALSE(has_springs_alone(before));
}

// Bending goes with the membrane that springs take the place of; beside springs it is the user's.
TEST_F(MassSpringTest, LeavesASceneOfSpringsAsItIs) {
  const Scene before = scene(std::string(R"({ "type": "spring", "young": "2 MPa", "thickness": "0.3 mm" },
    { "type": "bending", "stiffness": "1 mJ" }, )") +
                             kPressure);
  EXPECT_TRUE(has_springs_alone(before));
  EXPECT_EQ(mass_spring_scene(before).terms.size(), 3U);
}

TEST_F(MassSpringTest, ResistWhereTheMembraneDoes) {
  const auto compression = [&](const std::string& law) {
    return mass_spring_scene(scene("{ " + law + R"(, "thickness": "1 mm" })"))
        .terms[0]
        .parameters.text("compression");
  };
  EXPECT_EQ(compression(R"("type": "cst_stvk", "young": "1 MPa")"), "resisted");
  EXPECT_EQ(compression(R"("type": "cst_bilinear")"), "relaxed");
  EXPECT_EQ(compression(R"("type": "cst_bilinear", "compression": "resisted")"), "resisted");
}

TEST_F(MassSpringTest, KeepsBilinearAndOrthotropicCurves) {
  const Scene after = mass_spring_scene(scene(R"(
    { "type": "cst_bilinear", "thickness": "1 mm", "region": "left" },
    { "type": "cst_orthotropic", "thickness": "0.5 mm", "region": "right", "smoothing": 0.02,
      "fibre_young_pre": "0.5 MPa", "fibre_young_post": "6 MPa", "fibre_transition": 0.15,
      "cross_young_pre": "0.2 MPa", "cross_young_post": "2 MPa", "cross_transition": 0.25 })"));
  const Parameters &bilinear = after.terms[0].parameters, &orthotropic = after.terms[1].parameters;
  EXPECT_EQ(bilinear.number("young_pre"), 0.1);
  EXPECT_EQ(bilinear.number("young_post"), 6);
  EXPECT_EQ(bilinear.number("transition_strain"), 0.25);
  EXPECT_EQ(bilinear.number("knee"), 0.01);
  EXPECT_FALSE(bilinear.has("young"));
  EXPECT_FALSE(bilinear.has("smoothing")) << "it rounds the onset of a spring, not its knee";
  EXPECT_EQ(orthotropic.number("fibre_young_pre"), 0.5);
  EXPECT_EQ(orthotropic.number("fibre_young_post"), 6);
  EXPECT_EQ(orthotropic.number("fibre_transition"), 0.15);
  EXPECT_EQ(orthotropic.number("cross_young_pre"), 0.2);
  EXPECT_EQ(orthotropic.number("cross_young_post"), 2);
  EXPECT_EQ(orthotropic.number("cross_transition"), 0.25);
  EXPECT_EQ(orthotropic.number("knee"), 0.02);
  EXPECT_EQ(orthotropic.number("thickness"), 0.5);
}

TEST_F(MassSpringTest, TakesOtherLawsAtSmallStrain) {
  // Each in terms of its own: the other one covers other triangles.
  const Scene after = mass_spring_scene(scene(R"(
    { "type": "cst_neo_hookean", "shear_modulus": "0.2 MPa", "thickness": "1 mm", "region": "left" },
    { "type": "cst_exponential", "c0": "30 kPa", "c1": "1 kPa", "c2": 5, "thickness": "0.4 mm", "region": "right" })"));
  const Parameters &rubber = after.terms[0].parameters, &tissue = after.terms[1].parameters;
  EXPECT_NEAR(rubber.number("young"), 3 * 0.2, 1e-12);  // incompressible
  EXPECT_EQ(rubber.number("thickness"), 1);
  EXPECT_EQ(rubber.texts("region"), std::vector<std::string>{"left"});
  EXPECT_NEAR(tissue.number("young"), 3 * 0.03, 1e-12);
  EXPECT_EQ(tissue.number("thickness"), 0.4);
}

TEST_F(MassSpringTest, CarriesFilesOfNumbers) {
  std::string table = "thickness [mm]\n";
  for (int t = 0; t < 32; ++t) table += std::to_string(1 + t % 2) + "\n";
  folder_.write("values.csv", table);
  const std::string values = R"(, "triangle_values": "values.csv" })";
  const Scene after =
      mass_spring_scene(scene(R"({ "type": "cst_stvk", "young": "1 MPa", "thickness": "1 mm")" + values));
  EXPECT_EQ(std::filesystem::path(after.terms[0].parameters.text("triangle_values")).filename(),
            "values.csv");
  const std::string differs =
      refusal(R"({ "type": "cst_neo_hookean", "shear_modulus": "1 MPa", "thickness": "1 mm")" + values);
  EXPECT_NE(differs.find("terms[0]: the numbers of cst_neo_hookean differ"), std::string::npos) << differs;
  folder_.write("values.csv", "smoothing\n");
  const std::string window = refusal(R"({ "type": "cst_bilinear", "thickness": "1 mm")" + values);
  EXPECT_NE(window.find("terms[0].triangle_values"), std::string::npos) << window;
  EXPECT_NE(window.find("smoothing"), std::string::npos) << window;
}

TEST_F(MassSpringTest, RefusesWhatSpringsCannotBe) {
  EXPECT_NE(refusal(kPressure).find("no membrane"), std::string::npos);
  const std::string stressed =
      refusal(R"({ "type": "cst_stvk", "young": "1 MPa", "thickness": "1 mm", "prestress": "1 N/m" },
                 { "type": "cst_stvk", "name": "film", "young": 0, "prestress": "1 N/m" })");
  EXPECT_NE(stressed.find("terms[0].prestress"), std::string::npos) << stressed;
  EXPECT_NE(stressed.find("terms[1].prestress"), std::string::npos) << "all in one pass";
}

}  // namespace
}  // namespace coapt
