// --checkpoint, --checkpoint-every, --resume and --exactly of `coapt solve`.
#pragma once

#include "cli/checkpoint_file.hpp"
#include "solve/checkpoint.hpp"

#include <optional>
#include <string>

namespace coapt::cli {

struct SolveCheckpointArguments : CheckpointArguments {
  bool is_exact = false;
};

void add_solve_checkpoint_arguments(CLI::App& command, SolveCheckpointArguments& arguments);

// Keeps one run in a file while it goes on.
class SolveCheckpoint {
 public:
  // Reads the file to resume and makes the one to write. Throws InputError: where the first is not of this
  // run, where the second is there already and is not the first, or cannot be written.
  SolveCheckpoint(const SolveCheckpointArguments& arguments, const RunIdentity& identity);
  // A run that ended by an exception leaves its file, if there is anything in it.
  ~SolveCheckpoint();
  SolveCheckpoint(const SolveCheckpoint&) = delete;
  SolveCheckpoint& operator=(const SolveCheckpoint&) = delete;

  SolverTable recorded(const SolverTable& table) { return recorder_->recorded(table); }
  Observer recorded(Observer next) { return recorder_->recorded(std::move(next)); }

  // Call it when the results are written: removes the file of a run that went to its end, and says on the
  // standard output how one that was cut short, or whose results are not all written, goes on.
  void finish(const std::string& scene, bool is_written = true);

 private:
  void keep(const RunRecord& record);

  CheckpointFile file_;
  RunIdentity identity_;
  std::optional<RunRecorder> recorder_;
  bool is_finished_ = false;
};

}  // namespace coapt::cli
