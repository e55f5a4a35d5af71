// How far solved leaflets lie from what a volume of the closed valve shows.
#pragma once

#include "core/types.hpp"
#include "mesh/triangle_mesh.hpp"
#include "results/reference/distance_figures.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt::cli {

// From the leaflets to the middles of the sheets that the volume shows, and back.
struct ImageDistance {
  DistanceFigures to_image, from_image;  // [mm]
  Vector vertices;                       // of each vertex from the nearest ridge point [mm]
  Eigen::Index ridge_points = 0;         // that are counted
};

// ridges: 3 x n, in the frame of the leaflets [mm]. Those farther than 5 mm from the leaflets are other
// structures, and do not count. Throws InputError where there is none.
ImageDistance distance_from_image(const TriangleMesh& closed, const Points& ridges);

// Mean, 95th percentile and greatest; NaN without values.
DistanceFigures figures_of(std::vector<double> values);

struct ImageLine;  // image_line.hpp

// image_distance.vtp (distance_to_image_mm at the vertices) and image_distance.json, into a folder.
void write_image_distance(const std::filesystem::path& folder, const TriangleMesh& closed,
                          const ImageDistance& distance, const ImageLine& line,
                          const std::string& closed_volume);

}  // namespace coapt::cli
