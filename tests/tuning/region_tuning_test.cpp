// Tuning the stiffness of regions where the plain case of the command's tests ends: leaflets in contact, and
// leaflets of tissue.
#include "tuning/region_tuning.hpp"

#include "exchange/import.hpp"
#include "scene/build/build.hpp"
#include "solve/solve_scene.hpp"
#include "support/temporary_folder.hpp"
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
    write_valve_scene(mitral_valve({.triangles = 250}), folder_.path(), import);
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

    const TunedScene tuned(scene, lay_groundwork(scene), options_);
    Vector factors(tuned.factor_count());
    for (size_t k = 0; k < found.regions.size(); ++k)
      factors[static_cast<Eigen::Index>(k)] = found.regions[k].factor;
    EXPECT_GT((factors.array() - 1).abs().maxCoeff(), 0.01);
    const Scene anew = tuned.scene(factors);
    Model model = build(anew, tuned.ground);
    const Result result =
        solve_scene(anew, tuned.ground, model, solve_setup(anew, scene_solvers(), {})).result;
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

}  // namespace
}  // namespace coapt
