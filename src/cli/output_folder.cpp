#include "cli/output_folder.hpp"

#include "core/error.hpp"
#include "results/results.hpp"

#include <system_error>

namespace coapt::cli {

namespace fs = std::filesystem;

void refuse_folder_of(const fs::path& input, const fs::path& folder) {
  std::error_code is_missing;
  if (fs::equivalent(fs::absolute(folder), fs::absolute(input).parent_path(), is_missing))
    throw InputError(folder.string() + ": is the folder of " + input.string() +
                     ", whose meshes and scenes could be overwritten; choose another folder");
}

OutputFolder::OutputFolder(const fs::path& path) : path_(path) {
  std::error_code error;
  for (fs::path part = fs::absolute(path); !fs::exists(part, error) && part.has_relative_path();
       part = part.parent_path())
    if (part.has_filename()) made_.push_back(part);
  prepare_result_folder(path);
  if (auto lock = formats::FileLock::taken(path / ".coapt.lock"))
    lock_.emplace(std::move(*lock));
  else
    throw InputError(
        path.string() +
        ": another process is writing into this folder; wait for its end, or choose another with -o");
}

OutputFolder::~OutputFolder() {
  lock_.reset();
  std::error_code is_used;
  for (const fs::path& part : made_)
    if (!fs::remove(part, is_used) || is_used) break;
}

}  // namespace coapt::cli
