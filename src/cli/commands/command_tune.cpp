#include "cli/checkpoint_file.hpp"
#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "core/error.hpp"
#include "core/timing.hpp"
#include "formats/json/units.hpp"
#include "formats/text.hpp"
#include "results/result_warnings.hpp"
#include "results/standing.hpp"
#include "tuning/chord_tuning.hpp"

#include <cmath>
#include <cstdio>
#include <map>
#include <memory>

namespace coapt::cli {
namespace {

const std::map<std::string, ChordGrouping> kGroupings = {{"chord", ChordGrouping::Chord},
                                                         {"tip", ChordGrouping::Tip},
                                                         {"material", ChordGrouping::Material},
                                                         {"term", ChordGrouping::Term},
                                                         {"all", ChordGrouping::All}};

const std::map<std::string, FitSides> kSides = {
    {"both", FitSides::Both}, {"mesh", FitSides::Surface}, {"target", FitSides::Target}};

struct TuneArguments : StudyArguments {
  ChordTuningOptions tuning;
  CheckpointArguments checkpoint;
  std::string target, grouping = "chord", sides = "both", only, bounds, noise, determined, step;
  double distance_weight = -1, change_weight = -1, total_seconds = 0;  // below 0, or 0: not given
};

// Keeps one tuning in a file while it goes on, and gives it what an earlier session kept.
class TuneCheckpoint {
 public:
  // Sets `keep` and `known` of the options, which must not outlive this object; defects go to theirs: a file
  // that is not of this tuning, one that is there already.
  TuneCheckpoint(const CheckpointArguments& arguments, const std::filesystem::path& scene,
                 ChordTuningOptions& options, const RunOptions& run);
  TuneCheckpoint(const TuneCheckpoint&) = delete;
  TuneCheckpoint& operator=(const TuneCheckpoint&) = delete;

  // Call it when the results are written: removes the file of a tuning that went to its end, and says on the
  // standard output how one that was cut short goes on.
  void finish(const ChordTuning& found, const std::string& scene);

 private:
  void write();

