#include "cli/images/close_pictures.hpp"

#include "cli/images/image_line.hpp"
#include "image/slices/valve_slices.hpp"

namespace coapt::cli {
namespace {

// Okabe and Ito, "Color universal design", 2008: told apart by every eye, and seen on grey.
constexpr Colour kFoundColour = {86, 180, 233}, kSolvedColour = {230, 159, 0}, kRidgeColour = {0, 158, 115},
                 kLineColour = {240, 228, 66};
constexpr double kMark = 1.5;  // arm of a mark [mm]

}  // namespace

PageImage open_picture(const std::filesystem::path& folder, const PicturedValve& valve) {
  const std::filesystem::path file = folder / "slices_open.png";
  write_png(file, valve_slices(valve.open, valve_planes(valve.annulus, valve.ventricle),
                               {{valve.found, kFoundColour}, {valve.solved, kSolvedColour}}, {}));
  return {
      file,
      "The open volume along the axis of the annulus, twice across its longest diameter and once along it, "
      "the atrium above. Blue: the leaflets that were found. Orange: closed."};
}

PageImage closed_picture(const std::filesystem::path& folder, const Volume& closed,
                         const PicturedValve& there, const Points& ridges,
                         const std::vector<LineInImage>& line, const std::string& on_line) {
  const std::filesystem::path file = folder / "slices_closed.png";
  write_png(file, valve_slices(closed, valve_planes(there.annulus, there.ventricle),
                               {{there.solved, kSolvedColour}},
                               {{ridges, kRidgeColour}, {marks_of(line, kMark), kLineColour}}));
  return {
      file,
      "The closed volume in the same planes of its annulus. Orange: the closed leaflets. Green: the middles "
      "of the sheets that this volume shows. Yellow crosses: its coaptation line, where it is seen; " +
          on_line + "."};
}

}  // namespace coapt::cli
