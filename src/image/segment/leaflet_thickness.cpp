#include "image/segment/leaflet_thickness.hpp"

#include "image/segment/speckle_blur.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kProfileReach = 2.6, kPatch = 1.6;  // of the profiles that thickness is fitted to [mm]
constexpr double kPlainBlur = 0.5;                   // of an image without speckle, in voxels

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
    if (const std::optional<SpeckleBlur> spread = speckle_blur(volume, grid, is_seen, scale)) {
      Vector blur(grid.points.cols());
      for (Eigen::Index node = 0; node < blur.size(); ++node)
        blur[node] = spread->at(grid.points.col(node))
                         .cwiseProduct(volume.direction.transpose() * grid.normals.col(node))
                         .norm();
      return blur;
    }
  return Vector::Constant(grid.points.cols(), kPlainBlur * volume.spacing.mean());
}

Vector thickness_at_vertices(const Volume& volume, const LayerGrid& grid, const LayerMesh& mesh,
                             const Vector& blur, double place_deviation, const GreyScale& scale) {
  const WallProfiles profiles = wall_profiles(volume, grid, kProfileReach, kPatch, place_deviation);
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
