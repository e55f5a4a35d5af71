// The parts of which a segmentation is made, each on something whose answer is known.
#include "core/closed_path.hpp"
#include "core/random_source.hpp"
#include "image/segment/centre_layer.hpp"
#include "image/segment/closed_polygon.hpp"
#include "image/segment/layer_mesh.hpp"
#include "image/segment/sheet_evidence.hpp"
#include "image/segment/speckle_blur.hpp"
#include "image/segment/trim_crossings.hpp"
#include "image/segment/unfold_rows.hpp"
#include "image/segment/wall_profile.hpp"
#include "image/support/speckle_phantom.hpp"
#include "mesh/distance/intersections.hpp"
#include "mesh/remesh/round_triangles.hpp"
#include "mesh/shapes.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace coapt {
namespace {

double cost_of(const Eigen::MatrixXd& costs, const std::vector<int>& path, double step_cost) {
  double sum = 0;
  for (size_t i = 0; i < path.size(); ++i)
    sum += costs(path[i], static_cast<Eigen::Index>(i)) +
           step_cost * std::abs(path[i] - path[(i + 1) % path.size()]);
  return sum;
}

TEST(ClosedPath, IsTheCheapestOfAll) {
  RandomSource random(3);
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::MatrixXd costs(4, 5);
    for (double& cost : costs.reshaped()) cost = random.unit();
    const std::vector<int> found = closed_path(costs, 1, 0.2);
    double least = kInfinity;
    for (int code = 0; code < 1024; ++code) {
      std::vector<int> path;
      for (int i = 0, rest = code; i < 5; ++i, rest /= 4) path.push_back(rest % 4);
      bool is_allowed = true;
      for (size_t i = 0; i < 5; ++i) is_allowed = is_allowed && std::abs(path[i] - path[(i + 1) % 5]) <= 1;
      if (is_allowed) least = std::min(least, cost_of(costs, path, 0.2));
    }
    EXPECT_NEAR(cost_of(costs, found, 0.2), least, 1e-12);
  }
}

// A tube whose columns 17 to 23 lie in reverse order from row 4 on.
LayerGrid pleated_tube() {
  LayerGrid grid{.columns = 40, .rows = 10, .points = Points(3, 400), .normals = Points(3, 0)};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const bool is_pleat = row >= 4 && std::abs(column - 20) <= 3;
      const double angle = 2 * std::numbers::pi / 40 * (is_pleat ? 20 - 0.4 * (column - 20) : column);
      grid.points.col(grid.node(column, row)) = Vec3(6 * std::cos(angle), 6 * std::sin(angle), -row);
    }
  update_normals(grid);
  return grid;
}

int folded_edges(const TriangleMesh& mesh) {
  int count = 0;
  for (const Edge& edge : edges(mesh.triangles))
    if (edge.triangles.size() == 2)
      count += area_vector(mesh.vertices, mesh.triangles.col(edge.triangles[0]))
                   .dot(area_vector(mesh.vertices, mesh.triangles.col(edge.triangles[1]))) <= 0;
  return count;
}

TEST(UnfoldRows, TakesAPleatApartAndLeavesTheRest) {
  const LayerGrid given = pleated_tube();
  LayerGrid grid = given;
  ASSERT_GT(folded_edges(triangles_of(grid)), 0);
  ASSERT_GT(intersecting_pairs(grid.points, triangles_of(grid).triangles).size(), 0u);
  unfold_rows(grid, Vector::Ones(grid.points.cols()));
  const TriangleMesh mesh = triangles_of(grid);
  EXPECT_EQ(folded_edges(mesh), 0);
  EXPECT_EQ(intersecting_pairs(mesh.vertices, mesh.triangles).size(), 0u);
  EXPECT_NEAR(surface_area(mesh.vertices, mesh.triangles), 2 * std::numbers::pi * 6 * 9, 6);
  EXPECT_EQ(grid.points.leftCols(3 * 40), given.points.leftCols(3 * 40));
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 30; column <= 50; ++column) EXPECT_EQ(grid.at(column, row), given.at(column, row));
}

TEST(UnfoldRows, LeavesWhatLiesBeyondTheEdge) {
  const LayerGrid given = pleated_tube();
  LayerGrid grid = given;
  Vector level = Vector::Ones(grid.points.cols());
  level.tail(7 * grid.columns).setConstant(-1);  // from row 3 on
  unfold_rows(grid, level);
  EXPECT_EQ(grid.points, given.points);
}

// Two leaflets, the upper one flatter: beyond the middle each goes on below or above the other, and row 21 of
// the upper one passes through row 11 of the lower one.
LayerGrid funnel_that_crosses() {
  LayerGrid grid{.columns = 80, .rows = 28, .points = Points(3, 80 * 28), .normals = Points(3, 0)};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double angle = 2 * std::numbers::pi * column / grid.columns, side = std::sin(angle);
      grid.points.col(grid.node(column, row)) =
          Vec3(10 * std::cos(angle), side * (8 - 0.5 * row), -0.3 * row * (1.5 - 0.5 * side));
    }
  update_normals(grid);
  return grid;
}

