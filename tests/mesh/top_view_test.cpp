#include "mesh/top_view.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "mesh/closed_view.hpp"
#include "mesh/outlines.hpp"
#include "mesh/projected_area.hpp"
#include "mesh/remesh/spanning_surface.hpp"
#include "mesh/seams.hpp"
#include "mesh/vertex_graph.hpp"
#include "support/mesh_samples.hpp"
#include "support/trough_valve.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace coapt {
namespace {

constexpr double kPi = std::numbers::pi;

Points square_loop(double half, double height = 0) {
  Points loop(3, 4);
  loop << -half, half, half, -half, -half, -half, half, half, height, height, height, height;
  return loop;
}

// A flat ring between two circles of n corners each, the inner one at a height.
TriangleMesh ring(int n, double inner, double outer, double inner_height) {
  return grid_sheet(n, 1, [=](double u, double v) {
    const double radius = v == 0 ? inner : outer;
    return Vec3(radius * std::cos(2 * kPi * u), radius * std::sin(2 * kPi * u), v == 0 ? inner_height : 0);
  });
}

Points circle(int n, double radius) {
  Points loop(3, n);
  for (int k = 0; k < n; ++k)
    loop.col(k) << radius * std::cos(2 * kPi * k / n), radius * std::sin(2 * kPi * k / n), 0;
  return loop;
}

const ViewFrame kDown = view_frame(Vec3::Zero(), Vec3::UnitZ());

TEST(TopView, GivesTheHeightsOfATiltedPlaneExactly) {
  const TriangleMesh sheet = grid_sheet(7, 5, [](double u, double v) {
    return Vec3(8 * u - 4, 8 * v - 4, 0.3 * (8 * u - 4) - 0.2 * (8 * v - 4) + 1);
  });
  const TopView view = top_view(sheet.vertices, sheet.triangles, square_loop(3), kDown, 0.1);
  int covered = 0;
  for (int j = 0; j < view.rows; ++j)
    for (int i = 0; i < view.columns; ++i) {
      const int node = j * view.columns + i;
      const Vec3 p = in_frame(view.position(i, j, 0), kDown);
      const Vec3 place = view.position(i, j, view.height[static_cast<size_t>(node)]);
      ASSERT_GE(view.triangle[static_cast<size_t>(node)], 0) << p.transpose();
      EXPECT_NEAR(place[2], 0.3 * place[0] - 0.2 * place[1] + 1, 1e-13);
      EXPECT_FALSE(view.is_open[static_cast<size_t>(node)]);
      ++covered;
    }
  EXPECT_GT(covered, 3600);
}

TEST(TopView, KeepsTheHighestOfTwoSheetsAndWhatLiesInside) {
  TriangleMesh sheets = grid_sheet(4, 4, [](double u, double v) { return Vec3(6 * u - 3, 6 * v - 3, 1); });
  append(sheets, grid_sheet(4, 4, [](double u, double v) { return Vec3(6 * u - 3, 6 * v - 3, -2); }));
  const TopView view = top_view(sheets.vertices, sheets.triangles, square_loop(2), kDown, 0.25);
  int inside = 0;
  for (int node = 0; node < view.node_count(); ++node) {
    EXPECT_EQ(view.height[static_cast<size_t>(node)], 1);
    EXPECT_LT(view.triangle[static_cast<size_t>(node)], 32);
    inside += view.is_inside[static_cast<size_t>(node)];
  }
  EXPECT_EQ(inside, 16 * 16);
}

TEST(TopView, RefusesAPolygonOfTwoCornersAndNoDirection) {
  const TriangleMesh sheet = wavy_sheet(2);
  EXPECT_THROW(top_view(sheet.vertices, sheet.triangles, Points::Zero(3, 2), kDown, 0.1), InputError);
  EXPECT_THROW(view_frame(Vec3::Zero(), Vec3::Zero()), InputError);
}

TEST(Outlines, OfAFunnelAreItsHole) {
  const TriangleMesh funnel = ring(40, 4, 10, -3);
  const TopView view = top_view(funnel.vertices, funnel.triangles, circle(40, 10), kDown, 0.05);
  const std::vector<Outline> outlines = open_outlines(view);
  ASSERT_EQ(outlines.size(), 1u);
  EXPECT_NEAR(outlines[0].area, 0.5 * 40 * 16 * std::sin(2 * kPi / 40), 2e-3);
  EXPECT_NEAR(outlines[0].perimeter, 40 * 8 * std::sin(kPi / 40), 5e-3);
  EXPECT_NEAR(outlines[0].mean_height, -3, 1e-9);
  EXPECT_TRUE(view.is_open[static_cast<size_t>(outlines[0].open_node)]);
}

TEST(Outlines, ConvergeWithTheCellToSecondOrder) {
  const TriangleMesh funnel = ring(400, 4, 10, 0);
  const double exact = 0.5 * 400 * 16 * std::sin(2 * kPi / 400);
  const auto error = [&](double cell) {
    const TopView view = top_view(funnel.vertices, funnel.triangles, circle(400, 10), kDown, cell);
    return std::abs(open_outlines(view).at(0).area - exact);
  };
  EXPECT_LT(error(0.1), 0.4 * error(0.2));
  EXPECT_LT(error(0.1), 2e-3 * exact);
}

TEST(Outlines, TellHolesApartAndIslandsFromHoles) {
  // A square with a square hole in which a smaller square floats, and beside it nothing at x > 6.
  TriangleMesh mesh = grid_sheet(1, 1, [](double u, double v) { return Vec3(2 * u - 1, 2 * v - 1, 0.5); });
  const auto bar = [](double x0, double x1, double y0, double y1) {
    return grid_sheet(1, 1,
                      [=](double u, double v) { return Vec3(x0 + u * (x1 - x0), y0 + v * (y1 - y0), 0); });
  };
  append(mesh, bar(-9, -4, -9, 9));
  append(mesh, bar(4, 6, -9, 9));
  append(mesh, bar(-4, 4, -9, -4));
  append(mesh, bar(-4, 4, 4, 9));
  const TopView view = top_view(mesh.vertices, mesh.triangles, square_loop(9), kDown, 0.07);
  std::vector<double> areas;
  double sum = 0;
  for (const Outline& outline : open_outlines(view)) {
    areas.push_back(outline.area);
    sum += outline.area;
  }
  std::sort(areas.begin(), areas.end());
  ASSERT_EQ(areas.size(), 3u);
  EXPECT_NEAR(areas[0], -4, 0.02);  // corners are cut off by half a cell
  EXPECT_NEAR(areas[1], 54, 0.02);
  EXPECT_NEAR(areas[2], 64, 0.02);
  EXPECT_NEAR(sum, uncovered_area(mesh.vertices, mesh.triangles, square_loop(9), Vec3::UnitZ()).area, 0.04);
}

TEST(Outlines, StayTheSameWhereverTheSurfaceLies) {
  const TriangleMesh funnel = ring(40, 4, 10, -3);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const auto moved = [&](const Points& p) -> Points { return (turn * p).colwise() + Vec3(100, -50, 20); };
  const ViewFrame frame = view_frame(Vec3(100, -50, 20), turn * Vec3::UnitZ());
  const Points loop = moved(circle(40, 10));
  const Outline outline =
      open_outlines(top_view(moved(funnel.vertices), funnel.triangles, loop, frame, 0.05)).at(0);
  EXPECT_NEAR(outline.area, 0.5 * 40 * 16 * std::sin(2 * kPi / 40), 2e-3);
  EXPECT_NEAR(outline.mean_height, -3, 1e-9);
  for (const auto& corner : outline.corners.colwise())
    EXPECT_NEAR((turn.transpose() * (corner - Vec3(100, -50, 20)))[2], -3, 1e-9);
}

TEST(ClosedView, FillsSlitsUpToTheWindowAndLeavesSlopesAndHoles) {
  TriangleMesh mesh =
      grid_sheet(1, 1, [](double u, double v) { return Vec3(5 * u - 5.1, 10 * v - 5, 0.4 * u); });
  append(mesh, grid_sheet(1, 1, [](double u, double v) { return Vec3(3 * u + 0.1, 10 * v - 5, 0.4); }));
  const TopView view = top_view(mesh.vertices, mesh.triangles, square_loop(4.9), kDown, 0.05, 4);
  const ClosedView closed = closed_view(view, 3);  // slits of up to 0.3
  long filled = 0, holes = 0;
  for (size_t n = 0; n < closed.height.size(); ++n) {
    if (!view.is_inside[n]) continue;
    if (view.triangle[n] >= 0) {
      EXPECT_NEAR(closed.height[n], view.height[n], 1e-12);
    }
    if (view.is_open[n] && std::isfinite(closed.height[n])) ++filled;
    if (view.is_open[n] && !std::isfinite(closed.height[n])) ++holes;
  }
  EXPECT_EQ(filled, 4 * 196);         // the slit, 0.2 wide
  EXPECT_NEAR(holes, 36 * 196, 200);  // beside the second sheet, 1.8 wide
}

TEST(SpanningSurface, ReproducesAPlaneExactlyAndThePolygonOnItsEdges) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Points star(3, 11);
  for (int k = 0; k < 11; ++k) {
    const double radius = 5 + 2 * uniform(random);
    star.col(k) << radius * std::cos(2 * kPi * k / 11), radius * std::sin(2 * kPi * k / 11), 0;
  }
  Points tilted = star;
  tilted.row(2) = 0.3 * star.row(0) - 0.7 * star.row(1);
  for (int trial = 0; trial < 100; ++trial) {
    const double x = 2 * uniform(random), y = 2 * uniform(random);
    EXPECT_NEAR(spanned_height(tilted, x, y), 0.3 * x - 0.7 * y, 1e-12);
    EXPECT_NEAR(highest_chord(tilted, x, y), 0.3 * x - 0.7 * y, 1e-12);
    EXPECT_NEAR(SpanningSurface(tilted).height(x, y), 0.3 * x - 0.7 * y, 1e-12);
  }
  star.row(2).setRandom();
  const Vec3 on_edge = 0.25 * star.col(3) + 0.75 * star.col(4);
  EXPECT_NEAR(spanned_height(star, on_edge[0], on_edge[1]), on_edge[2], 1e-6);
  EXPECT_EQ(spanned_height(star, star(0, 5), star(1, 5)), star(2, 5));
}

