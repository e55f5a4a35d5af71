// --checkpoint, --checkpoint-every and --resume of `coapt tune`.
#pragma once

#include "tuning/chord_tuning.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace CLI {
class App;
}

namespace coapt::cli {

struct TuneCheckpointArguments {
  std::string file, resumed;
  double every = 10;  // [s]
};

void add_tune_checkpoint_arguments(CLI::App& command, TuneCheckpointArguments& arguments);

// Keeps one tuning in a file while it goes on, and gives it what an earlier session kept. What cannot be
// written on the way is said at the end and does not stop the tuning.
class TuneCheckpoint {
 public:
  // Sets `keep` and `known` of the options, which must not outlive this object; defects go to theirs: a file
  // that is not of this tuning, one that is there already.
  TuneCheckpoint(const TuneCheckpointArguments& arguments, const std::filesystem::path& scene,
                 ChordTuningOptions& options, const RunOptions& run, bool is_quiet);
  TuneCheckpoint(const TuneCheckpoint&) = delete;
  TuneCheckpoint& operator=(const TuneCheckpoint&) = delete;

  // Call it when the results are written: removes the file of a tuning that went to its end, and says on the
  // standard output how one that was cut short goes on.
  void finish(const ChordTuning& found, const std::string& scene);

 private:
  void write();

  std::filesystem::path file_;
  std::map<std::string, std::string> identity_;
  ChordTuningRecord known_, last_;
  double every_, written_s_ = 0;
  bool is_quiet_;
  std::string failure_;  // of the last time that it was written
};

}  // namespace coapt::cli