// Where the upper leaflet is longer than it can be beside the lower one.
Vector ends_that_cross(const LayerGrid& grid) {
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  Vector ends(grid.columns);
  for (int column = 0; column < grid.columns; ++column)
    ends[column] = lengths(column < grid.columns / 2 ? 25 : 20, column);
  return ends;
}

size_t crossing_pairs(const LayerGrid& grid, const Vector& ends) {
  const TriangleMesh kept = kept_part(grid, length_left(grid, ends));
  return intersecting_pairs(kept.vertices, kept.triangles).size();
}

TEST(TrimCrossings, EndsTheShorterRestAndLeavesTheOther) {
  const LayerGrid grid = funnel_that_crosses();
  const Eigen::MatrixXd lengths = lengths_along_columns(grid);
  const Vector given = ends_that_cross(grid);
  ASSERT_GT(crossing_pairs(grid, given), 0u);
  const Vector ends = trim_crossings(grid, given);
  EXPECT_EQ(crossing_pairs(grid, ends), 0u);
  EXPECT_TRUE((ends.array() <= given.array()).all());
  EXPECT_TRUE((ends.array() >= given.array() - 6).all());
  EXPECT_GT(ends[20], lengths(19, 20));  // the middle of the upper leaflet
  EXPECT_LT(ends[20], lengths(22, 20));
  for (int column = 50; column <= 70; ++column) EXPECT_EQ(ends[column], given[column]) << column;
}

TEST(TrimCrossings, LeavesWhatDoesNotCross) {
  const LayerGrid grid = funnel_that_crosses();
  Vector ends = ends_that_cross(grid);
  ends.array() -= 4;
  ASSERT_EQ(crossing_pairs(grid, ends), 0u);
  EXPECT_EQ(trim_crossings(grid, ends), ends);
}

TEST(LayerMesh, DoesNotPassThroughItself) {
  const LayerGrid grid = funnel_that_crosses();
  const LayerMesh mesh = layer_mesh(grid, ends_that_cross(grid), 1.5);
  EXPECT_EQ(intersecting_pairs(mesh.mesh.vertices, mesh.mesh.triangles).size(), 0u);
  EXPECT_EQ(boundary_loops(mesh.mesh.triangles).size(), 2u);
  EXPECT_GT(least_angle(mesh.mesh), 15);
}

TEST(ClosedPolygon, FollowsAWaveAndPassesOverAGap) {
  // Costs grow with the distance from a wave; where nothing is known they are all the same.
  constexpr int kColumns = 120, kStates = 40;
  const auto wave = [](int column) { return 20 + 8 * std::cos(2 * std::numbers::pi * column / kColumns); };
  for (const bool has_gap : {false, true}) {
    Eigen::MatrixXd costs(kStates, kColumns);
    for (int column = 0; column < kColumns; ++column)
      for (int state = 0; state < kStates; ++state)
        costs(state, column) = has_gap && column >= 40 && column < 52 ? 0 : std::abs(state - wave(column));
    const Vector path = closed_polygon(costs, {});
    for (int column = 0; column < kColumns; ++column) EXPECT_NEAR(path[column], wave(column), 1.2) << column;
    EXPECT_NEAR(path[0], path[kColumns - 1], 1);
  }
}

TEST(ClosedPolygon, HasNoCornerForASinglePlaceThatContradicts) {
  Eigen::MatrixXd costs(30, 60);
  for (int column = 0; column < 60; ++column)
    for (int state = 0; state < 30; ++state)
      costs(state, column) = 0.1 * std::abs(state - (column == 33 ? 25 : 12));
  EXPECT_LT((closed_polygon(costs, {}).array() - 12).abs().maxCoeff(), 1e-9);
}

