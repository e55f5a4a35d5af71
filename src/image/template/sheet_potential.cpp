#include "image/template/sheet_potential.hpp"

#include "image/routes/distance_from_sheet.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr float kStrongest = 1.5F;  // strength that counts at most
constexpr double kFarShown = 0.5;   // strength from which a voxel draws from afar
constexpr double kFarReach = 5;     // [mm]
constexpr double kFarHeight = 0.5;  // of the potential, there

}  // namespace

SplineField sheet_potential(const Volume& strength) {
  Volume potential = distance_from_sheet(strength, kFarShown);
  for (size_t voxel = 0; voxel < potential.values.size(); ++voxel) {
    const double far = std::clamp(potential.values[voxel] / kFarReach, 0.0, 1.0);
    potential.values[voxel] =
        static_cast<float>(kFarHeight * far - std::min(strength.values[voxel], kStrongest));
  }
  return SplineField(std::move(potential));
}

}  // namespace coapt
