#include "formats/whole_file.hpp"

#include "core/output_error.hpp"
#include "formats/file_kind.hpp"

#include <chrono>
#include <fstream>
#include <system_error>
#include <unistd.h>

namespace coapt::formats {

std::optional<std::string> what_is_no_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status)) return std::nullopt;
  if (std::filesystem::is_directory(status)) return "is a folder; name a file in it";
  return std::string("is a ") +
         (std::filesystem::is_fifo(status)     ? "pipe"
          : std::filesystem::is_socket(status) ? "socket"
                                               : "device") +
         ", no file";
}

void refuse_what_is_no_file(const std::filesystem::path& path) {
  if (const auto reason = what_is_no_file(path)) throw InputError(path.string() + ": " + *reason);
}

std::string read_whole(const std::filesystem::path& path, std::uintmax_t greatest) {
  const std::string name = path.string();
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(name + ": there is no such file");
  refuse_what_is_no_file(path);
  const auto size = std::filesystem::file_size(path, error);
  if (!error && size > greatest)
    throw InputError(name + ": " + std::to_string(size >> 20) + " MB; at most " +
                     std::to_string(greatest >> 20) + " MB are read");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(name + ": cannot be opened for reading; check its permissions");
  std::string bytes;
  if (!error) bytes.reserve(static_cast<size_t>(size));
  char block[1 << 16];
  while (stream.read(block, sizeof block) || stream.gcount() > 0)
    bytes.append(block, static_cast<size_t>(stream.gcount()));
  if (stream.bad()) throw InputError(name + ": reading failed");
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.erase(0, 3);
  return bytes;
}

void write_whole(const std::filesystem::path& path, std::initializer_list<std::string_view> parts) {
  // Process and clock keep two writers of the same target apart.
  const auto ticks = std::chrono::steady_clock::now().time_since_epoch().count();
  std::filesystem::path part = path;
  part += ".part-" + std::to_string(getpid()) + "-" + std::to_string(ticks);
  std::error_code error;
  const auto target = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(target)) throw InputError(path.string() + ": is a folder; name a file");
  if (std::filesystem::exists(target) && !std::filesystem::is_regular_file(target))
    throw InputError(path.string() + ": is a device or a pipe, which a file cannot replace; name a file");
  {
    std::ofstream stream(part, std::ios::binary | std::ios::trunc);
    if (!stream)
      throw InputError(path.string() + ": cannot be written; check that the folder exists and is writable");
    for (const std::string_view bytes : parts)
      stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    stream.close();
    if (!stream) {
      std::filesystem::remove(part, error);
      throw OutputError(path.string() + ": writing failed; is the disk full?");
    }
  }
  std::filesystem::rename(part, path, error);
  if (error) {
    const std::string reason = error.message();
    std::filesystem::remove(part, error);
    throw OutputError(path.string() + ": cannot be written (" + reason + ")");
  }
}

}  // namespace coapt::formats
