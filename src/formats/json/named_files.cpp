#include "formats/json/named_files.hpp"

#include <string>
#include <system_error>

namespace coapt {
namespace {

void find_named_files(const Json& json, const std::filesystem::path& folder,
                      std::vector<std::filesystem::path>& files) {
  if (json.is_structured()) {
    for (const Json& item : json) find_named_files(item, folder, files);
  } else if (json.is_string()) {
    std::error_code error;
    const std::filesystem::path file = folder / json.get_ref<const std::string&>();
    if (std::filesystem::is_regular_file(file, error)) files.push_back(file);
  }
}

}  // namespace

std::vector<std::filesystem::path> named_files(const Json& json, const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  find_named_files(json, folder, files);
  return files;
}

}  // namespace coapt
