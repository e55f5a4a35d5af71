// A plane cut through a volume as a picture, with what surfaces leave in that plane drawn on it.
#pragma once

#include "image/volume.hpp"
#include "mesh/triangle_mesh.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace coapt {

// Rows from the top, pixels from the left, red, green and blue of each.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> colours;  // 3 * width * height
};

using Colour = std::array<std::uint8_t, 3>;

// Pre: `right` and `up` are unit vectors, orthogonal; the lengths are positive.
struct SlicePlane {
  Vec3 centre = Vec3::Zero();  // of the picture [mm]
  Vec3 right = Vec3::UnitX(), up = Vec3::UnitY();
  double width = 0, height = 0;  // of what is seen [mm]
};

// The values that are drawn black and white.
struct GreyRange {
  double black = 0, white = 1;
};

// Those that 0.5 % of the voxels lie below and above; the least and the greatest value where these two are
// the same. Pre: the volume has values.
GreyRange grey_range(const Volume& volume);

// Trilinear between voxels, black outside of the volume; pixels are squares with this edge [mm].
Picture slice_picture(const Volume& volume, const SlicePlane& plane, double pixel, const GreyRange& range);

// Draws the lines in which the plane of the picture cuts a surface. Pre: picture is of this plane and pixel.
void draw_section(Picture& picture, const SlicePlane& plane, double pixel, const TriangleMesh& surface,
                  const Colour& colour);

// Draws the points (3 x n) [mm] that lie within `reach` of the plane [mm].
void draw_points(Picture& picture, const SlicePlane& plane, double pixel, const Points& points, double reach,
                 const Colour& colour);

// From left to right, on black, with a white gap of four pixels between two.
Picture side_by_side(const std::vector<Picture>& pictures);

// Throws InputError where the file cannot be written.
void write_png(const std::filesystem::path& path, const Picture& picture);

}  // namespace coapt
