// Tuning the stiffness of regions where the plain case of the command's tests ends: leaflets in contact, and
// leaflets of tissue.
#include "tuning/region_tuning.hpp"

#include "core/error.hpp"
#include "exchange/import.hpp"
#include "scene/build/build.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"
#include "tuning/detail/region_factors.hpp"
#include "tuning/detail/yield_excess.hpp"
#include "tuning/tuned_scene.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <sstream>

namespace coapt {
namespace {

class RegionTuningTest : public testing::Test {
 protected:
  RegionTuningTest() { options_.regions = 0; }

  Scene scene(const std::string& contact, const std::string& membrane = "") {
    ImportOptions import;
    import.contact = contact;
    write_valve_scene(mitral_valve({.triangles = 250, .preset = MitralPreset::Benchmark}), folder_.path(),
                      import);
    std::stringstream file;
    file << std::ifstream(folder_.path() / "scene.json").rdbuf();
    std::string text = file.str();
    const size_t from = text.find("{ \"type\": \"cst_tension_field\"");
    if (!membrane.empty()) text.replace(from, text.find('}', from) + 1 - from, membrane);
    return load_scene(folder_.write("tuned.json", text));
  }

  // Tunes the scene, and solves it anew from its own start with the factors that were found.
  void expect_tuned(const Scene& scene, double yield) {
    options_.yield_strain = yield;
    const RegionTuning found = tune_regions(scene, scene_solvers(), options_, {});
    std::printf("%s: strain %.4f to %.4f, %d chords beyond yield at first, %d solves (%d failed), %.2f s\n",
                found.message.c_str(), found.before.max_chord_strain, found.after.max_chord_strain,
                found.before.strained_chords, found.solves, found.failed_solves, found.wall_s);
    ASSERT_TRUE(found.is_reached) << found.message;
    EXPECT_GT(found.rounds, 0) << "there was nothing to tune";
    EXPECT_EQ(found.after.strained_chords, 0);
    EXPECT_LE(found.after.max_chord_strain, yield);
    ASSERT_TRUE(found.after.orifice_area_mm2 && found.orifice_limit_mm2);
    EXPECT_LE(*found.after.orifice_area_mm2, *found.orifice_limit_mm2);

    const TunedScene tuned(scene, scene_geometry(scene), options_);
    Vector factors(tuned.factor_count());
    for (size_t k = 0; k < found.regions.size(); ++k)
      factors[static_cast<Eigen::Index>(k)] = found.regions[k].factor;
    EXPECT_GT((factors.array() - 1).abs().maxCoeff(), 0.01);
    const Scene anew = tuned.scene(factors);
    Model model = build(anew, tuned.geometry);
    const Result result =
        solve_scene(anew, tuned.geometry, model, solve_setup(anew, scene_solvers(), {})).result;
    ASSERT_EQ(result.status, Status::Converged) << result.message;
    const Points x = model.objective->positions(result.q);
    double most = 0;
    for (const Line& line : model.lines)
      most = std::max(most, (x.col(line.a) - x.col(line.b)).norm() / line.rest_length - 1);
    EXPECT_LE(most, yield);
    EXPECT_EQ(measure(model, result.q, compute_fields(model, x)).intersections, 0);
  }

