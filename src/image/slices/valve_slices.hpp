// The planes in which a valve is looked at, and the picture of a volume in them.
#pragma once

#include "image/slices/slice_picture.hpp"

#include <optional>
#include <vector>

namespace coapt {

// Three planes along the axis of an annulus, up to the atrium where `ventricle` says which side that is: two
// across its longest diameter, at a third and at two thirds of it, and one along it. Each is 1.6 diameters
// wide and high. annulus: closed curve, 3 x n [mm]. Pre: it has a length and an area.
std::vector<SlicePlane> valve_planes(const Points& annulus, const std::optional<Vec3>& ventricle);

// Three planes through the middle of a volume, each along two of its axes.
std::vector<SlicePlane> middle_planes(const Volume& volume);

struct DrawnSurface {
  TriangleMesh surface;  // [mm]
  Colour colour;
};
struct DrawnPoints {
  Points points;  // 3 x n [mm]
  Colour colour;
};

// The planes from left to right, half a voxel's edge to a pixel, within 120 to 480 pixels of the greatest
// width; surfaces over points, points within a voxel's edge of the plane. Pre: at least one plane.
Picture valve_slices(const Volume& volume, const std::vector<SlicePlane>& planes,
                     const std::vector<DrawnSurface>& surfaces, const std::vector<DrawnPoints>& points);

}  // namespace coapt
