#include "image/detail/beam_field.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr double kMostCells = 2e8;             // of the grid; eight bytes each
constexpr double kDeviation = 2;               // of the spread [cells]
constexpr int kReach = 6;                      // of the spread: three standard deviations [cells]
constexpr std::size_t kTaps = 2 * kReach + 1;  // of its kernel

std::array<float, kTaps> spread_weights() {
  std::array<double, kTaps> weights{};
  double energy = 0;
  for (int k = -kReach; k <= kReach; ++k) {
    const double weight = std::exp(-0.5 * (k / kDeviation) * (k / kDeviation));
    weights[static_cast<std::size_t>(k + kReach)] = weight;
    energy += weight * weight;
  }
  std::array<float, kTaps> of_unit_energy{};
  for (std::size_t k = 0; k < kTaps; ++k)
    of_unit_energy[k] = static_cast<float>(weights[k] / std::sqrt(energy));
  return of_unit_energy;
}

}  // namespace

Vec3 Probe::beam_of(const Vec3& at) const {
  const Vec3 p = axes.transpose() * (at - position);
  return {std::atan2(p.x(), p.z()), std::atan2(p.y(), p.z()), p.norm()};
}

Vec3 Probe::position_of(const Vec3& beam) const {
  return position + axes * (Vec3(std::tan(beam.x()), std::tan(beam.y()), 1).normalized() * beam.z());
}

BeamField::BeamField(const Vec3& low, const Vec3& high, const Vec3& step) : step_(step) {
  low_ = low - kReach * step;
  double cells = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const double count = std::ceil((high[axis] - low[axis]) / step[axis]) + 2 * kReach + 1;
    cells *= count;
    if (!(cells <= kMostCells))
      throw InputError("the image would need more than " + number_text(kMostCells) +
                       " cells of its beams; choose a greater spread (--psf) or a smaller margin");
    size_[static_cast<std::size_t>(axis)] = static_cast<int>(count);
  }
  values_.resize(static_cast<std::size_t>(cells));
}

bool BeamField::corners(const Vec3& cell, std::array<std::size_t, 8>& places,
                        std::array<float, 8>& weights) const {
  std::array<int, 3> low{};
  std::array<double, 3> share{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double at = cell[static_cast<Eigen::Index>(axis)];
    if (!(at >= 0 && at < size_[axis] - 1)) return false;
    low[axis] = static_cast<int>(at);
    share[axis] = at - low[axis];
  }
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const int a = corner & 1, e = corner >> 1 & 1, d = corner >> 2 & 1;
    places[corner] = index(low[0] + a, low[1] + e, low[2] + d);
    weights[corner] = static_cast<float>((a ? share[0] : 1 - share[0]) * (e ? share[1] : 1 - share[1]) *
                                         (d ? share[2] : 1 - share[2]));
  }
  return true;
}

void BeamField::add(const Vec3& cell, std::complex<float> amplitude) {
  std::array<std::size_t, 8> places{};
  std::array<float, 8> weights{};
  if (!corners(cell, places, weights)) return;
  for (std::size_t k = 0; k < 8; ++k) values_[places[k]] += weights[k] * amplitude;
}

void BeamField::spread() {
  const std::array<float, kTaps> weights = spread_weights();
  const std::array<std::size_t, 3> strides{
      static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(size_[2]),
      static_cast<std::size_t>(size_[2]), 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto count = static_cast<std::size_t>(size_[axis]);
    std::vector<std::complex<float>> line(count + 2 * kReach);
    for (std::size_t start = 0; start < values_.size(); ++start) {
      if (start / strides[axis] % count != 0) continue;
      for (std::size_t k = 0; k < count; ++k) line[k + kReach] = values_[start + k * strides[axis]];
      for (std::size_t k = 0; k < count; ++k) {
        std::complex<float> sum = 0;
        for (std::size_t tap = 0; tap < kTaps; ++tap) sum += weights[tap] * line[k + tap];
        values_[start + k * strides[axis]] = sum;
      }
    }
  }
}

float BeamField::envelope(const Vec3& cell) const {
  std::array<std::size_t, 8> places{};
  std::array<float, 8> weights{};
  if (!corners(cell, places, weights)) return 0;
  std::complex<float> sum = 0;
  for (std::size_t k = 0; k < 8; ++k) sum += weights[k] * values_[places[k]];
  return std::abs(sum);
}

}  // namespace coapt
