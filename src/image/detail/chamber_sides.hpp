// Which side of a valve a place is on, whether the valve is open or closed.
#pragma once

#include "image/detail/valve_frame.hpp"
#include "mesh/triangle_mesh.hpp"

#include <array>
#include <vector>

namespace coapt {

// The leaflets, the gap between their free edges (closed by a cone) and the plane around the annulus are one
// surface through which every line along the axis passes once, counted by direction; what lies below it is
// the ventricle's.
class ChamberSides {
 public:
  // pitch: distance of the lines along the axis that are looked at [mm]; places between take the nearest.
  // Pre: the mesh is manifold and consistently oriented.
  ChamberSides(const ValveFrame& frame, const TriangleMesh& surface, const std::vector<int>& annulus,
               double pitch);

  bool is_ventricle(const Vec3& position) const;

 private:
  struct Crossing {
    float height = 0;  // [mm]
    int direction = 0;
  };

  void add(const Vec3& a, const Vec3& b, const Vec3& c);
  double height_around(double x, double y) const;
  std::array<int, 2> column(double x, double y) const;

  ValveFrame frame_;
  double pitch_ = 0, low_x_ = 0, low_y_ = 0;
  int columns_x_ = 0, columns_y_ = 0;
  std::vector<std::vector<Crossing>> crossings_;  // of each line
  std::vector<char> is_around_;                   // of each line: outside the annulus
  std::vector<float> height_;                     // of the annulus nearest to each line outside it [mm]
  int sign_ = 1;
};

}  // namespace coapt
