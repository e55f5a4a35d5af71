// Burlina et al. 2010, eq. 1 to 6 and 9: a contour that grows in a cavity until it is inhibited.
#pragma once

#include "image/volume.hpp"

#include <vector>

namespace coapt {

// Of eq. 3 and 4, in voxels (the least spacing) and steps; the paper gives no numbers.
struct LevelSetOptions {
  double distance_weight =
      0.1;                   // mu: how strongly psi is kept a distance; below 1/6 explicit steps are stable
  double area_weight = 0.2;  // lambda
  double volume_weight = -0.75;  // nu, negative: the contour expands, by half a voxel a step where g is 1
  double delta_width = 1.5;      // of the smoothed Dirac delta, to each side
  int greatest_steps = 600;
  // Share of its volume by which a contour grows while a free one would by five voxels, below which it is
  // done.
  double least_growth = 5e-3;
};

// psi < 0 within each contour. All start as balls of this radius [mm] around their seeds and grow in the same
// steps; where one is no other comes. inhibitions: g of each, on one grid.
//
// Eq. 9 with three departures, each after Li et al. 2010 (Distance regularized level set evolution and its
// application to image segmentation): the penalty is the double-well potential, because the printed one,
// whose diffusion is unbounded backwards where psi is flat, makes ripples far from the contour; psi is kept
// in a narrow band around it only; and it starts as a step, not as a distance. Divergences are sums of fluxes
// through the faces of voxels.
//
// Throws InputError where a seed's ball holds no voxel. Pre: as many seeds as inhibitions, of one grid.
struct LevelSets {
  std::vector<Volume> psi;
  int steps = 0;
  bool is_done = false;  // else the greatest number of steps was reached
};
LevelSets grown_contours(const std::vector<Volume>& inhibitions, const std::vector<Vec3>& seeds,
                         double radius, const LevelSetOptions& options);

}  // namespace coapt
