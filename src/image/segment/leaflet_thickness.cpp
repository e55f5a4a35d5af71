#include "image/segment/leaflet_thickness.hpp"

#include "image/segment/speckle_blur.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kProfileReach = 2.6, kPatch = 1.6;  // of the profiles that thickness is fitted to [mm]
constexpr double kPlainBlur = 0.5;                   // of an image without speckle, in voxels

// Linear interpolation smooths by this much on average: f (1 - f) squared voxels of variance at the fraction
// f.
double interpolation_variance(const Volume& volume) { return volume.spacing.squaredNorm() / 3 / 6; }

}  // namespace

double median_of_finite(const Vector& values) {
  std::vector<double> finite;
  for (const double value : values)
    if (std::isfinite(value)) finite.push_back(value);
  if (finite.empty()) return 0;
  const auto middle = finite.begin() + static_cast<std::ptrdiff_t>(finite.size() / 2);
  std::nth_element(finite.begin(), middle, finite.end());
  return *middle;
}

Vector blur_across(const Volume& volume, const LayerGrid& grid, const std::vector<char>& is_seen,
                   const std::optional<double>& given, const GreyScale& scale) {
  if (given) return Vector::Constant(grid.points.cols(), *given);
  if (scale.is_logarithmic())
    if (const std::optional<Vec3> spread = speckle_blur(volume, grid, is_seen)) {
      const Points normals = volume.direction.transpose() * grid.normals;
      const Vector variances = (spread->asDiagonal() * normals).colwise().squaredNorm();
      return (variances.array() + interpolation_variance(volume)).sqrt();
    }
  return Vector::Constant(grid.points.cols(), kPlainBlur * volume.spacing.mean());
}

Vector thickness_at_vertices(const Volume& volume, const LayerGrid& grid, const LayerMesh& mesh,
                             const Vector& blur, const GreyScale& scale) {
  const WallProfiles profiles = wall_profiles(volume, grid, kProfileReach, kPatch);
  Vector thickness = Vector::Constant(mesh.mesh.vertex_count(), kNaN);
  for (int v = 0; v < mesh.mesh.vertex_count(); ++v) {
    Eigen::Index corner = 0;
    mesh.weights.col(v).maxCoeff(&corner);
    const Eigen::Index node = mesh.nodes(corner, v);
    const WallFit fit = fit_wall(profiles, node, blur[node], scale);
    if (fit.is_found) thickness[v] = fit.width;
  }
  return thickness;
}

}  // namespace coapt
