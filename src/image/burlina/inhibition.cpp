#include "image/burlina/inhibition.hpp"

#include "core/error.hpp"
#include "image/itk/gradient_magnitude.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kGradientsOfBlood = 1;  // at which an edge has halved the speed
constexpr double kDeviationOfMedian =
    1.4826;  // standard deviation over the median departure, of a normal distribution

double median_of(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

std::vector<float> values_in_ball(const Volume& volume, const Vec3& centre, double radius) {
  std::vector<float> values;
  for (int k = 0; k < volume.size[2]; ++k)
    for (int j = 0; j < volume.size[1]; ++j)
      for (int i = 0; i < volume.size[0]; ++i)
        if ((position_of(volume, Vec3(i, j, k)) - centre).norm() <= radius)
          values.push_back(volume.values[volume.voxel(i, j, k)]);
  return values;
}

Volume edge_inhibition(const Volume& volume, double scale, const Vec3& seed, double radius) {
  Volume inhibition = gradient_magnitude(volume, scale);
  const std::vector<float> blood = values_in_ball(inhibition, seed, radius);
  if (blood.empty()) throw InputError("a seed of a chamber lies outside of the volume; --seeds moves it");
  const auto half = static_cast<float>(kGradientsOfBlood * median_of(blood));
  if (!(half > 0))
    throw InputError("all values around the seed of a chamber are the same; --seeds moves it into blood");
  for (float& value : inhibition.values) value = 1 / (1 + (value / half) * (value / half));
  return inhibition;
}

Volume intensity_inhibition(const Volume& volume, const Vec3& seed, double radius) {
  const std::vector<float> blood = values_in_ball(volume, seed, radius);
  if (blood.empty()) throw InputError("a seed of a chamber lies outside of the volume; --seeds moves it");
  const double middle = median_of(blood);
  std::vector<float> departures;
  for (const float value : blood) departures.push_back(static_cast<float>(std::abs(value - middle)));
  const double deviation = kDeviationOfMedian * median_of(departures);
  if (!(deviation > 0))
    throw InputError("all values around the seed of a chamber are the same; --seeds moves it into blood");
  Volume inhibition = volume;
  for (float& value : inhibition.values) {
    const double departure = (value - middle) / deviation;
    value = static_cast<float>(std::exp(-0.5 * departure * departure));
  }
  return inhibition;
}

}  // namespace coapt
