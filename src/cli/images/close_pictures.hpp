// Slices through the volumes of a closed valve, with the leaflets drawn on them.
#pragma once

#include "image/segment/line_in_image.hpp"
#include "image/volume.hpp"
#include "mesh/triangle_mesh.hpp"
#include "run/pictured_page.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace coapt::cli {

struct PicturedValve {
  const Volume& open;
  const TriangleMesh& found;  // in the open volume
  TriangleMesh solved;        // in the frame of the open volume
  Points annulus;             // closed curve, 3 x n
  Vec3 ventricle;             // a place on that side
  std::vector<Points> line;   // pieces of the coaptation line of the solved leaflets, each 3 x n
};

// slices_open.png: found leaflets blue, solved ones orange.
PageImage open_picture(const std::filesystem::path& folder, const PicturedValve& valve);

// slices_closed.png, in the frame of the closed volume: solved leaflets orange, the middles of the sheets
// that the volume shows (ridges, 3 x n) green, and crosses where it shows the coaptation line. on_line: a
// sentence on that, for below the picture.
PageImage closed_picture(const std::filesystem::path& folder, const Volume& closed,
                         const PicturedValve& there, const Points& ridges,
                         const std::vector<LineInImage>& line, const std::string& on_line);

}  // namespace coapt::cli
