#include "mesh/distance/intersections.hpp"

#include "core/timing.hpp"
#include "mesh/orientation.hpp"
#include "support/mesh_samples.hpp"

#include <gtest/gtest.h>

#include <random>

namespace coapt {
namespace {

__extension__ typedef __int128 Wide;  // not ISO, but in both compilers

int sign(Wide value) { return value > 0 ? 1 : value < 0 ? -1 : 0; }

// Coordinates are whole numbers over 2^40 beside a large offset: differences fit into 128 bits exactly.
TEST(Orientation, AgreesWithWholeNumbersWhereRoundingCannotDecide) {
  std::mt19937_64 random(11);
  int zeros = 0, others = 0;
  for (int i = 0; i < 3000; ++i) {
    std::array<std::array<long long, 3>, 4> p;
    for (auto& point : p)
      for (long long& x : point) x = static_cast<long long>(random() % (1u << 30)) + (1LL << 40);
    // d in the plane of a, b, c, or one unit beside it
    const long long m = static_cast<long long>(random() % 5) - 2,
                    n = static_cast<long long>(random() % 5) - 2;
    for (size_t k = 0; k < 3; ++k) p[3][k] = p[0][k] + m * (p[1][k] - p[0][k]) + n * (p[2][k] - p[0][k]);
    p[3][random() % 3] += static_cast<long long>(random() % 3) - 1;
    std::array<Vec3, 4> x;
    std::array<std::array<Wide, 3>, 4> d;
    for (size_t v = 0; v < 4; ++v)
      for (size_t k = 0; k < 3; ++k) {
        x[v][static_cast<int>(k)] = std::ldexp(static_cast<double>(p[v][k]), -40);
        d[v][k] = p[v][k] - p[0][k];
      }
    const auto minor = [&](size_t k, size_t l) { return d[1][k] * d[2][l] - d[1][l] * d[2][k]; };
    const int wanted = sign(minor(1, 2) * d[3][0] + minor(2, 0) * d[3][1] + minor(0, 1) * d[3][2]);
    EXPECT_EQ(orientation(x[0], x[1], x[2], x[3]), wanted);
    EXPECT_EQ(orientation(x[1], x[0], x[2], x[3]), -wanted);
    const Eigen::Vector2d a = x[0].head<2>(), b = x[1].head<2>(), c = x[3].head<2>();
    EXPECT_EQ(orientation(a, b, c), sign(d[1][0] * d[3][1] - d[1][1] * d[3][0]));
    (wanted == 0 ? zeros : others)++;
  }
  EXPECT_GT(zeros, 500);
  EXPECT_GT(others, 500);
}

size_t pair_count(std::initializer_list<Vec3> corners) {
  Points points(3, 6);
  int i = 0;
  for (const Vec3& corner : corners) points.col(i++) = corner;
  Triangles triangles(3, 2);
  triangles << 0, 3, 1, 4, 2, 5;
  const size_t count = intersecting_pairs(points, triangles).size();
  triangles.col(0).swap(triangles.col(1));
  EXPECT_EQ(intersecting_pairs(points, triangles).size(), count);
  return count;
}

TEST(Intersections, TellsCrossingTouchingAndApart) {
  const Vec3 o(0, 0, 0), x(4, 0, 0), y(0, 4, 0);
  EXPECT_EQ(pair_count({o, x, y, {1, 1, -1}, {1, 1, 1}, {2, 2, 3}}), 1u);     // through
  EXPECT_EQ(pair_count({o, x, y, {1, 1, 0}, {1, 1, 1}, {2, 2, 3}}), 1u);      // a corner on the face
  EXPECT_EQ(pair_count({o, x, y, {1, 1, 1e-60}, {1, 1, 1}, {2, 2, 3}}), 0u);  // just above it
  EXPECT_EQ(pair_count({o, x, y, {3, 3, -1}, {3, 3, 1}, {9, 9, 0}}), 0u);     // beside
  EXPECT_EQ(pair_count({o, x, y, {1, 1, 0}, {1.5, 1, 0}, {1, 1.5, 0}}), 1u);  // inside, same plane
  EXPECT_EQ(pair_count({o, x, y, {2, 2, 0}, {5, 2, 0}, {5, 5, 0}}), 1u);      // touching, same plane
  EXPECT_EQ(pair_count({o, x, y, {2.001, 2, 0}, {5, 2, 0}, {5, 5, 0}}), 0u);  // apart, same plane
  EXPECT_EQ(pair_count({o, x, y, {-1, 1, 0}, {5, 1, 0}, {5, 1.5, 0}}), 1u);   // across, same plane
  EXPECT_EQ(pair_count({o, x, y, {1, 1, -1}, {1, 1, 1}, {1, 1, 0.5}}), 1u);   // a needle through it
  EXPECT_EQ(pair_count({o, x, y, o, x, y}), 1u);                              // twice the same
}

TEST(Intersections, LeavesOutTrianglesThatShareAVertex) {
  const TriangleMesh sheet = wavy_sheet(20);
  EXPECT_TRUE(intersecting_pairs(sheet.vertices, sheet.triangles).empty());
}

TEST(Intersections, AgreeWithTheCountsStatedForTheGivenValves) {
  if (!is_shared("data/trivalve11-healthy")) GTEST_SKIP() << kDataNotFound;
  const auto count = [](const std::string& name) {
    const TriangleMesh mesh = read_mesh(shared_path("data/" + name)).mesh;
    return intersecting_pairs(mesh.vertices, mesh.triangles).size();
  };
  EXPECT_EQ(count("trivalve11-healthy/leaflets_closed_reference.obj"), 56u);
  EXPECT_EQ(count("trivalve11-healthy/leaflets_closed_reference_coarse.obj"), 84u);
  EXPECT_EQ(count("trivalve11-healthy/leaflets_open.obj"), 0u);
  EXPECT_EQ(count("trivalve11-healthy/leaflets_open_coarse.obj"), 0u);
  EXPECT_EQ(count("mitral-ct-normal1/leaflets_pressurised_reference_n32.obj"), 33u);
  EXPECT_EQ(count("mitral-ct-normal1/leaflets_pressurised_reference_n64.obj"), 0u);
  EXPECT_EQ(count("mitral-ct-normal1/leaflets_pressurised_reference_n128.obj"), 0u);
}

TEST(Intersections, TakeLittleTimeOnAFineMesh) {
  const TriangleMesh sheet = wavy_sheet(91);  // 16,562 triangles
  const double begin = cpu_seconds();
  EXPECT_TRUE(intersecting_pairs(sheet.vertices, sheet.triangles).empty());
  RecordProperty("seconds", std::to_string(cpu_seconds() - begin));
  EXPECT_LT(cpu_seconds() - begin, 30);  // a quadratic search takes far longer, also under sanitizers
}

}  // namespace
}  // namespace coapt