// A rectangle along the axes but for rounding: places on its edges lie on them and just beside.
TEST(SpanningSurface, HasAHeightOnEdgesThatRoundingTurns) {
  for (const double angle : {1e-17, 1e-16, 3e-16, 1e-15, 1e-13}) {
    Points rectangle(3, 4);
    rectangle << -10, 10, 10, -10, -8, -8, 8, 8, 0, 1, 2, 3;
    const Eigen::RowVectorXd x = rectangle.row(0);
    rectangle.row(0) -= angle * rectangle.row(1);
    rectangle.row(1) += angle * x;
    for (int i = 0; i <= 64; ++i) {
      const double share = i / 64.0;
      EXPECT_NEAR(spanned_height(rectangle, -10 + 20 * share, -8), share, 1e-9) << angle;
      EXPECT_NEAR(spanned_height(rectangle, -10 + 20 * share, 8), 3 - share, 1e-9) << angle;
    }
  }
}

TEST(SpanningSurface, LiesNowhereAboveTheHighestChord) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    Points loop = circle(200, 5);
    const double amplitude = uniform(random), phase = uniform(random);
    for (int k = 0; k < 200; ++k) loop(2, k) = amplitude * std::cos(4 * kPi * k / 200 + phase);
    const double x = 3 * uniform(random), y = 3 * uniform(random);
    EXPECT_LE(spanned_height(loop, x, y), highest_chord(loop, x, y) + 1e-3);
  }
}

