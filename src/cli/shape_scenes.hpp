// Ready scenes of simple shapes, each with numbers for which the answer is known.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace coapt::cli {

struct ShapeOptions {
  std::optional<int> triangles = {};  // wanted; empty: 2500. The catenary has none and always 40 links
  std::string contact = "";           // none, barrier or facet; empty: none
  std::string pressure = "";          // follower, volume or frozen; empty: what suits the shape
};

// "disc", "square", "sphere", "tent", "catenary", "airbag", "strip".
std::vector<std::string> shape_names();

// Makes the folder and writes scene.json and the mesh (of the catenary: the network) into it. Throws
// InputError for an option that the shape cannot have, or when a file cannot be written.
void write_shape_scene(const std::string& shape, const ShapeOptions& options,
                       const std::filesystem::path& folder);

}  // namespace coapt::cli
