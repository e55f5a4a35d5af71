// A template fitted to phantoms: how near it comes, and what it refuses.
#include "core/error.hpp"
#include "image/segment/segment_leaflets.hpp"
#include "image/support/speckle_phantom.hpp"
#include "image/template/fit_template.hpp"
#include "image/template/given_template.hpp"
#include "mesh/distance/surface_distance.hpp"
#include "mesh/mesh_check.hpp"
#include "valve/generators/mitral.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace coapt {
namespace {

const Valve& truth() {
  static const Valve valve =
      mitral_valve(MitralOptions{.triangles = 3000, .preset = MitralPreset::Benchmark});
  return valve;
}

const Volume& image() {
  static const Volume volume = testing::speckle_volume(truth().leaflets, {.voxel = 0.7});
  return volume;
}

SegmentOptions template_options(const TemplateOptions& shape = {}) {
  SegmentOptions options;
  options.annulus = truth().leaflets.vertices(Eigen::all, truth().annulus);
  options.dynamic_range = testing::kPhantomRange;
  options.method = SegmentMethod::Template;
  options.finder = template_finder(shape);
  return options;
}

void expect_near_truth(const Segmentation& found) {
  const SurfaceDistance there = surface_distance(truth().leaflets, found.valve.leaflets),
                        back = surface_distance(found.valve.leaflets, truth().leaflets);
  EXPECT_LT(there.mean, 0.25);
  EXPECT_LT(there.p95, 0.8);
  EXPECT_LT(back.mean, 0.25);
  EXPECT_LT(back.p95, 0.8);
  EXPECT_TRUE(check_mesh(found.valve.leaflets).empty());
  EXPECT_EQ(found.crossing_pairs, 0);
  EXPECT_GE(found.least_angle, 20);
}

TEST(FitTemplate, FindsTheGeneratedValveInSpeckle) {
  SegmentOptions options = template_options();
  options.has_second_route = true;
  const Segmentation found = segment_leaflets(image(), options);
  expect_near_truth(found);
  EXPECT_GT(found.contrast, 20);
  EXPECT_GT(found.edge_deviation, 0.02);
  EXPECT_LT(found.edge_deviation, 2);
  // The deviation covers the error away from the free edge, and is no empty statement.
  const SurfaceDistance back = surface_distance(found.valve.leaflets, truth().leaflets);
  const Points edge = found.valve.leaflets.vertices(Eigen::all, found.valve.free_edge);
  int inner = 0, within = 0;
  for (int v = 0; v < found.valve.leaflets.vertex_count(); ++v) {
    if ((edge.colwise() - found.valve.leaflets.vertices.col(v)).colwise().norm().minCoeff() < 2) continue;
    ++inner;
    within += back.vertex_distances[v] <= 2 * found.deviation[v];
  }
  EXPECT_GT(inner, 300);
  EXPECT_GT(within, 0.85 * inner);
  EXPECT_LT(found.deviation.mean(), 0.4);
  // The first route agrees with it here.
  ASSERT_TRUE(found.second_route.has_value());
  EXPECT_EQ(found.second_route->distances.size(), found.valve.leaflets.vertex_count());
  EXPECT_GT(found.second_route->mean, 0.01);
  EXPECT_LT(found.second_route->mean, 0.3);
  EXPECT_LT(found.second_route->free_edge, 1.5);
}

TEST(FitTemplate, TakesAGivenShapeFromAnywhere) {
  TemplateOptions given;
  given.shape = mitral_valve(MitralOptions{.triangles = 1200, .seed = 5});
  const Eigen::Affine3d elsewhere = Eigen::Translation3d(300, -20, 70) *
                                    Eigen::AngleAxisd(2.1, Vec3(1, -3, 0.4).normalized()) *
                                    Eigen::Scaling(1.3);
  given.shape->leaflets.vertices = elsewhere * given.shape->leaflets.vertices;
  std::reverse(given.shape->free_edge.begin(), given.shape->free_edge.end());
  expect_near_truth(segment_leaflets(image(), template_options(given)));
}

// What the first route says does not depend on the second.
TEST(FitTemplate, LeavesTheFirstRouteAsItIs) {
  SegmentOptions options = template_options();
  options.method = SegmentMethod::Ridge;
  const Segmentation alone = segment_leaflets(image(), options);
  options.has_second_route = true;
  const Segmentation compared = segment_leaflets(image(), options);
  EXPECT_EQ(alone.valve.leaflets.vertices, compared.valve.leaflets.vertices);
  EXPECT_EQ(alone.deviation, compared.deviation);
  EXPECT_FALSE(alone.second_route.has_value());
  EXPECT_TRUE(compared.second_route.has_value());
}

void expect_refused(Valve shape, const std::string& words) {
  try {
    check_template(shape);
    FAIL() << "was not refused: " << words;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(FitTemplate, RefusesWhatIsNoTemplate) {
  const Valve whole = mitral_valve(MitralOptions{.triangles = 600});
  EXPECT_NO_THROW(check_template(whole));
  Valve shape = whole;
  shape.free_edge.clear();
  expect_refused(shape, "names no annulus or no free edge");
  shape = whole;
  shape.free_edge = shape.annulus;
  std::rotate(shape.annulus.begin(), shape.annulus.begin() + 3, shape.annulus.end());
  shape.free_edge.pop_back();
  expect_refused(shape, "are not its two rims");
  shape = whole;  // with a hole
  const std::vector<int> rim(shape.annulus), edge(shape.free_edge);
  const auto is_inner = [&](int v) {
    return std::find(rim.begin(), rim.end(), v) == rim.end() &&
           std::find(edge.begin(), edge.end(), v) == edge.end();
  };
  int hole = 0;
  while (!(is_inner(shape.leaflets.triangles(0, hole)) && is_inner(shape.leaflets.triangles(1, hole)) &&
           is_inner(shape.leaflets.triangles(2, hole))))
    ++hole;
  const Eigen::Index last = shape.leaflets.triangle_count() - 1;
  shape.leaflets.triangles.col(hole) = shape.leaflets.triangles.col(last).eval();
  shape.leaflets.triangles.conservativeResize(3, last);
  shape.leaflets.regions.clear();
  expect_refused(shape, "not one layer with two rims");
  SegmentOptions options = template_options();
  options.finder = {};
  EXPECT_THROW(segment_leaflets(image(), options), InputError);
  options = template_options();
  options.method = SegmentMethod::Isosurface;
  options.has_second_route = true;
  EXPECT_THROW(segment_leaflets(image(), options), InputError);
}

}  // namespace
}  // namespace coapt
