#include "core/error.hpp"
#include "image/detail/echoes.hpp"
#include "image/phantom.hpp"

#include <algorithm>
#include <numeric>

namespace coapt {
namespace {

constexpr double kLeastPatch = 1.5, kMostPatch = 4;  // radius of a patch of dropout [mm]
constexpr double kLeastSpot = 1, kMostSpot = 2.5;    // radius of a bright spot [mm]
constexpr int kMostPatches = 100000;                 // that are tried: on a coarse mesh most meet no centroid

Vec3 place_of(const TriangleMesh& surface, int t, const Vec3& weights) {
  const Eigen::Vector3i corners = surface.triangles.col(t);
  return weights[0] * surface.vertices.col(corners[0]) + weights[1] * surface.vertices.col(corners[1]) +
         weights[2] * surface.vertices.col(corners[2]);
}

// A place of the surface, each part as likely as its area is great. sums: of the areas of all triangles up to
// each.
PhantomPattern::Spot any_place(const std::vector<double>& sums, RandomSource& random) {
  const auto at = std::upper_bound(sums.begin(), sums.end(), random.unit() * sums.back());
  PhantomPattern::Spot spot;
  spot.triangle = static_cast<int>(std::min(at, sums.end() - 1) - sums.begin());
  double u = random.unit(), v = random.unit();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  spot.weights = Vec3(1 - u - v, u, v);
  return spot;
}

std::vector<char> dropout_patches(const TriangleMesh& surface, const std::vector<double>& areas,
                                  const std::vector<double>& sums, const PhantomOptions& options) {
  std::vector<char> is_faint(areas.size(), 0);
  RandomSource random = echo_source(options.seed, EchoStream::Dropouts);
  const double wanted = options.dropout * sums.back();
  double covered = 0;
  for (int patch = 0; patch < kMostPatches && covered < wanted; ++patch) {
    const PhantomPattern::Spot spot = any_place(sums, random);
    const Vec3 middle = place_of(surface, spot.triangle, spot.weights);
    const double radius = random.between(kLeastPatch, kMostPatch);
    for (std::size_t t = 0; t < areas.size() && covered < wanted; ++t) {
      const Vec3 centroid = place_of(surface, static_cast<int>(t), Vec3::Constant(1.0 / 3));
      if (is_faint[t] || (centroid - middle).norm() > radius) continue;
      is_faint[t] = 1;
      covered += areas[t];
    }
  }
  return is_faint;
}

}  // namespace

PhantomPattern phantom_pattern(const TriangleMesh& open, const PhantomOptions& options) {
  std::vector<double> areas;
  for (const auto& t : open.triangles.colwise()) areas.push_back(area_vector(open.vertices, t).norm());
  std::vector<double> sums(areas.size());
  std::partial_sum(areas.begin(), areas.end(), sums.begin());
  if (sums.empty() || !(sums.back() > 0))
    throw InputError("the leaflets have no area; no image can be made of them");
  PhantomPattern pattern;
  pattern.dropouts = dropout_patches(open, areas, sums, options);
  RandomSource random = echo_source(options.seed, EchoStream::Shadows);
  for (int k = 0; k < options.shadows; ++k) {
    pattern.spots.push_back(any_place(sums, random));
    pattern.spots.back().radius = random.between(kLeastSpot, kMostSpot);
  }
  return pattern;
}

}  // namespace coapt
