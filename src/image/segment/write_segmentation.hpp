// The files of a segmentation.
#pragma once

#include "image/segment/segment_leaflets.hpp"

#include <filesystem>
#include <string>

namespace coapt {

// Into a folder that is there: valve.json with leaflets.obj beside it, as `coapt import` reads them;
// leaflets.vtp with thickness_mm, deviation_mm and evidence at the vertices, and second_route_mm where there
// is one; segmentation.json with the figures; and evidence.nrrd where that was kept. All in LPS [mm]. volume,
// annulus: names of the files that were read. Throws InputError where one cannot be written.
void write_segmentation(const std::filesystem::path& folder, const Segmentation& found,
                        const std::string& volume, const std::string& annulus);

}  // namespace coapt
