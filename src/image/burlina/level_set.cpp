#include "image/burlina/level_set.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace coapt {
namespace {

constexpr float kStep = 2;          // of psi where a contour begins, and beyond the narrow band
constexpr double kGrownVoxels = 5;  // of a free contour, between two looks at how much it has grown

// p'(s) / s of the double-well potential of Li et al. 2010.
float double_well(float s) {
  const float turn = 2 * std::numbers::pi_v<float> * s;
  if (s <= 1) return s < 1e-4F ? 1 : std::sin(turn) / turn;
  return 1 - 1 / s;
}

// One psi with its narrow band.
class Contour {
 public:
  Contour(const Volume& g, const Vec3& seed, double radius, const LevelSetOptions& options);
  void step(const std::vector<Contour>& all);
  const Volume& psi() const { return psi_; }
  double growth();  // share of its volume since this was last asked

 private:
  struct Flux {
    float distance = 0, area = 0;
  };
  bool is_inside_grid(int i, int j, int k) const {
    return i >= 2 && j >= 2 && k >= 2 && i < psi_.size[0] - 2 && j < psi_.size[1] - 2 && k < psi_.size[2] - 2;
  }
  Flux flux(size_t voxel, size_t axis);
  void find_band(const std::vector<uint32_t>& around);
  float change(size_t voxel, const std::vector<Contour>& all);

