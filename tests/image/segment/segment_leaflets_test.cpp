#include "image/segment/segment_leaflets.hpp"

#include "core/error.hpp"
#include "image/support/speckle_phantom.hpp"
#include "image/support/valve_image.hpp"
#include "mesh/distance/surface_distance.hpp"
#include "mesh/distance/triangle_tree.hpp"
#include "mesh/mesh_check.hpp"
#include "valve/generators/leaflet_chords.hpp"
#include "valve/generators/mitral.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>

namespace coapt {
namespace {

Points loop_of(const Valve& valve, const std::vector<int>& loop) {
  return valve.leaflets.vertices(Eigen::all, loop);
}

const Valve& truth() {
  static const Valve valve =
      mitral_valve(MitralOptions{.triangles = 3000, .preset = MitralPreset::Benchmark});
  return valve;
}

SegmentOptions speckle_options(const Valve& valve) {
  SegmentOptions options;
  options.annulus = loop_of(valve, valve.annulus);
  options.dynamic_range = testing::kPhantomRange;
  return options;
}

// Mean distance of points from the nearest of others [mm].
double mean_distance_between(const Points& from, const Points& to) {
  double sum = 0;
  for (Eigen::Index k = 0; k < from.cols(); ++k)
    sum += (to.colwise() - from.col(k)).colwise().norm().minCoeff();
  return sum / static_cast<double>(from.cols());
}

struct Errors {
  SurfaceDistance there, back;
  double area = 0;  // relative
};

Errors errors_of(const Segmentation& found, const Valve& valve) {
  const TriangleMesh &a = found.valve.leaflets, &b = valve.leaflets;
  return {surface_distance(b, a), surface_distance(a, b),
          surface_area(a.vertices, a.triangles) / surface_area(b.vertices, b.triangles) - 1};
}

void expect_sound(const Segmentation& found) {
  EXPECT_TRUE(check_mesh(found.valve.leaflets).empty());
  EXPECT_EQ(boundary_loops(found.valve.leaflets.triangles).size(), 2u);
  EXPECT_GE(found.least_angle, 20);
  EXPECT_EQ(found.crossing_pairs, 0);
}

TEST(SegmentLeaflets, FindsTheGeneratedValveInSpeckle) {
  const Segmentation found =
      segment_leaflets(testing::speckle_volume(truth().leaflets, {.voxel = 0.7}), speckle_options(truth()));
  const Errors errors = errors_of(found, truth());
  EXPECT_LT(errors.there.mean, 0.25);
  EXPECT_LT(errors.there.p95, 0.8);
  EXPECT_LT(errors.back.mean, 0.25);
  EXPECT_LT(errors.back.p95, 0.8);
  EXPECT_LT(std::abs(errors.area), 0.05);
  expect_sound(found);
  EXPECT_LT(
      mean_distance_between(loop_of(found.valve, found.valve.annulus), loop_of(truth(), truth().annulus)),
      0.5);
  EXPECT_LT(
      mean_distance_between(loop_of(found.valve, found.valve.free_edge), loop_of(truth(), truth().free_edge)),
      1);
  // The normals are to the ventricle in both.
  const Vec3 out = area_vector(found.valve.leaflets.vertices, found.valve.leaflets.triangles.col(0));
  Vec3 outward = found.valve.leaflets.vertices.col(found.valve.leaflets.triangles(0, 0));
  outward -= found.valve.leaflets.vertices.rowwise().mean();
  EXPECT_GT(out.dot(Vec3(outward[0], outward[1], 0)), 0);
}

TEST(SegmentLeaflets, EndsWhereChordsFanOut) {
  const Valve valve = mitral_valve(MitralOptions{.triangles = 2500, .seed = 8});
  const PhantomOptions phantom = testing::clear_phantom(8);
  const Segmentation found =
      segment_leaflets(testing::image_with_chords(valve, phantom), speckle_options(valve));
  const Errors errors = errors_of(found, valve);
  EXPECT_LT(errors.there.p95, 0.8);
  EXPECT_LT(errors.back.mean, 0.25);
  EXPECT_LT(errors.back.p95, 0.8);
  EXPECT_LT(std::abs(errors.area), 0.05);
  expect_sound(found);
}

// Chords of the rough zone run along the leaflet before it ends; an edge that they end was 12 % too high.
TEST(SegmentLeaflets, GoesOnWhereChordsOfTheRoughZoneLeave) {
  Valve valve = mitral_valve(MitralOptions{.triangles = 2500, .seed = 4});
  LeafletChordOptions chords;
  chords.zones = {chord_zone("free_edge"), chord_zone("rough")};
  valve.chords = leaflet_chords(valve, chords);
  const PhantomOptions phantom = testing::clear_phantom(4);
  const Segmentation found =
      segment_leaflets(testing::image_with_chords(valve, phantom), speckle_options(valve));
  const Errors errors = errors_of(found, valve);
  EXPECT_LT(errors.back.mean, 0.35);
  EXPECT_LT(std::abs(errors.area), 0.09);
  expect_sound(found);
}

TEST(SegmentLeaflets, FindsTheThicknessWithinAFifth) {
  struct Case {
    double voxel, thickness;
    unsigned seed;
  };
  for (const Case& one : {Case{0.5, 0.8, 11}, Case{0.5, 1, 12}, Case{0.7, 1.5, 13}, Case{0.7, 2, 14}}) {
    const Valve valve = mitral_valve(MitralOptions{.triangles = 1500, .seed = one.seed});
    PhantomOptions phantom = testing::clear_phantom(one.seed);
    phantom.voxel = one.voxel;
    phantom.thickness = one.thickness;
    const Segmentation found =
        segment_leaflets(testing::image_with_chords(valve, phantom), speckle_options(valve));
    EXPECT_NEAR(found.thickness_median, one.thickness, 0.2 * one.thickness) << one.voxel << " " << one.seed;
    EXPECT_NEAR(found.blur, 0.41, 0.04);  // of power, 15 mm behind the annulus, where it is wider
  }
}

TEST(SegmentLeaflets, StatesAnUncertaintyThatCoversTheError) {
  const Segmentation found = segment_leaflets(
      testing::speckle_volume(truth().leaflets, {.voxel = 0.8, .seed = 5}), speckle_options(truth()));
  const Errors errors = errors_of(found, truth());
  int inner = 0, within = 0;
  for (Eigen::Index v = 0; v < found.deviation.size(); ++v) {
    const Vec3 x = found.valve.leaflets.vertices.col(v);
    const Points edge = loop_of(found.valve, found.valve.free_edge);
    if ((edge.colwise() - x).colwise().norm().minCoeff() < 2) continue;  // there the edge is in doubt too
    ++inner;
    within += errors.back.vertex_distances[v] <= 2 * found.deviation[v];
  }
  EXPECT_GT(inner, 300);
  EXPECT_GT(within, 0.85 * inner);
  EXPECT_LT(found.deviation.mean(), 0.4);  // and is no empty statement
}

TEST(SegmentLeaflets, GoesOnWhereEchoesDropOut) {
  const TriangleTree tree(truth().leaflets.vertices, truth().leaflets.triangles);
  const Vec3 centre = tree.closest(Vec3(0, 8, -9)).point;  // in the middle of the anterior leaflet
  testing::PhantomOptions phantom{.voxel = 0.8};
  phantom.is_dropped_out = [&](const Vec3& x) { return (x - centre).norm() < 4.5; };
  const Segmentation found =
      segment_leaflets(testing::speckle_volume(truth().leaflets, phantom), speckle_options(truth()));
  const Errors errors = errors_of(found, truth());
  EXPECT_LT(errors.there.p95, 1.3);
  EXPECT_LT(std::abs(errors.area), 0.06);
  expect_sound(found);
  // Nothing was seen there: the deviation says so.
  double in_patch = 0, elsewhere = 0;
  int count_in = 0, count_else = 0;
  for (Eigen::Index v = 0; v < found.deviation.size(); ++v) {
    const double distance = (found.valve.leaflets.vertices.col(v) - centre).norm();
    (distance < 1.5 ? in_patch : elsewhere) += found.deviation[v];
    ++(distance < 1.5 ? count_in : count_else);
  }
  ASSERT_GT(count_in, 2);
  EXPECT_GT(in_patch / count_in, 1.5 * elsewhere / count_else);
}

TEST(SegmentLeaflets, DoesNotDependOnTheAxesOfTheVolume) {
  testing::PhantomOptions phantom{.voxel = 0.8};
  phantom.direction = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  const Segmentation found =
      segment_leaflets(testing::speckle_volume(truth().leaflets, phantom), speckle_options(truth()));
  const Errors errors = errors_of(found, truth());
  EXPECT_LT(errors.there.mean, 0.3);
  EXPECT_LT(errors.back.mean, 0.3);
}

TEST(SegmentLeaflets, TakesTheAtrialSideOfAnIsosurface) {
  SegmentOptions options = speckle_options(truth());
  options.dynamic_range = 0;
  options.method = SegmentMethod::Isosurface;
  options.threshold = 50;
  const Volume volume = testing::plain_volume(truth().leaflets, {.voxel = 0.6, .thickness = 1.8});
  const Segmentation found = segment_leaflets(volume, options);
  const Errors errors = errors_of(found, truth());
  EXPECT_NEAR(errors.back.mean, 0.9, 0.2);  // half the thickness
  EXPECT_NEAR(found.thickness_median, 1.8, 0.36);
  expect_sound(found);
  // On the inner side: against the normals of the truth.
  const TriangleTree tree(truth().leaflets.vertices, truth().leaflets.triangles);
  int inner = 0;
  for (int v = 0; v < found.valve.leaflets.vertex_count(); ++v) {
    const Vec3 x = found.valve.leaflets.vertices.col(v);
    const ClosestOnSurface closest = tree.closest(x);
    const Vec3 normal =
        area_vector(truth().leaflets.vertices, truth().leaflets.triangles.col(closest.triangle));
    inner += (x - closest.point).dot(normal) < 0;
  }
  EXPECT_GT(inner, 0.9 * found.valve.leaflets.vertex_count());
}

TEST(SegmentLeaflets, TakesAMaskInThePlaceOfTheImage) {
  SegmentOptions options = speckle_options(truth());
  options.dynamic_range = 0;
  const testing::PhantomOptions phantom{.voxel = 0.8, .thickness = 1.6};
  Volume mask = testing::plain_volume(truth().leaflets, phantom);
  for (float& value : mask.values) value = value > 50 ? 1.0F : 0.0F;
  const Volume nothing = volume_like(mask, 7);
  options.mask = mask;
  const Errors errors = errors_of(segment_leaflets(nothing, options), truth());
  EXPECT_LT(errors.there.mean, 0.3);
  EXPECT_LT(errors.back.mean, 0.3);
  options.mask.reset();
  EXPECT_THROW(segment_leaflets(nothing, options), InputError);
}

TEST(SegmentLeaflets, FollowsAMaskThatIsThinnerThanTwoVoxels) {
  const TriangleMesh& leaflets = truth().leaflets;
  Volume mask = testing::plain_volume(leaflets, {.voxel = 0.7});
  const TriangleTree tree(leaflets.vertices, leaflets.triangles);
  for (int k = 0; k < mask.size[2]; ++k)
    for (int j = 0; j < mask.size[1]; ++j)
      for (int i = 0; i < mask.size[0]; ++i)
        mask.values[mask.voxel(i, j, k)] =
            tree.closest(position_of(mask, Vec3(i, j, k))).distance_squared < 0.25 ? 1.0F : 0.0F;
  SegmentOptions options = speckle_options(truth());
  options.dynamic_range = 0;
  options.mask = mask;
  const Segmentation found = segment_leaflets(mask, options);
  expect_sound(found);
  const Errors errors = errors_of(found, truth());
  EXPECT_LT(errors.there.mean, 0.15);
  EXPECT_LT(errors.back.mean, 0.15);
  EXPECT_NEAR(errors.area, 0, 0.05);
}

TEST(SegmentLeaflets, RefusesWhatCannotBe) {
  const Volume volume = testing::plain_volume(truth().leaflets, {.voxel = 1.5});
  SegmentOptions options = speckle_options(truth());
  options.annulus = options.annulus.leftCols(3).eval();
  options.dynamic_range = -1;
  options.edge_length = 0;
  try {
    segment_leaflets(volume, options);
    FAIL() << "was not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 3u);
  }
  options = speckle_options(truth());
  options.annulus.colwise() += Vec3(500, 0, 0);
  EXPECT_THROW(segment_leaflets(volume, options), InputError);
}

}  // namespace
}  // namespace coapt
