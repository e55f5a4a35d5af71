// The coaptation line of solved leaflets beside that which a volume of the closed valve shows.
#pragma once

#include "image/segment/line_in_image.hpp"
#include "mesh/seams.hpp"
#include "registration/rigid_motion.hpp"
#include "results/reference/distance_figures.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt::cli {

struct ImageLine {
  std::vector<LineInImage> pieces;  // in the frame of the solved leaflets
  double shown_share = 0;           // of the predicted line, by length; 0 without a line
  DistanceFigures to_predicted;  // from where the image shows it to the predicted line [mm]; NaN: not shown
};

// The pieces of a line, moved [mm].
std::vector<Points> pieces_of(const std::vector<Seam>& line, const Vec3& shift);

// The outcome of line_in_image(), which is in the frame of the closed volume, after this motion.
ImageLine compared_line(std::vector<LineInImage> pieces, const RigidMotion& motion);

// One sentence for a terminal or a page.
std::string sentence_on(const ImageLine& line);

// The places where the image shows the line, as small crosses of six arms along the axes, so that a slice
// that they pass through shows a mark. 3 x n [mm].
Points marks_of(const std::vector<LineInImage>& pieces, double arm);

// coaptation_lines.vtp into a folder: both lines, with `in_image` 0 and 1 on each stretch, and at the points
// `likeness` and the distance between the two. Stretches that the image does not show are not there.
void write_image_line(const std::filesystem::path& folder, const ImageLine& line);

}  // namespace coapt::cli