  const Volume& g_;
  const LevelSetOptions& options_;
  Volume psi_;
  std::array<size_t, 3> stride_;
  std::array<float, 3> scale_;  // of a difference along each axis
  std::vector<uint32_t> band_, looked_at_;
  std::vector<uint32_t> in_band_;  // the round in which a voxel was last put into the band
  uint32_t round_ = 0;
  std::array<std::vector<uint32_t>, 3> known_;  // the step at which the flux through the upper face was found
  std::array<std::vector<Flux>, 3> fluxes_;
  uint32_t step_ = 0;
  size_t inside_ = 0, inside_before_ = 0;
};

Contour::Contour(const Volume& g, const Vec3& seed, double radius, const LevelSetOptions& options)
    : g_(g), options_(options), psi_(volume_like(g, kStep)) {
  stride_ = {1, static_cast<size_t>(g.size[0]),
             static_cast<size_t>(g.size[0]) * static_cast<size_t>(g.size[1])};
  for (size_t axis = 0; axis < 3; ++axis) {
    scale_[axis] = static_cast<float>(g.spacing.minCoeff() / g.spacing[static_cast<Eigen::Index>(axis)]);
    known_[axis].assign(g.values.size(), 0);
    fluxes_[axis].resize(g.values.size());
  }
  in_band_.assign(g.values.size(), 0);
  std::vector<uint32_t> around;
  for (int k = 2; k < g.size[2] - 2; ++k)
    for (int j = 2; j < g.size[1] - 2; ++j)
      for (int i = 2; i < g.size[0] - 2; ++i) {
        around.push_back(static_cast<uint32_t>(g.voxel(i, j, k)));
        if ((position_of(g, Vec3(i, j, k)) - seed).norm() <= radius) {
          psi_.values[around.back()] = -kStep;
          ++inside_;
        }
      }
  if (inside_ == 0)
    throw InputError("a seed of a chamber lies outside of the volume, or on its rim; --seeds moves it");
  inside_before_ = inside_;
  find_band(around);
}

// The voxels within one of a change of sign, which is looked for in `around`.
void Contour::find_band(const std::vector<uint32_t>& around) {
  ++round_;
  std::vector<uint32_t> band;
  const std::vector<float>& psi = psi_.values;
  for (const uint32_t voxel : around) {
    const bool is_in = psi[voxel] < 0;
    const bool crosses = std::any_of(stride_.begin(), stride_.end(), [&](size_t stride) {
      return (psi[voxel + stride] < 0) != is_in || (psi[voxel - stride] < 0) != is_in;
    });
    if (!crosses) continue;
    for (int n = 0; n < 27; ++n) {
      const auto other = static_cast<size_t>(static_cast<std::ptrdiff_t>(voxel) + (n % 3 - 1) +
                                             (n / 3 % 3 - 1) * static_cast<std::ptrdiff_t>(stride_[1]) +
                                             (n / 9 - 1) * static_cast<std::ptrdiff_t>(stride_[2]));
      if (in_band_[other] == round_) continue;
      in_band_[other] = round_;
      const auto at = static_cast<int>(other);
      const int i = at % psi_.size[0], j = at / psi_.size[0] % psi_.size[1],
                k = at / psi_.size[0] / psi_.size[1];
      if (is_inside_grid(i, j, k)) band.push_back(static_cast<uint32_t>(other));
    }
  }
  for (const uint32_t voxel : band)  // those that are new in it
    if (std::abs(psi[voxel]) > kStep) psi_.values[voxel] = std::copysign(kStep, psi[voxel]);
  band_ = std::move(band);
}

// Through the face to the next voxel along an axis.
Contour::Flux Contour::flux(size_t voxel, size_t axis) {
  Flux& flux = fluxes_[axis][voxel];
  if (known_[axis][voxel] == step_) return flux;
  known_[axis][voxel] = step_;
  const float* psi = psi_.values.data();
  const size_t next = voxel + stride_[axis];
  const float along = scale_[axis] * (psi[next] - psi[voxel]);
  float squared = along * along;
  for (size_t other = 0; other < 3; ++other) {
    if (other == axis) continue;
    const size_t stride = stride_[other];
    const float across =
        0.25F * scale_[other] *
        (psi[voxel + stride] - psi[voxel - stride] + psi[next + stride] - psi[next - stride]);
    squared += across * across;
  }
  const float slope = std::sqrt(squared);
  flux.distance = double_well(slope) * along;
  flux.area = 0.5F * (g_.values[voxel] + g_.values[next]) * along / (slope + 1e-6F);
  return flux;
}

// Eq. 9 at one voxel.
float Contour::change(size_t voxel, const std::vector<Contour>& all) {
  float distance = 0, area = 0;
  for (size_t axis = 0; axis < 3; ++axis) {
    const Flux above = flux(voxel, axis), below = flux(voxel - stride_[axis], axis);
    distance += scale_[axis] * (above.distance - below.distance);
    area += scale_[axis] * (above.area - below.area);
  }
  float change = static_cast<float>(options_.distance_weight) * distance;
  const float psi = psi_.values[voxel], width = static_cast<float>(options_.delta_width);
  const bool is_taken = std::any_of(all.begin(), all.end(), [&](const Contour& other) {
    return &other != this && other.psi_.values[voxel] < width;
  });
  if (is_taken || std::abs(psi) >= width) return change;
  const float delta = (1 + std::cos(std::numbers::pi_v<float> * psi / width)) / (2 * width);
  change += delta * (static_cast<float>(options_.area_weight) * area +
                     static_cast<float>(options_.volume_weight) * g_.values[voxel]);
  return change;
}

void Contour::step(const std::vector<Contour>& all) {
  ++step_;
  std::vector<float> changes(band_.size());
  for (size_t n = 0; n < band_.size(); ++n) changes[n] = change(band_[n], all);
  for (size_t n = 0; n < band_.size(); ++n) {
    float& psi = psi_.values[band_[n]];
    const bool was_in = psi < 0;
    psi += changes[n];
    if (was_in != (psi < 0)) inside_ += was_in ? size_t(-1) : size_t(1);
  }
  looked_at_ = band_;
  find_band(looked_at_);
}

double Contour::growth() {
  const double grown =
      static_cast<double>(inside_) / static_cast<double>(std::max<size_t>(inside_before_, 1)) - 1;
  inside_before_ = inside_;
  return grown;
}

}  // namespace

LevelSets grown_contours(const std::vector<Volume>& inhibitions, const std::vector<Vec3>& seeds,
                         double radius, const LevelSetOptions& options) {
  std::vector<Contour> contours;
  contours.reserve(seeds.size());
  for (size_t n = 0; n < seeds.size(); ++n) contours.emplace_back(inhibitions[n], seeds[n], radius, options);
  LevelSets found;
  // Where the delta is greatest, 1 / delta_width, a free contour grows by this much in a step.
  const double speed = std::abs(options.volume_weight) / options.delta_width;
  const int steps_of_growth = std::max(1, static_cast<int>(std::lround(kGrownVoxels / speed)));
  while (!found.is_done && found.steps < options.greatest_steps) {
    for (Contour& contour : contours) contour.step(contours);
    if (++found.steps % steps_of_growth != 0) continue;
    double greatest = 0;
    for (Contour& contour : contours) greatest = std::max(greatest, contour.growth());
    found.is_done = greatest < options.least_growth;
  }
  for (const Contour& contour : contours) found.psi.push_back(contour.psi());
  return found;
}

}  // namespace coapt
