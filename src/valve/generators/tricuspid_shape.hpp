// The smooth shape behind the generated tricuspid valves: where a point of the three leaflets lies when the
// valve is open (stress-free) and, approximately, when it is closed.
//
// Frame: z points from the ventricle (-z) to the atrium (+z), the annulus lies around z = 0; x is its long
// axis. Lengths in mm.
#pragma once

#include "core/types.hpp"

#include <array>

namespace coapt {

// The defaults are a mean valve; docs/generators.md says where they come from.
struct TricuspidDimensions {
  double long_radius = 20.5, short_radius = 17.5;     // of the open annulus [mm]
  double flatness = 0.06;                             // of the septal side; 0 is an ellipse
  double saddle_open = 3, saddle_closed = 4;          // annular height [mm]
  double contraction = 0.12;                          // loss of annulus area on closing, as a fraction
  std::array<double, 3> shares = {0.39, 0.28, 0.33};  // of the annulus; their sum is 1
  std::array<double, 3> heights = {23, 20.5, 19.5};   // of the leaflets in their middle [mm]
  double commissural_height = 10;                     // [mm]
  double hinge_angle = 50, edge_angle = 66;           // of the open leaflets below the horizontal [deg]
  double tenting_height = 6;                          // of the closed leaflets' meeting point [mm]
  std::array<double, 2> meeting_point = {0, 0};       // x and y of that point [mm]
};

// The surface by two coordinates. u in [0, 1) runs once around, anticlockwise seen from the atrium, in equal
// steps of the annulus' angle: first leaflet ("anterior") from 0, then "posterior" and "septal". t in [0, 1]
// is the fraction of the height, from the annulus to the free edge. Pre: 0 <= t <= 1.
Vec3 tricuspid_open_point(const TricuspidDimensions& dimensions, double u, double t);

// By construction, not by equilibrium: each meridian keeps its length, runs in a slight dome from the closed
// annulus to the three lines between the commissures and the meeting point and hangs down from there.
Vec3 tricuspid_closed_point(const TricuspidDimensions& dimensions, double u, double t);

}  // namespace coapt
