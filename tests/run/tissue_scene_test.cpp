// Nonlinear and fibrous tissue from the scene file to the closed valve; numbers that differ from triangle to
// triangle; what a scene must not say.
#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/cable_law.hpp"
#include "energy/kernels/cst_fibrous.hpp"
#include "energy/kernels/cst_isotropic.hpp"
#include "exchange/import.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "results/result_warnings.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <stdexcept>

namespace coapt {
namespace {

// Puts `replacement` in the place of the object that begins with `start`.
std::string with_term(std::string scene, const std::string& start, const std::string& replacement) {
  const size_t from = scene.find(start);
  if (from == std::string::npos) return "";
  return scene.replace(from, scene.find('}', from) + 1 - from, replacement);
}

struct Tissue {
  const char *name, *term;
};

void PrintTo(const Tissue& tissue, std::ostream* out) { *out << tissue.name; }

// Tissues of about the default membrane's stiffness under its pressure, so that the valve closes.
constexpr Tissue kTissues[] = {
    {"bilinear", R"({"type": "cst_bilinear", "young_pre": "0.3 MPa", "young_post": "6 MPa",
       "transition_strain": 0.2, "thickness": "0.65 mm"})"},
    {"stiffens a thousandfold", R"({"type": "cst_bilinear", "young_pre": "0.1 MPa", "young_post": "100 MPa",
       "transition_strain": 0.1, "thickness": "0.65 mm"})"},
    {"neo-Hookean", R"({"type": "cst_neo_hookean", "shear_modulus": "0.33 MPa", "thickness": "0.65 mm"})"},
    {"slightly compressible", R"({"type": "cst_exponential", "c0": "0.1 MPa", "c1": "0.02 MPa", "c2": 4,
       "bulk": "20 MPa", "thickness": "0.65 mm"})"},
    {"exponential", R"({"type": "cst_exponential", "c0": "0.02 MPa", "c1": "0.02 MPa", "c2": 8,
       "thickness": "0.65 mm"})"},
    {"orthotropic", R"({"type": "cst_orthotropic", "fibre_young_pre": "0.5 MPa", "fibre_young_post": "6 MPa",
       "fibre_transition": 0.15, "cross_young_pre": "0.2 MPa", "cross_young_post": "2 MPa",
       "cross_transition": 0.25, "thickness": "0.65 mm"})"},
    {"May-Newman-Yin", R"({"type": "cst_may_newman_yin", "thickness": "0.65 mm"})"},
    {"crimped fibre", R"({"type": "cst_crimped_fibre", "crimp_ratio": 12, "radius_ratio": 1.6, "splay": 0.3,
       "thickness": "0.65 mm"})"}};

class TissueValve : public testing::TestWithParam<Tissue> {};

// Stress row S4 among them: a modulus that rises a thousandfold.
TEST_P(TissueValve, Closes) {
  const TemporaryFolder folder;
  MitralOptions valve;
  valve.preset = MitralPreset::Benchmark;
  valve.triangles = 400;
  write_valve_scene(mitral_valve(valve), folder.path());
  const std::string text =
      with_term(text_of(folder.path() / "scene.json"), "{ \"type\": \"cst_tension_field\"", GetParam().term);
  const Scene scene = load_scene(folder.write("tissue.json", text));
  RunOptions options;
  options.writes = false;
  const RunReport report = run(scene, scene_solvers(), options);
  const Result& result = report.report.result;
  std::printf("%s: %d iterations, residual %.1e, orifice %.1f mm2\n", GetParam().name, result.iterations,
              result.residual, report.report.metrics.orifice_area_mm2.value_or(-1));
  EXPECT_EQ(result.status, Status::Converged) << result.message;
  EXPECT_LE(result.residual, 1e-8);
  EXPECT_LT(result.certificate.balance.force, 1e-8);
}

INSTANTIATE_TEST_SUITE_P(Laws, TissueValve, testing::ValuesIn(kTissues),
                         [](const auto& instance) { return std::to_string(instance.index); });

