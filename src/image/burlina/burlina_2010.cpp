#include "image/burlina/burlina_2010.hpp"

#include "image/burlina/inhibition.hpp"
#include "image/burlina/thin_tissue.hpp"
#include "image/segment/sheet_evidence.hpp"

#include <cmath>
#include <numeric>

namespace coapt {
namespace {

constexpr double kSeedRadius = 3;                                       // of the first contours [mm]
constexpr double kShallowest = 0.5, kDeepest = 0.9, kDepthStep = 0.05;  // of the ventricle's, in diameters
constexpr float kThin = 0.5F;  // from which tissue is thin: twice as wide along the sheet as across it

double mean_in_ball(const Volume& volume, const Vec3& centre) {
  const std::vector<float> values = values_in_ball(volume, centre, kSeedRadius);
  return values.empty()
             ? kNaN
             : std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

Vec3 place_in_ventricle(const Volume& volume, const Vec3& middle, const Vec3& down, double diameter) {
  const double blood = mean_in_ball(volume, middle);
  Vec3 best = middle + kShallowest * diameter * down;
  double least = kInfinity;
  for (double depth = kShallowest; depth <= kDeepest; depth += kDepthStep) {
    const Vec3 place = middle + depth * diameter * down;
    const double apart = std::abs(mean_in_ball(volume, place) - blood);
    if (!(apart < least)) continue;  // also outside of the volume
    least = apart;
    best = place;
  }
  return best;
}

BurlinaSegmentation segment_burlina_2010(const Volume& volume, const BurlinaOptions& options) {
  BurlinaSegmentation found;
  const Volume smooth = without_speckle(volume);
  const std::vector<Vec3> seeds = {options.atrium, options.ventricle};
  std::vector<Volume> inhibitions;
  for (const Vec3& seed : seeds)
    inhibitions.push_back(options.inhibition == Inhibition::Edge
                              ? edge_inhibition(smooth, options.scale, seed, kSeedRadius)
                              : intensity_inhibition(smooth, seed, kSeedRadius));
  const LevelSetOptions usual = options.inhibition == Inhibition::Edge ? edge_level_set() : LevelSetOptions();
  const LevelSets contours =
      grown_contours(inhibitions, seeds, kSeedRadius, options.level_set.value_or(usual));
  found.steps = contours.steps;
  found.is_done = contours.is_done;
  found.thin_tissue = thin_tissue(volume, options.scale);
  found.chambers = volume_like(volume, 0);
  Volume left = volume_like(volume, 0);
  for (size_t voxel = 0; voxel < volume.values.size(); ++voxel) {
    if (contours.psi[0].values[voxel] < 0)
      found.chambers.values[voxel] = 1;
    else if (contours.psi[1].values[voxel] < 0)
      found.chambers.values[voxel] = 2;
    else if (found.thin_tissue.values[voxel] >= kThin)
      left.values[voxel] = 1;
  }
  found.leaflets = greatest_part(left, 0.5);
  return found;
}

}  // namespace coapt
