// Tuning the chords of a scene: known lengths recovered, methods against each other, what is refused.
#include "tuning/chord_tuning.hpp"

#include "core/error.hpp"
#include "exchange/import.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/shapes.hpp"
#include "results/reference/reference_distance.hpp"
#include "scene/file/scene_text.hpp"
#include "solve/solve_scene.hpp"
#include "support/minimisers.hpp"
#include "support/temporary_folder.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <set>
#include <sstream>

namespace coapt {
namespace {

namespace fs = std::filesystem;

class ChordTuningTest : public testing::Test {
 protected:
  ChordTuningTest() {
    ImportOptions import;
    import.tolerance = 1e-9;
    const auto valve = mitral_valve({.triangles = 250, .preset = MitralPreset::Benchmark});
    network_ = valve.chords;
    write_valve_scene(valve, folder_.path(), import);
    run_.writes_page = false;
    run_.folder = folder_.path() / "out";
  }

  static std::string factor_of(const std::vector<size_t>& chords, double factor) {
    std::ostringstream text;
    text.precision(17);
    text << R"({"type": "chord_length", "chords": [)";
    for (size_t k = 0; k < chords.size(); ++k) text << (k > 0 ? ", " : "") << chords[k];
    text << R"(], "factor": )" << factor << "}";
    return text.str();
  }

  // Trunk and branches of all chords from a tip: junctions branch once.
  std::string tree_of(int tip, double factor) const {
    std::vector<size_t> chords;
    std::set<int> junctions;
    for (size_t k = 0; k < network_.chords.size(); ++k) {
      const Chord& chord = network_.chords[k];
      const bool is_trunk = chord.from.kind == ChordEnd::Kind::Papillary && chord.from.index == tip;
      if (is_trunk) junctions.insert(chord.to.index);
      if (is_trunk || (chord.from.kind == ChordEnd::Kind::Junction && junctions.contains(chord.from.index)))
        chords.push_back(k);
    }
    return factor_of(chords, factor);
  }
  std::vector<std::string> two_tips() const { return {tree_of(0, 0.94), tree_of(1, 1.03)}; }

  fs::path scene() const { return folder_.path() / "scene.json"; }

  // The closed surface of the scene with these interventions, as a file.
  fs::path target(const std::vector<std::string>& edits) {
    const std::string text = with_interventions(scene_text(scene()), edits, "scene.json");
    RunOptions options;
    options.writes = false;
    const RunReport solved = run(parse_scene(text, scene()), scene_solvers(), options);
    EXPECT_EQ(solved.report.result.status, Status::Converged);
    TriangleMesh surface = surface_at(solved.model, solved.report.fields.x);
    surface.vertices.colwise() += solved.model.origin;
    write_mesh(folder_.path() / "target.obj", surface);
    return folder_.path() / "target.obj";
  }

  ChordTuning tuned(const ChordTuningOptions& options) {
    ChordTuning found = tune_chords(scene(), scene_solvers(), minimisers(), options, run_);
    std::printf("%s %s: rms %.2e to %.2e mm, %d solves (%d rejected, %d lost), %.2f s\n",
                found.method.c_str(), found.tuning.message.c_str(), found.misfit_before(),
                found.misfit_after(), found.solves, found.tuning.failed, found.tuning.lost_branches,
                found.seconds);
    return found;
  }