  TemporaryFolder folder_;
  RegionTuningOptions options_;
};

TEST_F(RegionTuningTest, DerivativesByFactorsAreThoseOfSolvedShapes) {
  options_.tunes_chords = true;
  const Scene valve = scene("none");
  const TunedScene tuned(valve, scene_geometry(valve), options_);
  const Scene split = tuned.scene(Vector::Ones(tuned.factor_count()));
  Model model = build(split, tuned.geometry);
  const Result first =
      solve_scene(split, tuned.geometry, model, solve_setup(split, scene_solvers(), {})).result;
  ASSERT_EQ(first.status, Status::Converged);

  TrackingOptions tracking;
  tracking.tolerance = 1e-11;
  tracking.checks_branch = false;
  const EquilibriumMaker make = region_factor_maker(tuned, model, tracking);
  const auto equilibrium = make(first.q);
  ASSERT_EQ(equilibrium->number_count(), 3);  // anterior, posterior, sections
  const YieldExcess excess(model, 0.02, 2);
  const Points x = equilibrium->positions();
  const Vector at = equilibrium->value(), values = excess.values(x),
               weights = Vector::LinSpaced(values.size(), 1, 2);
  EXPECT_GT(values.maxCoeff(), 0);
  EXPECT_GT(values[values.size() - 1], 0) << "the orifice is within its limit";
  for (Eigen::Index k = 0; k < 3; ++k) {
    equilibrium->set(at);
    ASSERT_EQ(equilibrium->solve().status, Status::Converged);
    const Points motion = equilibrium->response(Vector::Unit(3, k));
    const Vector derived = excess.derivatives(x, {motion}).col(0);
    EXPECT_NEAR(excess.pull_back(x, weights).cwiseProduct(motion).sum(), weights.dot(derived),
                1e-9 * derived.norm());
    const double h = 1e-3;
    std::vector<Points> shapes;
    for (const double sign : {-1.0, 1.0}) {
      equilibrium->set(at + sign * h * Vector::Unit(3, k));
      ASSERT_EQ(equilibrium->solve().status, Status::Converged);
      shapes.push_back(equilibrium->positions());
    }
    const Points difference = (shapes[1] - shapes[0]) / (2 * h);
    Points error = motion - difference;
    for (const int node : first.certificate.free_nodes) error.col(node).setZero();  // anywhere is their place
    EXPECT_LT(error.norm(), 2e-3 * difference.norm()) << "factor " << k;
    const Vector of_values = (excess.values(shapes[1]) - excess.values(shapes[0])) / (2 * h);
    EXPECT_LT((derived - of_values).norm(), 1e-2 * of_values.norm()) << "factor " << k;
  }

  // Made again, it begins where it began.
  const auto again = make(first.q);
  EXPECT_EQ(again->value(), at);
  ASSERT_EQ(again->solve().status, Status::Converged);
  EXPECT_LT((again->positions() - x).norm(), 1e-6 * x.norm());
}

TEST_F(RegionTuningTest, SparesTheChordsOfAValveInContact) {
  const Scene valve = scene("barrier");
  ASSERT_TRUE(std::any_of(valve.terms.begin(), valve.terms.end(),
                          [](const TermSpec& term) { return term.type == "contact_barrier"; }));
  expect_tuned(valve, 0.1);
}

TEST_F(RegionTuningTest, SparesTheChordsOfLeafletsOfTissueInContact) {
  expect_tuned(scene("barrier", R"({"type": "cst_exponential", "name": "leaflets", "c0": "0.1 MPa",
      "c1": "0.02 MPa", "c2": 4, "thickness": "0.65 mm"})"),
               0.08);
}

// Leaflets and chords of crimped fibres, each with a yield of its own.
TEST_F(RegionTuningTest, SparesLeafletsAndChordsByTheirOwnYield) {
  const Scene valve = scene("none", R"({"type": "cst_crimped_fibre", "name": "leaflets", "crimp_ratio": 8.3,
      "radius_ratio": 1.75, "fibre_young": "2 MPa", "shear_modulus": "50 kPa", "splay": 0.5,
      "second_population": 0.5, "thickness": "0.65 mm", "yield_strain": 0.03})");
  EXPECT_THROW((void)tune_regions(scene("none"), scene_solvers(), options_, {}), InputError);
  const RegionTuning found = tune_regions(valve, scene_solvers(), options_, {});
  std::printf("%s: %.3f of the yield to %.3f, %d facets beyond it at first, %d solves, %.2f s\n",
              found.message.c_str(), found.before.max_yield_ratio, found.after.max_yield_ratio,
              found.before.strained_facets, found.solves, found.wall_s);
  EXPECT_GT(found.before.strained_facets, 0);
  ASSERT_TRUE(found.is_reached) << found.message;
  EXPECT_EQ(found.after.strained_facets, 0);
  EXPECT_LE(found.after.max_yield_ratio, 1);
}

TEST_F(RegionTuningTest, DerivativesOfTheExcessOfFacetsAreExact) {
  const Scene valve = scene("none", R"({"type": "cst_crimped_fibre", "name": "leaflets", "crimp_ratio": 8.3,
      "radius_ratio": 1.75, "splay": 0.5, "second_population": 0.5, "thickness": "0.65 mm", "yield_strain": 0.03})");
  const Model model = build(valve, scene_geometry(valve));
  const YieldExcess excess(model, std::nullopt, std::nullopt);
  std::srand(3);
  const Points x = 1.6 * model.X + 0.05 * Points::Random(3, model.X.cols()),
               motion = Points::Random(3, model.X.cols());
  const Vector derived = excess.derivatives(x, {motion}).col(0);
  EXPECT_GT(derived.norm(), 1);
  const auto at = [&](double by) { return excess.values(x + by * 1e-5 * motion); };
  EXPECT_LT((derived - (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / 12e-5).norm(), 1e-6 * derived.norm());
  const Vector weights = Vector::LinSpaced(derived.size(), 1, 2);
  EXPECT_NEAR(excess.pull_back(x, weights).cwiseProduct(motion).sum(), weights.dot(derived),
              1e-9 * derived.norm());
}

}  // namespace
}  // namespace coapt
