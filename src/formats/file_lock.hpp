// A lock between processes.
#pragma once

#include <filesystem>
#include <optional>

namespace coapt::formats {

// Holds a file that says "in use" until it is destroyed, which removes the file. The system gives the lock
// back when the process ends, however it ends: what a killed process leaves behind holds nobody up. A process
// that is forked holds it too.
class FileLock {
 public:
  // Nothing where another holder has it. The file is made where it is missing, its folder is not. Throws
  // InputError where it cannot be made.
  static std::optional<FileLock> taken(const std::filesystem::path& path);

  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&&) = delete;
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;
  ~FileLock();

 private:
  FileLock(std::filesystem::path path, int file);

  std::filesystem::path path_;
  int file_ = -1;  // -1: moved from
};

}  // namespace coapt::formats