template <typename Kernel>
const std::vector<typename Kernel::Rest>& elements_of(const Model& model) {
  for (const auto& term : model.objective->terms())
    if (const auto* found = dynamic_cast<const ElementTerm<Kernel>*>(term.get())) return found->rest();
  throw std::logic_error("no such term");
}

class TissueScene : public testing::Test {
 protected:
  TissueScene() {
    mesh_ = square(10, 32, CellPattern::Cross);
    write_mesh(folder_.path() / "sheet.obj", mesh_);
  }

  Scene scene(const std::string& terms) {
    return load_scene(folder_.write("scene.json", R"({"mesh": {"file": "sheet.obj"},
      "boundary": [{"nodes": "boundary", "fix": true}], "terms": [)" +
                                                      terms +
                                                      R"(, {"type": "load_pressure", "value": "1 kPa"}]})"));
  }

  std::vector<std::string> defects(const std::string& terms) {
    try {
      build(scene(terms));
    } catch (const InputError& error) {
      return error.defects();
    }
    return {};
  }

  bool refuses(const std::string& terms, const std::string& part) {
    const std::vector<std::string> all = defects(terms);
    const bool found = std::any_of(all.begin(), all.end(), [&](const std::string& text) {
      return text.find(part) != std::string::npos;
    });
    if (!found)
      for (const std::string& text : all) std::printf("said: %s\n", text.c_str());
    return found;
  }

  std::string column(const std::string& heading, int rows, const std::function<double(int)>& value) {
    std::ostringstream text;
    text.precision(17);
    text << heading << "\n# a remark\n";
    for (int k = 0; k < rows; ++k) text << value(k) << "\n";
    return text.str();
  }

  TemporaryFolder folder_;
  TriangleMesh mesh_;
};

TEST_F(TissueScene, TakesNumbersFromTriangleToTriangle) {
  folder_.write("stiff.csv",
                column("shear_modulus [kPa]", mesh_.triangle_count(), [](int t) { return 100 + t; }));
  folder_.write("thick.csv", column("thickness", mesh_.vertex_count(),
                                    [&](int v) { return 1 + 0.1 * mesh_.vertices(0, v); }));
  const Model model =
      build(scene(R"({"type": "cst_neo_hookean", "shear_modulus": "1 MPa", "thickness": "1 mm",
      "triangle_values": "stiff.csv", "vertex_values": "thick.csv"}, {"type": "bending"})"));
  const auto& elements = elements_of<CstNeoHookean>(model);
  for (int t = 0; t < mesh_.triangle_count(); ++t) {
    const Eigen::Vector3i c = mesh_.triangles.col(t);
    const double x = (mesh_.vertices(0, c[0]) + mesh_.vertices(0, c[1]) + mesh_.vertices(0, c[2])) / 3;
    const auto& rest = elements[static_cast<size_t>(t)];
    EXPECT_NEAR(rest.law.invariant.shear_modulus, 1e-3 * (100 + t), 1e-12);
    EXPECT_NEAR(rest.volume / area_vector(mesh_.vertices, c).norm(), 1 + 0.1 * x, 1e-9);
    EXPECT_NEAR(model.membrane[static_cast<size_t>(t)].young, 3e-3 * (100 + t), 1e-12);
  }
}

