// Points and curves of 3D Slicer (.mrk.json), as SlicerHeart keeps annulus curves and papillary points.
#pragma once

#include "core/types.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

struct Markup {
  std::string name;
  std::string type = "Fiducial";         // Fiducial, Curve, ClosedCurve, ...
  Points points = Points(3, 0);          // 3 x n, in LPS [mm]
  std::vector<std::string> labels = {};  // of the points; may be empty
};

// True for a path that ends in .mrk.json.
bool is_markup_file(const std::filesystem::path& path);

// Reads all markups of a file. Positions in RAS ("RAS", or 0 as older files have it) are turned to LPS (x and
// y change their sign); no statement means LPS. Units other than mm are converted. Points that are not placed
// ("positionStatus" other than "defined") are left out. Throws InputError with all defects, each naming file
// and entry: also of coordinates beyond kGreatestCoordinate.
std::vector<Markup> read_markups(const std::filesystem::path& path);

// Writes "coordinateSystem": "LPS". Throws InputError when the file cannot be written.
void write_markups(const std::filesystem::path& path, const std::vector<Markup>& markups);

// The first closed curve of the file, else its first open curve, else its points in their order: at least
// three, not all at one place. The points of all lists of points (Fiducial) of the file: at least one. Throw
// InputError where there are none.
Points annulus_curve(const std::filesystem::path& path);
Points papillary_points(const std::filesystem::path& path);

}  // namespace coapt
