#include "core/error.hpp"
#include "image/burlina/burlina_2010.hpp"
#include "image/burlina/inhibition.hpp"
#include "image/burlina/thin_tissue.hpp"
#include "image/phantom.hpp"
#include "image/segment/segment_leaflets.hpp"
#include "mesh/distance/surface_distance.hpp"
#include "mesh/mesh_check.hpp"
#include "valve/generators/mitral.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace coapt {
namespace {

// A cube with its centre in the origin.
Volume cube(int size, double spacing, const std::function<double(const Vec3&)>& value) {
  Volume volume;
  volume.size = {size, size, size};
  volume.spacing = Vec3::Constant(spacing);
  volume.origin = Vec3::Constant(-0.5 * spacing * (size - 1));
  volume.values.resize(static_cast<size_t>(size) * static_cast<size_t>(size) * static_cast<size_t>(size));
  for (int k = 0; k < size; ++k)
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i)
        volume.values[volume.voxel(i, j, k)] = static_cast<float>(value(position_of(volume, Vec3(i, j, k))));
  return volume;
}

double bump(double x) { return 100 * std::exp(-0.5 * x * x); }

TEST(ThinTissue, IsASheetAndNoTubeNoBallAndNothingDark) {
  const auto middle = [](const std::function<double(const Vec3&)>& value) {
    return sample(thin_tissue(cube(25, 0.5, value), 0.7), Vec3::Zero(), kNaN);
  };
  EXPECT_GT(middle([](const Vec3& x) { return bump((x[0] + x[1]) / std::sqrt(2.0)); }), 0.95);
  EXPECT_LT(middle([](const Vec3& x) { return bump(std::hypot(x[0], x[1])); }), 0.05);
  EXPECT_LT(middle([](const Vec3& x) { return bump(x.norm()); }), 0.05);
  EXPECT_EQ(middle([](const Vec3& x) { return 100 - bump(x[0]); }), 0);
}

TEST(Inhibition, OfIntensityKnowsBloodByItsPatchAndNoGlobalMaximum) {
  const auto tissue = [](double brightest) {
    return cube(25, 0.5, [=](const Vec3& x) {
      if (x[2] > 4) return 60.0;  // twice as bright as blood
      if (x[2] < -5.5) return brightest;
      return 30 + 3 * std::sin(5 * x[0]) * std::sin(7 * x[1]);
    });
  };
  for (const double brightest : {100.0, 10000.0}) {
    const Volume g = intensity_inhibition(tissue(brightest), Vec3::Zero(), 3);
    EXPECT_GT(sample(g, Vec3(0, 0, 0), kNaN), 0.5);
    EXPECT_LT(sample(g, Vec3(0, 0, 5), kNaN), 1e-6);
  }
  EXPECT_THROW(intensity_inhibition(tissue(100), Vec3(0, 0, 50), 3), InputError);
  EXPECT_THROW(intensity_inhibition(tissue(100), Vec3(0, 0, 5.25), 1), InputError);  // the same everywhere
}

TEST(Inhibition, OfEdgesIsSmallOnThemOnly) {
  const Volume image = cube(25, 0.5, [](const Vec3& x) {
    return (x[2] > 3 ? 200 : 30) + 3 * std::sin(5 * x[0]) * std::sin(7 * x[1]);
  });
  const Volume g = edge_inhibition(image, 0.7, Vec3(0, 0, -2), 2);
  EXPECT_LT(sample(g, Vec3(0, 0, 3), kNaN), 0.02);
  EXPECT_GT(sample(g, Vec3(0, 0, -2), kNaN), 0.3);
}

double share(const Volume& psi, const std::function<bool(const Vec3&)>& is_counted) {
  double inside = 0, all = 0;
  for (int k = 0; k < psi.size[2]; ++k)
    for (int j = 0; j < psi.size[1]; ++j)
      for (int i = 0; i < psi.size[0]; ++i) {
        if (!is_counted(position_of(psi, Vec3(i, j, k)))) continue;
        ++all;
        inside += psi.values[psi.voxel(i, j, k)] < 0;
      }
  return inside / all;
}

TEST(LevelSet, FillsACavityAndStaysInIt) {
  const Volume g = cube(49, 0.5, [](const Vec3& x) { return x.norm() < 9 ? 1.0 : 0.0; });
  const LevelSets found = grown_contours({g}, {Vec3(3, 0, 0)}, 3, {});
  EXPECT_TRUE(found.is_done);
  const Volume& psi = found.psi[0];
  EXPECT_GT(share(psi, [](const Vec3& x) { return x.norm() < 8.5; }), 0.99);
  EXPECT_LT(share(psi, [](const Vec3& x) { return x.norm() > 9.75; }), 0.01);
  double off = 0;
  int count = 0;
  for (size_t voxel = 0; voxel < psi.values.size();
       ++voxel) {  // psi is a distance, in voxels, by the contour
    if (std::abs(psi.values[voxel]) > 0.5) continue;
    const auto n = static_cast<std::ptrdiff_t>(voxel);
    double slope = 0;
    for (const std::ptrdiff_t stride : {1, 49, 49 * 49}) {
      const double along =
          0.5 * (psi.values[static_cast<size_t>(n + stride)] - psi.values[static_cast<size_t>(n - stride)]);
      slope += along * along;
    }
    off += std::abs(std::sqrt(slope) - 1);
    ++count;
  }
  ASSERT_GT(count, 1000);
  EXPECT_LT(off / count, 0.2);
}