  std::string refusal(const ChordTuningOptions& options) {
    try {
      tuned(options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  ChordNetwork network_;
  TemporaryFolder folder_;
  RunOptions run_;
};

// Trunks by themselves, half of them shortened by up to 20 %: what is called determined is found, though some
// are slack at first and no gradient tells that they should be shorter. Trunk and branches together are known
// by their sums alone.
TEST_F(ChordTuningTest, RecoversWhatTheTargetDetermines) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> least(0.8, 1);
  std::vector<double> truth;
  std::vector<std::string> edits;
  ChordTuningOptions options;
  for (size_t k = 0; k < network_.chords.size(); ++k) {
    if (network_.chords[k].from.kind != ChordEnd::Kind::Papillary) continue;
    truth.push_back(random() % 2 == 0 ? least(random) : 1);
    options.only.push_back("chords[" + std::to_string(k) + "]");
    if (truth.back() != 1) edits.push_back(factor_of({k}, truth.back()));
  }
  options.target = target(edits);
  options.noise = 0.02;
  options.change_weight = 0;
  const ChordTuning found = tuned(options);
  ASSERT_EQ(found.lengths.size(), truth.size());
  EXPECT_LE(found.solves, 40);
  EXPECT_TRUE(found.is_explained);
  EXPECT_LT(found.misfit_after(), 0.001 * found.misfit_before());
  int determined = 0;
  for (size_t k = 0; k < truth.size(); ++k) {
    const TunedLength& length = found.lengths[k];
    EXPECT_EQ(length.name, options.only[k]);
    EXPECT_GE(length.after, length.low * (1 - 1e-12));
    EXPECT_LE(length.after, length.high * (1 + 1e-12));
    if (!length.is_determined) continue;
    ++determined;
    EXPECT_NEAR(length.after, truth[k] * length.before, 0.005) << length.name << " +- " << length.deviation;
    EXPECT_GT(length.extension, length.deviation);
  }
  EXPECT_GT(determined, 10);
  EXPECT_LT(determined, static_cast<int>(truth.size()));
  // The springs that drew the leaflets to the target have no part in what is found.
  const std::vector<TuningTrial>& history = found.tuning.best.history;
  const auto aided =
      std::count_if(history.begin(), history.end(), [](const auto& trial) { return trial.is_aided; });
  EXPECT_GT(aided, 0);
  EXPECT_FALSE(history.front().is_aided);
  EXPECT_FALSE(history.back().is_aided);
  ASSERT_TRUE(found.after);
  EXPECT_EQ(found.after->report.result.status, Status::Converged);

  // Without them it may be trapped; what it calls determined then still holds.
  options.is_direct = true;
  const ChordTuning direct = tuned(options);
  for (const TuningTrial& trial : direct.tuning.best.history) EXPECT_FALSE(trial.is_aided);
  for (size_t k = 0; k < truth.size(); ++k)
    if (direct.lengths[k].is_determined) {
      EXPECT_NEAR(direct.lengths[k].after, truth[k] * direct.lengths[k].before, 0.05);
    }
}

// Cut while the leaflets are drawn to the target, it begins that anew.
TEST_F(ChordTuningTest, GoesOnFromTheWayToTheTarget) {
  ChordTuningOptions options;
  std::vector<std::string> edits;
  for (size_t k = 0; k < network_.chords.size(); ++k)
    if (network_.chords[k].from.kind == ChordEnd::Kind::Papillary) {
      options.only.push_back("chords[" + std::to_string(k) + "]");
      if (k % 3 == 0) edits.push_back(factor_of({k}, 0.9));
    }
  options.target = target(edits);
  options.max_solves = 5;
  ChordTuningRecord kept;
  options.keep = [&](const ChordTuningRecord& record) { kept = record; };
  const ChordTuning cut = tuned(options);
  EXPECT_EQ(cut.tuning.status, TuningStatus::SolveLimit);
  EXPECT_TRUE(cut.tuning.best.history.back().is_aided);
  EXPECT_EQ(cut.tuning.best.value, Vector::Ones(cut.tuning.best.value.size()));
  EXPECT_EQ(cut.solves, 6);  // the last one of the lengths as they were
  kept.tuning = cut.tuning.best;

  const fs::path file = folder_.path() / "tuning.checkpoint";
  const auto identity = chord_tuning_identity(load_scene(scene()), options, run_);
  write_chord_tuning_checkpoint(file, identity, kept);
  const ChordTuningRecord known = read_chord_tuning_checkpoint(file, identity);
  options.keep = {};
  options.max_solves = 60;
  options.known = &known;
  const ChordTuning resumed = tuned(options);
  EXPECT_TRUE(resumed.has_converged());
  EXPECT_LT(resumed.misfit_after(), 0.01 * resumed.misfit_before());
  EXPECT_LE(resumed.solves, 45);
}

// Each by itself: no springs draw the leaflets to the target, whose lengths Gauss-Newton would fit, and no
// group is slack, so that there is nothing to take up where a method ends.
TEST_F(ChordTuningTest, EveryMethodReachesTheSameFit) {
  ChordTuningOptions options;
  options.target = target(two_tips());
  options.grouping = ChordGrouping::Tip;
  options.only = {"tip_0", "tip_1"};
  options.change_weight = 0;
  options.is_direct = true;
  for (const auto& [name, make] : minimisers()) {
    SCOPED_TRACE(name);
    options.method = name;
    const ChordTuning found = tuned(options);
    EXPECT_EQ(found.method, name);
    EXPECT_TRUE(found.has_converged()) << found.tuning.message;
    for (const TuningTrial& trial : found.tuning.best.history) EXPECT_FALSE(trial.is_aided);
    // Below the least step a fit counts as reached; COBYLA, which ends by its steps, leaves a seventh of it.
    EXPECT_LT(found.misfit_after(), options.step);
    EXPECT_GT(found.misfit_before(), 0.1);
    for (const TunedLength& length : found.lengths) {
      EXPECT_FALSE(length.is_slack) << length.name;
      EXPECT_NEAR(length.factor, length.name == "tip_0" ? 0.94 : 1.03, 5e-4) << length.name;
    }
    ASSERT_TRUE(found.after);
    EXPECT_EQ(found.after->report.result.status, Status::Converged);
  }
}

TEST_F(ChordTuningTest, TheTunedSceneIsTheTunedShape) {
  ChordTuningOptions options;
  options.target = target(two_tips());
  options.grouping = ChordGrouping::Material;
  options.only = {"tip_0", "chords[60]"};
  const ChordTuning found = tuned(options);
  write_chord_tuning(found);
  for (const char* file : {"tuning.json", "tuning.csv", "tuning.html", "tuned.json", "tuned/closed.vtp"})
    EXPECT_TRUE(fs::exists(run_.folder / file)) << file;
  RunOptions alone;
  alone.writes = false;
  const RunReport again = run(load_scene(run_.folder / "tuned.json"), scene_solvers(), alone);
  ASSERT_EQ(again.report.result.status, Status::Converged);
  // Of the leaflets: junctions of slack chords have no place.
  const auto leaflets = [](const RunReport& run) {
    return Points(run.report.fields.x.leftCols(run.model.mesh.vertex_count()));
  };
  const Points x = leaflets(*found.after);
  EXPECT_LT((leaflets(again) - x).colwise().norm().maxCoeff(), 1e-4);
  EXPECT_GT((leaflets(found.before) - x).colwise().norm().maxCoeff(), 0.1);
}

#ifdef COAPT_HAS_NLOPT
// What has the weight falls, the smooth figure that is minimised and the sharp one that is reported.
TEST_F(ChordTuningTest, LessensOrificeOrForceWithinTheBounds) {
  ChordTuningOptions options;
  options.change_weight = 0;
  options.grouping = ChordGrouping::Tip;
  options.lowest = -0.03;
  options.highest = 0.02;
  options.max_solves = 60;
  struct Figures {
    double smooth_orifice = 0, smooth_force = 0, orifice = 0, force = 0;  // mm2, N
  };
  const auto figures = [](const TuningTrial& trial, const Metrics& metrics) {
    return Figures{trial.metrics.at(0), trial.metrics.at(1), metrics.orifice_area_mm2.value(),
                   metrics.max_chord_force_n.value()};
  };
  const auto of_weights = [&](double orifice, double force) {
    options.orifice_weight = orifice;
    options.force_weight = force;
    const ChordTuning found = tuned(options);
    EXPECT_EQ(found.method, "slsqp");
    EXPECT_EQ(found.tuning.failed, 0);
    EXPECT_FALSE(found.determinacy);
    EXPECT_EQ(found.lengths.size(), 8u);
    bool has_bound = false;
    for (const TunedLength& length : found.lengths) {
      EXPECT_GE(length.factor, 0.97 - 1e-12);
      EXPECT_LE(length.factor, 1.02 + 1e-12);
      has_bound = has_bound || length.at_bound != 0;
    }
    EXPECT_TRUE(has_bound);
    const std::vector<TuningTrial>& history = found.tuning.best.history;
    const auto best =
        std::min_element(history.begin(), history.end(),
                         [](const auto& one, const auto& other) { return one.cost < other.cost; });
    return std::pair(figures(history.front(), found.before.report.metrics),
                     figures(*best, found.after.value().report.metrics));
  };
  const auto [open, narrow] = of_weights(1, 0.01);
  EXPECT_LT(narrow.smooth_orifice, 0.8 * open.smooth_orifice);
  EXPECT_LT(narrow.orifice, 0.95 * open.orifice);
  const auto [loaded, relieved] = of_weights(0.01, 1);
  EXPECT_LT(relieved.smooth_force, 0.95 * loaded.smooth_force);
  EXPECT_LT(relieved.force, 0.93 * loaded.force);
  // Each is better at what it was asked for.
  EXPECT_LT(narrow.smooth_orifice, 0.9 * relieved.smooth_orifice);
  EXPECT_LT(relieved.smooth_force, 0.9 * narrow.smooth_force);
}

TEST_F(ChordTuningTest, AGreaterWeightOfTheChangeKeepsTheLengthsNearer) {
  ChordTuningOptions options;
  options.force_weight = 1;
  options.orifice_weight = 0.01;
  options.change_weight = 0;
  options.grouping = ChordGrouping::Material;
  options.lowest = -0.03;
  options.highest = 0.02;
  options.max_solves = 40;
  const ChordTuning found = tuned(options);
  options.change_weight = 1;
  const ChordTuning held = tuned(options);
  const auto change = [](const ChordTuning& tuning) {
    double sum = 0;
    for (const TunedLength& length : tuning.lengths)
      sum += length.chords * std::pow(length.after - length.before, 2);
    return sum;
  };
  EXPECT_LT(change(held), 0.5 * change(found));
  EXPECT_LT(held.tuning.cost_after, held.tuning.cost_before);
}
#endif

TEST_F(ChordTuningTest, GoesOnFromItsCheckpoint) {
  ChordTuningOptions options;
  options.target = target(two_tips());
  options.grouping = ChordGrouping::Tip;
  const ChordTuning whole = tuned(options);
  ChordTuningRecord kept;
  options.keep = [&](const ChordTuningRecord& record) { kept = record; };
  options.max_solves = 4;
  const ChordTuning cut = tuned(options);
  EXPECT_EQ(cut.tuning.status, TuningStatus::SolveLimit);
  EXPECT_FALSE(cut.has_converged());
  EXPECT_EQ(cut.tuning.solves, 3);

  const fs::path file = folder_.path() / "tuning.checkpoint";
  const auto identity = chord_tuning_identity(load_scene(scene()), options, run_);
  write_chord_tuning_checkpoint(file, identity, kept);
  const ChordTuningRecord known = read_chord_tuning_checkpoint(file, identity);
  EXPECT_EQ(known.tuning.q, kept.tuning.q);
  ChordTuningOptions more = options;
  more.keep = {};
  more.max_solves = 200;
  more.known = &known;
  const ChordTuning resumed = tuned(more);
  EXPECT_TRUE(resumed.has_converged());
  EXPECT_GT(resumed.tuning.solves, 3);
  EXPECT_EQ(resumed.tuning.best.history.front().cost, cut.tuning.best.history.front().cost);
  EXPECT_LE(resumed.misfit_after(), 1.01 * whole.misfit_after() + 1e-4);

  // Of another tuning, damaged, none.
  more.lowest = -0.1;
  const auto read = [&](const Identity& of) -> std::string {
    try {
      read_chord_tuning_checkpoint(file, of);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(read(chord_tuning_identity(load_scene(scene()), more, run_)).find("another pair of bounds"),
            std::string::npos);
  const auto size = fs::file_size(file);
  fs::resize_file(file, size - 1);
  EXPECT_NE(read(identity).find("damaged or cut off"), std::string::npos);
  folder_.write("tuning.checkpoint", "{}");
  EXPECT_NE(read(identity).find("is no checkpoint of a tuning"), std::string::npos);
}

TEST_F(ChordTuningTest, NamesEveryDefectAtOnce) {
  ChordTuningOptions options;
  options.target = folder_.path() / "missing.obj";
  options.only = {"basl"};
  options.lowest = 0.2;
  options.highest = -0.2;
  options.method = "newton";
  options.max_solves = 0;
  const std::string said = refusal(options);
  for (const char* piece : {"missing.obj", "--only: no chord is called \"basl\"", "--bounds: are reversed",
                            "--method: \"newton\" is not known", "--max-solves"})
    EXPECT_NE(said.find(piece), std::string::npos) << piece << " in:\n" << said;
  EXPECT_FALSE(fs::exists(run_.folder));

  options = {};
  EXPECT_NE(refusal(options).find("--target: missing"), std::string::npos);
  options.force_weight = 1;
  options.method = "gauss_newton";
  EXPECT_NE(refusal(options).find("fits a surface alone"), std::string::npos);

  write_mesh(folder_.path() / "disc.obj", disc(10, 54));
  folder_.write("scene.json",
                R"({ "mesh": { "file": "disc.obj" }, "boundary": [{ "nodes": "boundary", "fix": true }],
      "terms": [{ "type": "cst_stvk", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
                { "type": "load_pressure", "value": "0.1 kPa", "model": "follower" }] })");
  options = {};
  options.orifice_weight = 1;
  const std::string none = refusal(options);
  EXPECT_NE(none.find("there is nothing to tune"), std::string::npos) << none;
  EXPECT_NE(none.find("no node set \"annulus\""), std::string::npos) << none;
}

}  // namespace
}  // namespace coapt
