// Echoes in the coordinates of the beams: azimuth, elevation and depth from the probe.
#pragma once

#include "core/types.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <vector>

namespace coapt {

struct Probe {
  Vec3 position = Vec3::Zero();                        // [mm]
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  // columns: azimuth, elevation, central beam

  // Azimuth and elevation [rad] and depth [mm] of a position in front of the probe, and back.
  Vec3 beam_of(const Vec3& position) const;
  Vec3 position_of(const Vec3& beam) const;
};

// Complex amplitudes of echoes on a regular grid of azimuth, elevation and depth.
class BeamField {
 public:
  // Covers [low, high], and around it as far as a spread reaches. Steps are half a standard deviation of the
  // spread. Throws InputError for more than 2e8 cells.
  BeamField(const Vec3& low, const Vec3& high, const Vec3& step);

  std::array<int, 3> size() const { return size_; }  // depth runs fastest in cell(): last entry
  Vec3 beam(const Vec3& cell) const { return low_ + cell.cwiseProduct(step_); }
  Vec3 cell(const Vec3& beam) const { return (beam - low_).cwiseQuotient(step_); }
  std::complex<float>& at(int azimuth, int elevation, int depth) {
    return values_[index(azimuth, elevation, depth)];
  }

  // Adds an echo between cells to the eight around it, as it is nearer to each; beyond the grid nothing.
  void add(const Vec3& cell, std::complex<float> amplitude);

  // Convolves with a Gaussian of two cells along all axes, of unit energy: independent cells keep their mean
  // square.
  void spread();

  // Modulus of the linear interpolation between cells; 0 beyond the grid.
  float envelope(const Vec3& cell) const;

 private:
  std::size_t index(int azimuth, int elevation, int depth) const {
    return static_cast<std::size_t>(depth) +
           static_cast<std::size_t>(size_[2]) *
               (static_cast<std::size_t>(elevation) +
                static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(azimuth));
  }
  bool corners(const Vec3& cell, std::array<std::size_t, 8>& places, std::array<float, 8>& weights) const;

  Vec3 low_, step_;
  std::array<int, 3> size_{};
  std::vector<std::complex<float>> values_;
};

}  // namespace coapt