// A grid around the origin with values of a function of the place.
template <class Function>
Volume volume_of(int half, double voxel, const Function& value) {
  Volume volume;
  volume.size = {2 * half + 1, 2 * half + 1, 2 * half + 1};
  volume.spacing = Vec3::Constant(voxel);
  volume.direction = Eigen::AngleAxisd(0.5, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  volume.origin = -volume.direction * Vec3::Constant(half * voxel);
  volume.values.resize(static_cast<size_t>(volume.size[0] * volume.size[1] * volume.size[2]));
  for (int k = 0; k <= 2 * half; ++k)
    for (int j = 0; j <= 2 * half; ++j)
      for (int i = 0; i <= 2 * half; ++i)
        volume.values[volume.voxel(i, j, k)] = static_cast<float>(value(position_of(volume, Vec3(i, j, k))));
  return volume;
}

TEST(SheetEvidence, SeesASheetAndItsNormalButNoTube) {
  const Vec3 normal = Vec3(1, 2, 3).normalized(), along = Vec3(0, 3, -2).normalized();
  const auto gauss = [](double d) { return std::exp(-0.5 * d * d / 0.36); };
  const Volume both = volume_of(16, 0.6, [&](const Vec3& x) {
    const Vec3 beside = x - 6 * normal;
    return gauss(normal.dot(x)) + gauss((beside - along.dot(beside) * along).norm());
  });
  const SheetEvidence evidence = sheet_evidence(both, {0.7, 1.0});
  const double on_sheet = sheet_strength(evidence, Vec3::Zero(), normal);
  EXPECT_GT(on_sheet, 0.5);
  EXPECT_LT(sheet_strength(evidence, Vec3::Zero(), along), 0.05 * on_sheet);
  EXPECT_LT(sheet_strength(evidence, 6 * normal, normal), 0.3 * on_sheet);
  EXPECT_LT(sheet_strength(evidence, 2.5 * normal, normal), 0.1 * on_sheet);
}

// A plane grid at this height, 0.5 mm from point to point, from (2, 2) to (22, 22).
LayerGrid flat_grid(double height) {
  LayerGrid grid{.columns = 41, .rows = 41, .points = Points(3, 41 * 41), .normals = Points(3, 0)};
  grid.normals = Vec3::UnitZ().replicate(1, 41 * 41);
  for (int row = 0; row < 41; ++row)
    for (int column = 0; column < 41; ++column)
      grid.points.col(grid.node(column, row)) = Vec3(2 + 0.5 * column, 2 + 0.5 * row, height);
  return grid;
}

TEST(SheetMiddles, LieBetweenTheSidesOfASheetThatIsWiderThanItsSpeckle) {
  const Volume volume =
      testing::speckle_volume(square(24, 800), {.voxel = 0.5, .thickness = 1.6, .spread = 0.6});
  const GreyScale scale{testing::kPhantomRange / 255};
  for (const double height : {-0.4, 0.0, 0.4}) {
    const Vector middles = sheet_middles(volume, flat_grid(height), scale);
    double sum = 0, squares = 0, count = 0;
    for (const double middle : middles)
      if (std::isfinite(middle)) sum += middle, squares += std::pow(middle + height, 2), ++count;
    EXPECT_GT(count, 0.9 * 41 * 41);
    EXPECT_NEAR(sum / count, -height, 0.05) << height;
    EXPECT_LT(std::sqrt(squares / count), 0.25) << height;
  }
}

TEST(SheetMiddles, AreNotToldBesideAWall) {
  const auto sheet = [](double z) { return 100 * std::exp(-0.5 * z * z / 0.25); };
  const Volume alone = volume_of(24, 0.5, [&](const Vec3& x) { return sheet(x.z()); });
  const Volume beside =
      volume_of(24, 0.5, [&](const Vec3& x) { return std::max(sheet(x.z()), x.z() > 1 ? 90.0 : 0.0); });
  LayerGrid grid = flat_grid(0.3);
  grid.points.topRows(2).array() -= 12;
  const Eigen::Index inside = grid.node(20, 20);
  EXPECT_NEAR(sheet_middles(alone, grid, {})[inside], -0.3, 0.03);
  EXPECT_TRUE(std::isnan(sheet_middles(beside, grid, {})[inside]));
}

TEST(LengthsAtSamePlaces, GrowWithTheColumn) {
  const LayerGrid before = flat_grid(0);
  LayerGrid now = before;
  now.points.row(1) *= 2;
  const Vector lengths = Vector::LinSpaced(41, 0.1, 19.9);
  EXPECT_LT((lengths_at_same_places(lengths, before, now) - 2 * lengths).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(WallFit, FindsTheWidthThatMadeTheProfile) {
  for (const GreyScale scale : {GreyScale{}, GreyScale{0.2}})
    for (const double width : {0.8, 1.5}) {
      WallProfiles profiles;
      profiles.values.resize(27, 1);
      for (Eigen::Index k = 0; k < 27; ++k) {
        const double t = profiles.offset(k) - 0.2, a = std::sqrt(0.5) / 0.4;
        const double share = 0.5 * (std::erf((t + 0.5 * width) * a) - std::erf((t - 0.5 * width) * a));
        profiles.values(k, 0) = value_at_share(scale, 60, 200, share);
      }
      const WallFit fit = fit_wall(profiles, 0, 0.4, scale);
      ASSERT_TRUE(fit.is_found);
      EXPECT_NEAR(fit.width, width, 0.02);
      EXPECT_NEAR(fit.centre, 0.2, 0.01);
    }
}

TEST(SpeckleBlur, IsThatOfThePointSpread) {
  const TriangleMesh sheet = square(24, 800);
  const testing::PhantomOptions phantom{.voxel = 0.5, .thickness = 1.5, .spread = 0.6};
  const Volume volume = testing::speckle_volume(sheet, phantom);
  const GreyScale scale{testing::kPhantomRange / 255};
  const LayerGrid grid = flat_grid(0);
  const std::optional<SpeckleBlur> blur = speckle_blur(volume, grid, std::vector<char>(41 * 41, 1), scale);
  ASSERT_TRUE(blur);
  const Vec3 middle = blur->at(Vec3(12, 12, 0));
  EXPECT_NEAR(middle[0], 0.6 / std::sqrt(2.0), 0.06);  // of power; along y it is the same
  EXPECT_NEAR(middle[1], 0.6 / std::sqrt(2.0), 0.06);
  EXPECT_FALSE(speckle_blur(volume, grid, std::vector<char>(41 * 41, 0), scale));
}

}  // namespace
}  // namespace coapt