TEST(LevelSet, TwoContoursMeetAndDoNotPass) {
  const Volume g = cube(41, 0.5, [](const Vec3& x) { return std::hypot(x[0], x[1]) < 6 ? 1.0 : 0.0; });
  const LevelSets found = grown_contours({g, g}, {Vec3(0, 0, 6), Vec3(0, 0, -6)}, 2.5, {});
  EXPECT_TRUE(found.is_done);
  int both = 0;
  for (size_t voxel = 0; voxel < g.values.size(); ++voxel)
    both += found.psi[0].values[voxel] < 0 && found.psi[1].values[voxel] < 0;
  EXPECT_LT(both, 452);  // one layer of voxels where they meet
  const auto upper = [](const Vec3& x) { return std::hypot(x[0], x[1]) < 5 && x[2] > 2 && x[2] < 8; };
  EXPECT_GT(share(found.psi[0], upper), 0.99);
  EXPECT_EQ(share(found.psi[1], upper), 0);
  EXPECT_THROW(grown_contours({g}, {Vec3(0, 0, 90)}, 2.5, {}), InputError);
}

// An open valve between walls, as `coapt phantom` images it.
Phantom imaged(const Valve& valve) {
  PhantomOptions options;
  options.voxel = 0.6;
  options.axial = options.lateral = 0.5;
  options.dropout = 0;
  options.shadows = 0;
  PhantomValve state;
  state.surface = valve.leaflets;
  state.annulus = valve.annulus;
  state.upstream = upstream_direction(valve.leaflets, valve.annulus);
  return make_phantom(state, phantom_pattern(state.surface, options), phantom_grid({state}, options),
                      options);
}

double dice(const Volume& found, const Volume& labels, int chamber) {
  double both = 0, either = 0;
  for (int k = 0; k < found.size[2]; ++k)
    for (int j = 0; j < found.size[1]; ++j)
      for (int i = 0; i < found.size[0]; ++i) {
        const Vec3 at = voxels_of(labels, position_of(found, Vec3(i, j, k)));
        const auto n = [&](int axis) { return static_cast<int>(std::lround(at[axis])); };
        const bool is_there = labels.values[labels.voxel(n(0), n(1), n(2))] == static_cast<float>(chamber);
        const bool is_found = found.values[found.voxel(i, j, k)] == static_cast<float>(chamber);
        both += is_there && is_found;
        either += is_there + is_found;
      }
  return 2 * both / either;
}

SegmentOptions by_burlina(const Valve& valve) {
  SegmentOptions options;
  options.annulus = valve.leaflets.vertices(Eigen::all, valve.annulus);
  options.dynamic_range = 50;
  options.method = SegmentMethod::Burlina2010;
  return options;
}

TEST(Burlina2010, FindsTheChambersAndTheLeafletsOfAPhantom) {
  const Valve valve = mitral_valve(MitralOptions{.triangles = 1500, .seed = 5});
  const Phantom phantom = imaged(valve);
  const Segmentation found = segment_leaflets(phantom.image, by_burlina(valve));
  ASSERT_TRUE(found.burlina);
  EXPECT_GT(dice(found.burlina->chambers, phantom.labels, kLabelAtrium), 0.85);
  EXPECT_GT(dice(found.burlina->chambers, phantom.labels, kLabelVentricle), 0.85);
  EXPECT_LT(surface_distance(valve.leaflets, found.valve.leaflets).mean, 0.3);
  EXPECT_LT(surface_distance(found.valve.leaflets, valve.leaflets).mean, 0.3);
  EXPECT_TRUE(check_mesh(found.valve.leaflets).empty());
  EXPECT_EQ(boundary_loops(found.valve.leaflets.triangles).size(), 2u);
}

TEST(Burlina2010, ContoursStopAtTheEdgesOfLeaflets) {
  const Valve valve = mitral_valve(MitralOptions{.triangles = 1500, .seed = 5});
  const Phantom phantom = imaged(valve);
  SegmentOptions options = by_burlina(valve);
  options.inhibition = Inhibition::Edge;
  const Segmentation found = segment_leaflets(phantom.image, options);
  ASSERT_TRUE(found.burlina);
  EXPECT_GT(dice(found.burlina->chambers, phantom.labels, kLabelAtrium), 0.6);
  double entered = 0, leaflet = 0;
  const Volume& chambers = found.burlina->chambers;
  for (int k = 0; k < chambers.size[2]; ++k)
    for (int j = 0; j < chambers.size[1]; ++j)
      for (int i = 0; i < chambers.size[0]; ++i) {
        const Vec3 at = voxels_of(phantom.labels, position_of(chambers, Vec3(i, j, k)));
        const auto n = [&](int axis) { return static_cast<int>(std::lround(at[axis])); };
        const float label = phantom.labels.values[phantom.labels.voxel(n(0), n(1), n(2))];
        if (std::lround(label) != kLabelLeaflet) continue;
        ++leaflet;
        entered += chambers.values[chambers.voxel(i, j, k)] > 0;
      }
  EXPECT_LT(entered, 0.05 * leaflet);
  EXPECT_LT(surface_distance(valve.leaflets, found.valve.leaflets).mean, 0.3);
  EXPECT_LT(surface_distance(found.valve.leaflets, valve.leaflets).mean, 0.3);
}

}  // namespace
}  // namespace coapt
