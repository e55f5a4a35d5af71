#include "image/detail/stated_geometry.hpp"

#include "core/error.hpp"

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

namespace coapt {
namespace {

constexpr std::uintmax_t kNiftiHeader = 352;  // bytes before the voxels of a file of NIfTI-1, at least
constexpr int kMostHeaderLines = 10000;       // lines of a header that are read; more are no header

std::string without_space_around(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string in_small_letters(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

bool has_digit(const std::string& text) { return text.find_first_of("0123456789") != std::string::npos; }

// Calls see(key, value, whether the line is empty) for the lines `key: value` until it returns false.
template <typename See>
void read_fields(const std::filesystem::path& path, const See& see) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  for (int n = 0; n < kMostHeaderLines && std::getline(file, line); ++n) {
    const std::string text = without_space_around(line);
    const std::size_t at = text.find(':');
    const bool is_field = at != std::string::npos && !text.starts_with('#');
    if (!see(in_small_letters(without_space_around(text.substr(0, is_field ? at : 0))),
             is_field ? without_space_around(text.substr(at + 1)) : "", text.empty()))
      break;
  }
}

}  // namespace

StatedGeometry stated_in_nrrd(const std::filesystem::path& path) {
  StatedGeometry stated;
  read_fields(path, [&](const std::string& key, const std::string& value, bool is_empty) {
    if (key == "space directions" && has_digit(value)) stated.spacing = stated.direction = true;
    if (key == "spacings" && has_digit(value)) stated.spacing = true;
    if (key == "kinds") stated.is_list = in_small_letters(value).find("list") != std::string::npos;
    if (key == "space") stated.space = in_small_letters(value);
    return !is_empty;  // an empty line ends the header
  });
  return stated;
}

void check_nifti_data(const std::filesystem::path& path, std::uintmax_t wanted) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"),
                                                        gzclose);  // packed or not
  std::vector<char> buffer(1 << 16);
  std::uintmax_t size = 0;
  for (int count = 1; file && count > 0; size += static_cast<std::uintmax_t>(std::max(count, 0)))
    count = gzread(file.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
  if (size < wanted + kNiftiHeader)
    throw InputError(path.string() + ": its voxels cannot be read: the file holds " + std::to_string(size) +
                     " bytes, at least " + std::to_string(wanted + kNiftiHeader) +
                     " are wanted; copy or export it again");
}

}  // namespace coapt