TEST_F(TissueScene, NamesWhatIsWrongWithAFileOfNumbers) {
  const auto term = [](const std::string& file) {
    return R"({"type": "cst_neo_hookean", "shear_modulus": "1 MPa", "thickness": "1 mm", "triangle_values": ")" +
           file + "\"}";
  };
  const int count = mesh_.triangle_count();
  folder_.write("unit.csv", column("shear_modulus", count, [](int) { return 1; }));
  EXPECT_TRUE(refuses(term("unit.csv"), "unit.csv: line 1: shear_modulus has no unit"));
  folder_.write("key.csv", column("sheer_modulus [MPa]", count, [](int) { return 1; }));
  EXPECT_TRUE(refuses(term("key.csv"), "did you mean \"shear_modulus\""));
  folder_.write("short.csv", column("shear_modulus [MPa]", count - 1, [](int) { return 1; }));
  EXPECT_TRUE(refuses(term("short.csv"), "the mesh has " + std::to_string(count) + " triangles"));
  folder_.write("negative.csv", column("shear_modulus [MPa]", count, [](int t) { return t == 3 ? -1 : 1; }));
  EXPECT_TRUE(refuses(term("negative.csv"), "line 6: shear_modulus: -1 is outside its limits"));
  folder_.write("nan.csv", "shear_modulus [MPa]\nnan\n");
  EXPECT_TRUE(refuses(term("nan.csv"), "nan.csv: line 2"));
  folder_.write("empty.csv", "# nothing\n");
  EXPECT_TRUE(refuses(term("empty.csv"), "is empty"));
  folder_.write("wide.csv", "thickness,shear_modulus [MPa]\n1\n");
  EXPECT_TRUE(refuses(term("wide.csv"), "has 1 numbers; the first line names 2"));
}

TEST_F(TissueScene, RefusesLawsThatMakeNoSense) {
  const std::string sheet = R"({"type": "cst_neo_hookean", "shear_modulus": "1 MPa", "thickness": "1 mm"},)";
  EXPECT_TRUE(
      refuses(R"({"type": "cst_bilinear", "thickness": "1 mm", "smoothing": 0.3})", "smoothing: is greater"));
  EXPECT_TRUE(refuses(R"({"type": "cst_exponential", "c0": "1 MPa", "c1": "1 MPa", "thickness": "1 mm"})",
                      "c2: missing"));
  EXPECT_TRUE(
      refuses(sheet + R"({"type": "cable_ogden", "edges": "boundary", "mu": ["1 MPa"], "alpha": [9]})",
              "area: missing"));
  EXPECT_TRUE(refuses(sheet + R"({"type": "cable", "edges": "boundary", "tension": "1 N", "area": "1 mm^2"})",
                      "area: says nothing of a cable of constant tension"));
  EXPECT_TRUE(
      refuses(sheet + R"({"type": "cable", "edges": "boundary", "tension": "1 N", "materials": ["a"]})",
              "materials: chooses chords of a network"));
  EXPECT_TRUE(refuses(sheet + R"({"type": "cable_ogden", "edges": "boundary", "area": "1 mm^2",
      "mu": ["1 MPa", "2 MPa"], "alpha": [9]})",
                      "mu and alpha: have 2 and 1 entries"));
  EXPECT_TRUE(refuses(sheet + R"({"type": "cable_ogden", "edges": "boundary", "area": "1 mm^2",
      "mu": ["-1 MPa"], "alpha": [-9]})",
                      "the cable would push"));
  EXPECT_TRUE(refuses(sheet + R"({"type": "cable_bilinear", "edges": "boundary", "area": "1 mm^2",
      "young_pre": "1 MPa", "young_post": "2 MPa", "transition_strain": 0.001})",
                      "knee: is greater"));
}

