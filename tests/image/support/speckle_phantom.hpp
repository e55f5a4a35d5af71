// Volumes for tests: a surface with some thickness in blood, as ultrasound shows it or plainly.
#pragma once

#include "image/volume.hpp"
#include "mesh/triangle_mesh.hpp"

#include <functional>

namespace coapt::testing {

struct PhantomOptions {
  double voxel = 0.8;    // [mm]
  double thickness = 1;  // [mm]
  double spread = 0.6;   // standard deviation of the amplitude's point spread [mm]
  double margin = 6;     // around the surface [mm]
  unsigned seed = 1;
  Eigen::Matrix3d direction = Eigen::Matrix3d::Identity();
  std::function<bool(const Vec3&)> is_dropped_out = {};  // places of the leaflet that are not seen
};

inline constexpr double kPhantomRange = 50;  // between 0 and 255 [dB]

// Ultrasound: circular complex Gaussian scatterers, leaflets 30 dB above blood, blurred by a Gaussian, the
// logarithm of their envelope as 0 to 255.
Volume speckle_volume(const TriangleMesh& surface, const PhantomOptions& options);

// As a micro-CT: 100 in the leaflets, 0 outside, between in voxels on their sides, with a little noise.
Volume plain_volume(const TriangleMesh& surface, const PhantomOptions& options);

}  // namespace coapt::testing
