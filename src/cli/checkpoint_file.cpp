#include "cli/checkpoint_file.hpp"

#include "cli/command_line.hpp"
#include "cli/study_options.hpp"
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/whole_file.hpp"

#include <cstdio>
#include <system_error>
#include <utility>

namespace coapt::cli {

namespace fs = std::filesystem;

CLI::Option* add_checkpoint_arguments(CLI::App& command, CheckpointArguments& arguments,
                                      const std::string& work, double every) {
  arguments.every = every;
  command.add_option(
      "--checkpoint", arguments.file,
      "Keep the " + work + " in this file while it goes on, for --resume; removed when it is through");
  command
      .add_option("--checkpoint-every", arguments.every,
                  "Seconds from one checkpoint to the next (default: " + number_text(every) + ")")
      ->check(positive_defect);
  return command.add_option(
      "--resume", arguments.resumed,
      "Go on with the " + work + " that this file keeps, and keep it there (or in --checkpoint)");
}

namespace {

std::optional<formats::FileLock> lock_beside(const fs::path& path) {
  formats::refuse_what_is_no_file(path);
  if (path.empty()) return std::nullopt;
  return formats::FileLock::taken(fs::path(path) += ".lock");
}

}  // namespace

CheckpointFile::CheckpointFile(const CheckpointArguments& arguments, std::string work, std::string command)
    : path_(arguments.file.empty() ? arguments.resumed : arguments.file),
      resumed_(arguments.resumed),
      lock_(lock_beside(path_)),
      work_(std::move(work)),
      command_(std::move(command)) {}

std::optional<std::string> CheckpointFile::defect() const {
  if (!lock_)
    return path_.string() + ": another process keeps its " + work_ +
           " in this file; wait for its end, or name another file with --checkpoint";
  std::error_code error;
  const bool is_same = !resumed_.empty() && (path_ == resumed_ || fs::equivalent(path_, resumed_, error));
  if (is_same || !fs::exists(path_, error)) return std::nullopt;
  return path_.string() + ": is there already; go on with the " + work_ + " that it keeps by --resume " +
         path_.string() + ", or remove it";
}

void CheckpointFile::keep(const std::function<void(const fs::path&)>& write) {
  try {
    write(path_);
    failure_.clear();
  } catch (const InputError& error) {
    failure_ = error.what();
  }
}

void CheckpointFile::remove() const {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

void CheckpointFile::print_how_to_go_on(const std::string& scene) const {
  if (failure_.empty())
    std::printf("go on with the same options and: coapt %s %s --resume %s\n", command_.c_str(), scene.c_str(),
                path_.string().c_str());
  else
    std::printf("  warning: the %s could not be kept: %s\n", work_.c_str(), failure_.c_str());
}

}  // namespace coapt::cli