TEST(SpanningSurface, HasItsHighestChordAlongTheHighEndsOfASaddle) {
  Points saddle = circle(360, 10);
  saddle.row(2) = 0.03 * (saddle.row(0).array().square() - saddle.row(1).array().square());
  EXPECT_NEAR(highest_chord(saddle, 0, 0), 3, 1e-3);
  EXPECT_NEAR(spanned_height(saddle, 0, 0), 0, 1e-3);
  EXPECT_NEAR(highest_chord(saddle, 0, 5), 0.03 * (75 - 25), 0.02);  // across, along x
  EXPECT_EQ(highest_chord(saddle, 20, 0), -kInfinity);
}

// A valve that has run away lies beyond any int on the grid of its annulus.
TEST(TopView, LooksPastWhatHasRunAway) {
  TriangleMesh sheet = grid_sheet(2, 2, [](double u, double v) { return Vec3(8 * u - 4, 8 * v - 4, 0); });
  const Points loop = square_loop(3);
  const Eigen::Index own = sheet.vertices.cols();
  sheet.vertices.conservativeResize(3, own + 9);
  sheet.triangles.conservativeResize(3, sheet.triangles.cols() + 3);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vec3 away = 1e12 * (k == 2 ? Vec3(-1, -1, 1) : Vec3(k == 0, k == 1, 1));
    for (Eigen::Index c = 0; c < 3; ++c)
      sheet.vertices.col(own + 3 * k + c) = away + Vec3(c == 1, c == 2, 0) * 1e11;
    sheet.triangles.col(sheet.triangles.cols() - 3 + k)
        .setLinSpaced(3, static_cast<int>(own + 3 * k), static_cast<int>(own + 3 * k + 2));
  }
  const TopView view = top_view(sheet.vertices, sheet.triangles, loop, kDown, 0.1);
  for (const int triangle : view.triangle) EXPECT_LT(triangle, sheet.triangles.cols() - 3);
  EXPECT_EQ(std::count(view.is_open.begin(), view.is_open.end(), 1), 0);
}

TEST(TopView, RefusesMoreLinesThanItCanNumber) {
  const TriangleMesh sheet = grid_sheet(2, 2, [](double u, double v) { return Vec3(u, v, 0); });
  EXPECT_THROW(top_view(sheet.vertices, sheet.triangles, square_loop(3), kDown, 1e-9), InputError);
}

TEST(VertexGraph, HoldsEveryEdgeOfTheMeshFromBothEnds) {
  const TriangleMesh sheet = wavy_sheet(6);
  const VertexGraph graph = vertex_graph(sheet.triangles, sheet.vertices.cols());
  size_t count = 0;
  for (const Edge& edge : edges(sheet.triangles)) {
    for (const auto& [a, b] : {std::pair(edge.a, edge.b), std::pair(edge.b, edge.a)}) {
      const auto around = graph.of(a);
      EXPECT_EQ(std::count(around.begin(), around.end(), b), 1);
    }
    count += 2;
  }
  EXPECT_EQ(graph.neighbour.size(), count);
}

}  // namespace
}  // namespace coapt
