// Where commands write.
#pragma once

#include "formats/file_lock.hpp"

#include <filesystem>
#include <vector>

namespace coapt::cli {

// Throws InputError where the folder is that of the input: what is written there has names of its own, and
// could take the place of the very files that are read.
void refuse_folder_of(const std::filesystem::path& input, const std::filesystem::path& folder);

// A folder that this process alone writes into until this is destroyed. Made where it is missing, and taken
// away again where nothing came into it.
class OutputFolder {
 public:
  // Throws InputError where it cannot be made or written, and where another process writes into it.
  explicit OutputFolder(const std::filesystem::path& path);
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;
  ~OutputFolder();

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::vector<std::filesystem::path> made_;  // the innermost first
  std::optional<formats::FileLock> lock_;
};

}  // namespace coapt::cli
