// Where commands write that take a valve in and give one out.
#pragma once

#include <filesystem>

namespace coapt::cli {

// Throws InputError where the folder is that of the input: what is written there has names of its own, and
// could take the place of the very files that are read.
void refuse_folder_of(const std::filesystem::path& input, const std::filesystem::path& folder);

}  // namespace coapt::cli
