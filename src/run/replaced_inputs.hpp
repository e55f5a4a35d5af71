// Inputs that a result would take the place of.
#pragma once

#include "scene/file/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

// The names of all files that a solve may write into its folder.
const std::vector<std::string>& solve_files();

// Throws InputError where the scene file, a file that it names, or one of the other inputs, is one of those
// names in the folder; empty paths name none, and "*.obj" and "closed_*" are patterns with one star. A scene
// in memory has no file.
void refuse_replaced_inputs(const Scene& scene, const std::filesystem::path& folder,
                            const std::vector<std::string>& names,
                            std::vector<std::filesystem::path> others = {});

}  // namespace coapt
