// --checkpoint, --checkpoint-every and --resume: the file of work that outlives its process.
#pragma once

#include "formats/file_lock.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace coapt::cli {

struct CheckpointArguments {
  std::string file, resumed;
  double every = 0;  // [s]

  bool is_wanted() const { return !file.empty() || !resumed.empty(); }
};

// work: "run", "tuning". Returns --resume.
CLI::Option* add_checkpoint_arguments(CLI::App& command, CheckpointArguments& arguments,
                                      const std::string& work, double every);

// What cannot be written on the way is said at the end and does not stop the work. No other process keeps its
// work in the file meanwhile.
class CheckpointFile {
 public:
  // Throws InputError for a file in a folder that is not there or cannot be written.
  CheckpointFile(const CheckpointArguments& arguments, std::string work, std::string command);

  const std::filesystem::path& path() const { return path_; }
  // A file is there already that is not the one to resume, or another process has it.
  std::optional<std::string> defect() const;

  void keep(const std::function<void(const std::filesystem::path&)>& write);
  void remove() const;
  void print_how_to_go_on(const std::string& scene) const;

 private:
  std::filesystem::path path_, resumed_;
  std::optional<formats::FileLock> lock_;  // empty: another process has it
  std::string work_, command_;
  std::string failure_;  // of the last time that it was written
};

}  // namespace coapt::cli
