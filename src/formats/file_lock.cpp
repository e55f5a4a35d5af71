#include "formats/file_lock.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace coapt::formats {
namespace {

// The last holder may have removed the file between our opening it and locking it.
bool is_still_there(const std::filesystem::path& path, int file) {
  struct stat held = {}, named = {};
  return fstat(file, &held) == 0 && stat(path.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
         held.st_ino == named.st_ino;
}

}  // namespace

std::optional<FileLock> FileLock::taken(const std::filesystem::path& path) {
  for (;;) {
    const int file = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    if (file < 0)
      throw InputError(path.string() + ": cannot be written; check that the folder exists and is writable");
    int outcome = 0;
    while ((outcome = flock(file, LOCK_EX | LOCK_NB)) != 0 && errno == EINTR) {
    }
    if (outcome != 0 && errno == EWOULDBLOCK) {
      close(file);
      return std::nullopt;
    }
    // A file system without locks refuses with another error; two processes are then not kept apart.
    if (outcome != 0 || is_still_there(path, file)) return FileLock(path, file);
    close(file);
  }
}

FileLock::FileLock(std::filesystem::path path, int file) : path_(std::move(path)), file_(file) {}

FileLock::FileLock(FileLock&& other) noexcept
    : path_(std::move(other.path_)), file_(std::exchange(other.file_, -1)) {}

FileLock::~FileLock() {
  if (file_ < 0) return;
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  close(file_);
}

}  // namespace coapt::formats
