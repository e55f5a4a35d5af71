// --checkpoint, --checkpoint-every and --resume: a run that outlives its process.
#pragma once

#include "solve/checkpoint.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace coapt::cli {

struct CheckpointArguments {
  std::string file, resumed;
  double every = 60;  // [s]
  bool is_exact = false;

  bool is_wanted() const { return !file.empty() || !resumed.empty(); }
};

void add_checkpoint_arguments(CLI::App& command, CheckpointArguments& arguments);

// Keeps one run in a file while it goes on. What cannot be written on the way is said at the end and does not
// stop the run.
class Checkpointing {
 public:
  // Reads the file to resume and makes the one to write. Throws InputError: where the first is not of this
  // run, where the second is there already and is not the first, or cannot be written.
  Checkpointing(const CheckpointArguments& arguments, const RunIdentity& identity);
  // A run that ended by an exception leaves its file, if there is anything in it.
  ~Checkpointing();
  Checkpointing(const Checkpointing&) = delete;
  Checkpointing& operator=(const Checkpointing&) = delete;

  SolverTable recorded(const SolverTable& table) { return recorder_->recorded(table); }
  Observer recorded(Observer next) { return recorder_->recorded(std::move(next)); }

  // Call it when the results are written: removes the file of a run that went to its end, and says on the
  // standard output how one that was cut short goes on.
  void finish(const std::string& scene);

 private:
  void keep(const RunRecord& record);

  std::filesystem::path file_;
  RunIdentity identity_;
  std::optional<RunRecorder> recorder_;
  bool is_finished_ = false;
  std::string failure_;  // of the last time that it was written
};

}  // namespace coapt::cli
