#include "cli/output_folder.hpp"

#include "core/error.hpp"

#include <system_error>

namespace coapt::cli {

namespace fs = std::filesystem;

void refuse_folder_of(const fs::path& input, const fs::path& folder) {
  std::error_code is_missing;
  if (fs::equivalent(fs::absolute(folder), fs::absolute(input).parent_path(), is_missing))
    throw InputError(folder.string() + ": is the folder of " + input.string() +
                     ", whose meshes and scenes could be overwritten; choose another folder");
}

}  // namespace coapt::cli