TEST_F(TissueScene, TakesAllThatCrimpedFibresMayBe) {
  const std::string fibres = R"({"type": "cst_crimped_fibre", "crimp_ratio": 9, "radius_ratio": 1.6,
      "thickness": "0.5 mm", "splay": 0.3, "splay_out_of_plane": 0.2, "second_population": 0.4,
      "second_angle": "60 deg", "active_stress": "30 kPa", "yield_strain": 0.05, "failure": 0.5,
      "rest_scale_fibre": 1.1, "rest_scale_cross": 0.9})";
  const std::string chords = R"(, {"type": "cable_crimped_fibre", "edges": "boundary", "area": "1 mm^2",
      "fibre_young": "40 MPa", "crimp_ratio": 20, "radius_ratio": 1.6, "yield_strain": 0.02})";
  const Model model = build(scene(fibres + chords));
  const auto& rest = elements_of<CstCrimpedFibre>(model)[0];
  EXPECT_EQ(rest.law.splay_out_of_plane, 0.2);
  EXPECT_EQ(rest.law.second_population, 0.4);
  EXPECT_NEAR(rest.law.second_angle, std::acos(0.5), 1e-12);
  EXPECT_DOUBLE_EQ(rest.law.active_stress, 0.03);
  EXPECT_NEAR(rest.law.fibre.yield_elongation(), rest.law.fibre.limit() * 1.05 - 1, 1e-12);
  EXPECT_EQ(rest.rest_scale, Eigen::Vector2d(1.1, 0.9));
  const double line_yield = elements_of<CableCrimpedFibre>(model)[0].law.yield_elongation();
  EXPECT_EQ(model.lines[0].yield_strain, line_yield);
  EXPECT_LT(line_yield, 0.1);
  // Drawn out by a fifth the sheet is within its yield, and its edges are beyond theirs: named, not only
  // counted.
  Report report;
  report.fields = compute_fields(model, 1.2 * model.X);
  report.metrics = measure(model, model.q0, report.fields);
  EXPECT_EQ(report.metrics.yielded_facets.value(), 0);
  EXPECT_EQ(report.metrics.yielded_chords.value(), std::ssize(model.lines));
  EXPECT_NEAR(report.metrics.max_chord_yield_ratio.value(), 0.2 / line_yield, 1e-9);
  EXPECT_GT(report.metrics.max_yield_ratio.value(), 0.1);
  const std::string warning = yield_warning(report.fields);
  EXPECT_NE(warning.find("beyond their yield: "), std::string::npos) << warning;
  EXPECT_NE(warning.find("chords (0, 1, 2"), std::string::npos) << warning;
  EXPECT_TRUE(stretch_warning(compute_fields(model, 1.19 * model.X)).empty());
  const std::string lines = stretch_warning(compute_fields(model, 1.25 * model.X));
  EXPECT_EQ(lines.find("facets"), std::string::npos) << lines;
  EXPECT_NE(lines.find("chords and cables (0, 1, 2"), std::string::npos) << lines;
  EXPECT_NE(lines.find("the most by 25 %"), std::string::npos) << lines;
  const std::string both = stretch_warning(compute_fields(model, 2.5 * model.X));
  EXPECT_NE(both.find("facets (0, 1"), std::string::npos) << both;
  EXPECT_NE(both.find("the most by 150 %"), std::string::npos) << both;
  EXPECT_TRUE(refuses(R"({"type": "cst_crimped_fibre", "crimp_ratio": 9, "radius_ratio": 1.6,
      "thickness": "0.5 mm", "failure": 0.5})",
                      "failure: says nothing without yield_strain"));
  const Model plain = build(scene(R"({"type": "cst_crimped_fibre", "crimp_ratio": 9, "radius_ratio": 1.6,
      "thickness": "0.5 mm"})"));
  EXPECT_EQ(compute_fields(plain, plain.X).yield_ratio.size(), 0);
}

TEST_F(TissueScene, BuildsCablesOfEveryLaw) {
  const Model model =
      build(scene(R"({"type": "cst_neo_hookean", "shear_modulus": "1 MPa", "thickness": "1 mm"},
    {"type": "cable_ogden", "edges": "boundary", "area": "1 mm^2", "mu": ["1 MPa", "2 MPa"], "alpha": [9, 20]},
    {"type": "cable_bilinear", "edges": "boundary", "area": "1 mm^2", "young_pre": "1 MPa",
     "young_post": "5 MPa", "transition_strain": 0.1},
    {"type": "cable_crimped_fibre", "edges": "boundary", "area": "1 mm^2", "fibre_young": "40 MPa",
     "crimp_ratio": 20, "radius_ratio": 1.6, "shear_modulus": "10 kPa"})"));
  const size_t rim = model.sets.at("boundary").size();
  EXPECT_EQ(model.lines.size(), 3 * rim);
  const auto& ogden = elements_of<CableOgden>(model);
  EXPECT_EQ(ogden[0].law.mu[1], 2);
  EXPECT_EQ(ogden[0].law.alpha[2], 0);
  EXPECT_DOUBLE_EQ(elements_of<CableCrimpedFibre>(model)[0].law.shear_modulus, 0.01);
}

}  // namespace
}  // namespace coapt