  CheckpointFile file_;
  Identity identity_;
  ChordTuningRecord known_, last_;
  double every_, written_s_ = 0;
};

TuneCheckpoint::TuneCheckpoint(const CheckpointArguments& arguments, const std::filesystem::path& scene,
                               ChordTuningOptions& options, const RunOptions& run)
    : file_(arguments, "tuning", "tune"), every_(arguments.every) {
  if (!arguments.is_wanted()) return;
  if (const auto defect = file_.defect()) options.defects.push_back(*defect);
  try {
    identity_ = chord_tuning_identity(load_scene(scene), options, run);
    if (!arguments.resumed.empty()) {
      known_ = read_chord_tuning_checkpoint(arguments.resumed, identity_);
      options.known = &known_;
    }
  } catch (const InputError& found) {
    options.defects.insert(options.defects.end(), found.defects().begin(), found.defects().end());
    return;
  }
  if (options.known != nullptr)
    std::printf("resumed after %zu trials in %.3g s\n", known_.tuning.history.size(), known_.tuning.seconds);
  last_ = known_;
  options.keep = [this](const ChordTuningRecord& record) {
    last_ = record;
    if (wall_seconds() - written_s_ >= every_) write();
  };
}

void TuneCheckpoint::write() {
  file_.keep([&](const auto& path) { write_chord_tuning_checkpoint(path, identity_, last_); });
  written_s_ = wall_seconds();
}

void TuneCheckpoint::finish(const ChordTuning& found, const std::string& scene) {
  if (last_.tuning.history.empty()) return;  // nothing was kept
  const TuningStatus status = found.tuning.status;
  if (status == TuningStatus::Converged || status == TuningStatus::Stalled) return file_.remove();
  write();
  file_.print_how_to_go_on(scene);
}

// "-20%" or "-0.2".
std::optional<double> share_of(const std::string& text) {
  const bool is_percent = !text.empty() && text.back() == '%';
  double number = 0;
  if (formats::read_number(text.substr(0, text.size() - (is_percent ? 1 : 0)), number)) return std::nullopt;
  return is_percent ? number / 100 : number;
}

void read_bounds(const std::string& text, ChordTuningOptions& options) {
  if (text.empty()) return;
  const size_t dots = text.find("..");
  const auto low = dots == std::string::npos ? std::nullopt : share_of(text.substr(0, dots));
  const auto high = dots == std::string::npos ? std::nullopt : share_of(text.substr(dots + 2));
  if (low && high) {
    options.lowest = *low;
    options.highest = *high;
  } else {
    options.defects.push_back("--bounds: read \"" + text + "\"; expected relative changes, as in -20%..20%");
  }
}

void read_length(const char* name, const std::string& text, double& length,
                 std::vector<std::string>& defects) {
  if (text.empty()) return;
  try {
    length = quantity_value(text, kLength);
  } catch (const InputError& error) {
    defects.push_back(std::string(name) + ": " + error.what());
  }
}

ChordTuningOptions tuning_options(const TuneArguments& arguments) {
  ChordTuningOptions options = arguments.tuning;
  options.target = arguments.target;
  options.grouping = kGroupings.at(arguments.grouping);
  options.sides = kSides.at(arguments.sides);
  if (!arguments.only.empty()) options.only = comma_list(arguments.only);
  if (!(arguments.distance_weight < 0)) options.distance_weight = arguments.distance_weight;
  if (!(arguments.change_weight < 0)) options.change_weight = arguments.change_weight;
  if (arguments.total_seconds > 0) options.max_seconds = arguments.total_seconds;
  read_bounds(arguments.bounds, options);
  read_length("--noise", arguments.noise, options.noise, options.defects);
  read_length("--determined", arguments.determined, options.determined, options.defects);
  read_length("--step", arguments.step, options.step, options.defects);
  return options;
}

void print_trial(int solve, const TuningTrial& trial) {
  end_progress();
  std::printf("solve %3d  ", solve);
  if (trial.is_aided && trial.status == Status::Converged)
    std::printf("drawn to the target");
  else if (std::isfinite(trial.cost))
    std::printf("cost %.4e", trial.cost);
  else
    std::printf("rejected: %s", std::string(status_name(trial.status)).c_str());
  if (std::isfinite(trial.misfit)) std::printf("  rms distance %.4f mm", std::sqrt(trial.misfit));
  std::printf("  %d iterations  %.2f s%s%s\n", trial.iterations, trial.seconds, trial.is_best ? "  best" : "",
              trial.lost_branch ? "  another branch of equilibria" : "");
  std::fflush(stdout);
}

void print_found(const ChordTuning& found) {
  std::printf("%s: %s\n", std::string(tuning_status_name(found.tuning.status)).c_str(),
              found.tuning.message.c_str());
  print_table(chosen(length_table(found), kShownOfLengths));
  if (found.determinacy) {
    long open = 0;
    for (const TunedLength& length : found.lengths) open += length.is_determined ? 0 : 1;
    std::printf("  %ld of %zu lengths are not determined to %g mm by a target known to %.2g mm\n", open,
                found.lengths.size(), found.determined, found.noise);
    if (!found.is_explained)
      std::printf("  that does not explain what the fit leaves: it is trapped, or the model is another\n");
  }
  std::printf("  cost %.4e before, %.4e after", found.tuning.cost_before, found.tuning.cost_after);
  if (std::isfinite(found.misfit_before()))
    std::printf("; rms distance %.4f mm before, %.4f mm after", found.misfit_before(), found.misfit_after());
  if (found.tuning.anchor && !found.tuning.anchor->is_same_branch)
    std::printf("\n  warning: the best shape %s", found.tuning.anchor->message.c_str());
  std::printf("\n  %d solves (%d rejected, %d on another branch of equilibria), %.2f s\n", found.solves,
              found.tuning.failed, found.tuning.lost_branches, found.seconds);
  const auto print_doubts = [](const char* name, const RunReport& run) {
    const Standing state = standing(name, run.report);
    if (!state.doubts.empty()) std::printf("  %s in doubt: %s\n", name, joined_doubts(state.doubts).c_str());
  };
  print_doubts("before", found.before);
  if (found.after) print_doubts("after", *found.after);
  std::printf("written to %s (tuning.json, tuning.csv, tuning.html%s and the folders untuned and tuned)\n",
              found.folder.string().c_str(), found.tuned_scene.empty() ? "" : ", tuned.json");
}

// Nothing where it cannot be read: tune_chords() says so, with all else that is wrong.
std::optional<Scene> readable_scene(const std::string& path) {
  try {
    return load_scene(path);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void run_command(const TuneArguments& arguments, Session& session) {
  listen_for_interrupts();
  ChordTuningOptions options = tuning_options(arguments);
  RunOptions run = arguments.options(session);
  run.folder = arguments.folder;
  if (arguments.total_seconds > 0) run.max_seconds = arguments.total_seconds;
  options.is_cancelled = [] { return is_interrupted(); };
  options.report = print_trial;
  options.report_before = [](const RunReport& before) {
    end_progress();
    std::printf("solve   1  %s, residual %.1e  %d iterations  %.2f s\n",
                std::string(status_name(before.report.result.status)).c_str(), before.report.result.residual,
                before.report.result.iterations, before.report.result.wall_s);
  };
  std::optional<OutputFolder> output;
  if (const std::optional<Scene> scene = readable_scene(arguments.scene))
    output.emplace(arguments.folder_for(*scene, {"tuning.json", "tuning.csv", "tuning.html", "tuned.json"},
                                        {arguments.target}));
  TuneCheckpoint checkpoint(arguments.checkpoint, arguments.scene, options, run);
  const ChordTuning found = tune_chords(arguments.scene, all_solvers(), all_minimisers(), options, run);
  end_progress();
  write_chord_tuning(found);
  session.document = chord_tuning_json(found);
  print_found(found);
  checkpoint.finish(found, arguments.scene);
  const Report& result = found.after ? found.after->report : found.before.report;
  session.exit_code = exit_code_of(found.has_converged(), {doubts(result)});
}

}  // namespace

void add_tune_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<TuneArguments>();
  CLI::App* command = app.add_subcommand(
      "tune", "Chord lengths that fit a closed surface, or minimise orifice and chord force");
  ChordTuningOptions& tuning = arguments->tuning;
  command->add_option("SCENE", arguments->scene, "Scene file (JSON)")->required();
  command->add_option("-o,--output", arguments->folder, "Folder of the files (default: the scene's)");
  command->add_option("--tolerance", arguments->tolerance, "On the residual (default: the scene's)")
      ->check(positive_defect);
  add_path_option(*command, arguments->damped_steps);
  command->add_option("--solver", arguments->solver,
                      "Of the first solve and the last (default: the scene's)");
  command->add_option("--target", arguments->target,
                      "Closed surface to fit, a mesh file (default: the scene's reference.closed_surface)");
  command->add_option("--target-scale", tuning.target_scale, "mm per unit of that file (default: 1)");
  command
      ->add_option(
          "--sides", arguments->sides,
          "Whose vertices look for the other surface: both, mesh where the target is larger than the "
          "valve, target where it is a part of it (default: both)")
      ->check(CLI::IsMember({"both", "mesh", "target"}));
  command->add_flag("--direct", tuning.is_direct,
                    "Search from the lengths as they are, without drawing the leaflets to the target first");
  command
      ->add_option("--distance-weight", arguments->distance_weight,
                   "Per mm2 of mean square distance (default: 1, or 0 without a target beside others)")
      ->check(CLI::NonNegativeNumber);
  command->add_option("--orifice-weight", tuning.orifice_weight, "Per mm2 of smooth orifice (default: 0)");
  command->add_option("--force-weight", tuning.force_weight,
                      "Per N of smooth greatest chord force (default: 0)");
  command
      ->add_option("--change-weight", arguments->change_weight,
                   "Per mm2, of the sum over the chords of their squared change (default: 1e-6 for a fit, "
                   "else 1e-3)")
      ->check(CLI::NonNegativeNumber);
  command
      ->add_option("--by", arguments->grouping,
                   "What gets one factor: chord, tip, material, term or all (default: chord)")
      ->check(CLI::IsMember({"chord", "tip", "material", "term", "all"}));
  command->add_option("--only", arguments->only,
                      "Tune these alone: names of groups (tip_0, a material, a term) or chords (chords[3])");
  command->add_option("--bounds", arguments->bounds, "Of the relative change (default: -20%..20%)");
  command->add_option(
      "--method", tuning.method,
      "gauss_newton, ceres, slsqp, mma, lbfgs or cobyla (default: gauss_newton for a fit, else "
      "slsqp)");
  command->add_option("--step", arguments->step, "Length change below which the search ends (default: 1 um)");
  command->add_option("--gain", tuning.gain, "Relative gain below which it ends (default: 1e-6)");
  command->add_option("--max-solves", tuning.max_solves, "Of closures in all (default: 200)");
  command->add_option("--max-seconds", arguments->total_seconds, "Of this session (default: no limit)")
      ->check(positive_defect);
  command->add_option(
      "--noise", arguments->noise,
      "Standard deviation of the target's distances, for what it determines (default: 0.1 mm)");
  command->add_option("--determined", arguments->determined,
                      "Greatest standard deviation of a length that counts as determined (default: 0.05 mm)");
  add_checkpoint_arguments(*command, arguments->checkpoint, "tuning", 10);
  command->callback([arguments, &session] { run_command(*arguments, session); });
}

}  // namespace coapt::cli
