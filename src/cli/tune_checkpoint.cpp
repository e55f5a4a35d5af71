#include "cli/tune_checkpoint.hpp"

#include "cli/study_options.hpp"
#include "core/error.hpp"
#include "core/timing.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <system_error>

namespace coapt::cli {

namespace fs = std::filesystem;

void add_tune_checkpoint_arguments(CLI::App& command, TuneCheckpointArguments& arguments) {
  command.add_option(
      "--checkpoint", arguments.file,
      "Keep the tuning in this file while it goes on, for --resume; removed when it is through");
  command
      .add_option("--checkpoint-every", arguments.every,
                  "Seconds from one checkpoint to the next (default: 10)")
      ->check(positive_defect);
  command.add_option("--resume", arguments.resumed,
                     "Go on with the tuning that this file keeps, and keep it there (or in --checkpoint)");
}

TuneCheckpoint::TuneCheckpoint(const TuneCheckpointArguments& arguments, const fs::path& scene,
                               ChordTuningOptions& options, const RunOptions& run, bool is_quiet)
    : file_(arguments.file.empty() ? arguments.resumed : arguments.file),
      every_(arguments.every),
      is_quiet_(is_quiet) {
  if (file_.empty()) return;
  std::error_code error;
  const bool is_same = !arguments.resumed.empty() &&
                       (file_ == arguments.resumed || fs::equivalent(file_, arguments.resumed, error));
  if (!is_same && fs::exists(file_, error))
    options.defects.push_back(file_.string() +
                              ": is there already; go on with the tuning that it keeps by --resume " +
                              file_.string() + ", or remove it");
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
  if (options.known != nullptr && !is_quiet_)
    std::printf("resumed after %zu trials in %.3g s\n", known_.tuning.history.size(), known_.tuning.seconds);
  last_ = known_;
  options.keep = [this](const ChordTuningRecord& record) {
    last_ = record;
    if (wall_seconds() - written_s_ >= every_) write();
  };
}

void TuneCheckpoint::write() {
  try {
    write_chord_tuning_checkpoint(file_, identity_, last_);
    failure_.clear();
  } catch (const InputError& error) {
    failure_ = error.what();
  }
  written_s_ = wall_seconds();
}

void TuneCheckpoint::finish(const ChordTuning& found, const std::string& scene) {
  if (file_.empty() || last_.tuning.history.empty()) return;
  const TuningStatus status = found.tuning.status;
  if (status == TuningStatus::Converged || status == TuningStatus::Stalled) {
    std::error_code ignored;
    fs::remove(file_, ignored);
    return;
  }
  write();
  if (is_quiet_) return;
  if (failure_.empty())
    std::printf("go on with the same options and: coapt tune %s --resume %s\n", scene.c_str(),
                file_.string().c_str());
  else
    std::printf("  warning: the tuning could not be kept: %s\n", failure_.c_str());
}

}  // namespace coapt::cli
