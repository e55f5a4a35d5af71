#include "formats/durable_file.hpp"

#include "core/output_error.hpp"

#include <fcntl.h>
#include <fstream>
#include <string>
#include <system_error>
#include <unistd.h>

namespace coapt::formats {
namespace {

namespace fs = std::filesystem;

// Waits until a file, or the list of files of a folder, is on the disk. Some file systems refuse that for
// folders; their own order has to do.
bool reaches_the_disk(const fs::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return false;
  const bool is_there = fsync(file) == 0;
  close(file);
  return is_there;
}

// A file of a name of its own, so that a killed process leaves at most one behind.
void write_beside(const fs::path& path, const fs::path& beside, std::string_view bytes) {
  std::error_code error;
  const auto target = fs::status(path, error);
  if (fs::is_directory(target)) throw InputError(path.string() + ": is a folder; name a file");
  if (fs::exists(target) && !fs::is_regular_file(target))
    throw InputError(path.string() + ": is a device or a pipe, which a file cannot replace; name a file");
  std::ofstream stream(beside, std::ios::binary | std::ios::trunc);
  if (!stream)
    throw InputError(path.string() + ": cannot be written; check that the folder exists and is writable");
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  stream.close();
  if (!stream || !reaches_the_disk(beside)) {
    fs::remove(beside, error);
    throw OutputError(path.string() + ": writing failed; is the disk full?");
  }
}

}  // namespace

void write_durable(const fs::path& path, std::string_view bytes) {
  fs::path beside = path;
  beside += ".new";
  write_beside(path, beside, bytes);
  std::error_code error;
  fs::rename(beside, path, error);
  if (error) {
    const std::string reason = error.message();
    fs::remove(beside, error);
    throw OutputError(path.string() + ": cannot be written (" + reason + ")");
  }
  reaches_the_disk(fs::absolute(path).parent_path());
}

}  // namespace coapt::formats
