#include "registration/register_surfaces.hpp"

#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "registration/motions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace coapt {
namespace {

// What is left of a registration at the moving vertices, whose true places are known.
double error_of(const Registration& found, const Points& moved, const Points& truth) {
  return greatest_distance(found.motion.apply(moved), truth);
}

// The half of a surface on one side of its middle; its vertices stay, also those without triangles.
TriangleMesh half_of(const TriangleMesh& mesh, double angle) {
  const Vec3 side(std::cos(angle), std::sin(angle), 0);
  TriangleMesh half = mesh;
  int kept = 0;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    Vec3 sum = Vec3::Zero();
    for (const int v : mesh.triangles.col(t)) sum += mesh.vertices.col(v);
    if (side.dot(sum) > 0) half.triangles.col(kept++) = mesh.triangles.col(t);
  }
  half.triangles.conservativeResize(3, kept);
  return half;
}

TEST(RegisterSurfaces, EqualSurfacesComeBackToRoundingFrom30DegreesAnd10Millimetres) {
  const TriangleMesh target = valve_like(2000);
  std::mt19937 random(1);
  for (int k = 0; k < 24; ++k) {
    TriangleMesh moving = target;
    moving.vertices = random_motion(target.vertices, random).apply(target.vertices);
    const Registration found = register_surfaces(moving, target);
    EXPECT_LT(error_of(found, moving.vertices, target.vertices), 1e-9) << k;
    EXPECT_GT(found.overlap, 0.99);
    EXPECT_EQ(found.free_directions, 0);
  }
}

TEST(RegisterSurfaces, ScaleComesBackToo) {
  const TriangleMesh target = valve_like(2000);
  std::mt19937 random(2);
  TriangleMesh moving = target;
  RigidMotion motion = random_motion(target.vertices, random);
  motion.scale = 1.1;
  moving.vertices = motion.apply(target.vertices);
  const Registration found = register_surfaces(moving, target, {.with_scale = true});
  EXPECT_LT(error_of(found, moving.vertices, target.vertices), 1e-9);
}

TEST(RegisterSurfaces, AScanWithNoiseOutliersAndHalfOfTheSurfaceFindsItsPlace) {
  const TriangleMesh whole = valve_like(10000);
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> share;
  for (int k = 0; k < 20; ++k) {
    TriangleMesh scan = half_of(whole, 0.3 * k);
    const RigidMotion motion = random_motion(whole.vertices, random);
    const Points exact = motion.apply(whole.vertices);
    for (int v = 0; v < scan.vertex_count(); ++v) {
      const Vec3 step = random_vector(random, normal);
      scan.vertices.col(v) = exact.col(v) + (share(random) < 0.2 ? 8.0 : 0.5) * step;
    }
    const Registration found = register_surfaces(scan, whole);
    std::vector<int> seen(scan.triangles.data(), scan.triangles.data() + scan.triangles.size());
    const Points off = (found.motion.apply(exact) - whole.vertices)(Eigen::all, seen);
    // No unbiased estimate leaves less than 0.07 to 0.11 mm of this noise (Cramer-Rao).
    const double error = std::sqrt(off.colwise().squaredNorm().mean());
    EXPECT_LT(error, 0.25) << k;
    EXPECT_FALSE(found.from_target);
    EXPECT_LT(error, 3 * found.standard_error.value()) << k;
    EXPECT_GT(error, *found.standard_error / 5) << k;
    EXPECT_TRUE(registration_doubts(found).empty()) << k;
  }
}

TEST(RegisterSurfaces, ANearlyRoundBowlWithNoiseSaysThatItsTurnIsUncertain) {
  TriangleMesh bowl = disc(20, 4000);
  for (auto p : bowl.vertices.colwise()) p[2] = p.head<2>().squaredNorm() / 40 + 0.004 * p[0] * p[1];
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  TriangleMesh scan = bowl;
  for (auto v : scan.vertices.colwise()) v += 0.5 * random_vector(random, normal);
  const Registration found = register_surfaces(scan, bowl);
  EXPECT_EQ(found.free_directions, 0);
  EXPECT_GT(found.standard_error.value(), 0.2);
  ASSERT_EQ(registration_doubts(found).size(), 1);
  EXPECT_NE(registration_doubts(found)[0].find("standard error"), std::string::npos);
}

TEST(RegisterSurfaces, TheWholeFindsItsPlaceOnAHalf) {
  const TriangleMesh whole = valve_like(2000), half = half_of(whole, 1);
  std::mt19937 random(6);
  for (int k = 0; k < 20; ++k) {
    TriangleMesh moving = whole;
    moving.vertices = random_motion(whole.vertices, random).apply(whole.vertices);
    const Registration found = register_surfaces(moving, half);
    EXPECT_LT(error_of(found, moving.vertices, whole.vertices), 1e-9) << k;
    EXPECT_TRUE(found.from_target);
  }
}

TEST(RegisterSurfaces, RefuseAMirrorImageAndSurfacesWithoutOverlap) {
  const TriangleMesh target = valve_like(2000);
  TriangleMesh mirrored = target;
  mirrored.vertices.row(1) *= -1;
  std::mt19937 random(6);
  mirrored.vertices = random_motion(target.vertices, random).apply(mirrored.vertices);
  try {
    register_surfaces(mirrored, target);
    FAIL() << "a mirror image was registered";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("mirror image"), std::string::npos);
  }
  try {
    register_surfaces(sphere(8, 2000), target);
    FAIL() << "surfaces without overlap were registered";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no overlap"), std::string::npos);
  }
}

TEST(RegisterSurfaces, RefuseASurfaceInAnotherUnit) {
  const TriangleMesh target = valve_like(2000);
  TriangleMesh in_centimetres = target;
  in_centimetres.vertices *= 0.1;
  const auto message = [](const TriangleMesh& moving, const TriangleMesh& onto) -> std::string {
    try {
      register_surfaces(moving, onto);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  for (const std::string& text : {message(in_centimetres, target), message(target, in_centimetres)})
    EXPECT_NE(text.find("unit of length"), std::string::npos) << text;
}

TEST(RegisterSurfaces, ThePublishedClosedTricuspidValveComesBack) {
  const auto file =
      std::filesystem::path(COAPT_SHARED_DIR) / "data/trivalve11-healthy/leaflets_closed_reference.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: data not found";
  const TriangleMesh target = read_mesh(file).mesh;
  std::mt19937 random(7);
  for (int k = 0; k < 5; ++k) {
    TriangleMesh moving = target;
    moving.vertices = random_motion(target.vertices, random).apply(target.vertices);
    EXPECT_LT(error_of(register_surfaces(moving, target), moving.vertices, target.vertices), 1e-9) << k;
  }
}

// Of such a valve only the part by the annulus was seen: half of the whole has no counterpart.
TEST(RegisterSurfaces, AWholeValveWithNoiseIsNotRefusedOnItsUpperPart) {
  const auto file =
      std::filesystem::path(COAPT_SHARED_DIR) / "data/trivalve11-healthy/leaflets_open_coarse.obj";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: data not found";
  const TriangleMesh whole = read_mesh(file).mesh;
  std::vector<std::vector<int>> loops = boundary_loops(whole.triangles);
  std::sort(loops.begin(), loops.end(), [&](const auto& a, const auto& b) {
    return whole.vertices(2, a).mean() > whole.vertices(2, b).mean();
  });
  const Points annulus = whole.vertices(Eigen::all, loops.front());
  TriangleMesh upper = whole;
  int kept = 0;
  for (const auto& corners : whole.triangles.colwise()) {
    double farthest = 0;
    for (const int v : corners)
      farthest = std::max(farthest, (annulus.colwise() - whole.vertices.col(v)).colwise().norm().minCoeff());
    if (farthest < 6) upper.triangles.col(kept++) = corners;
  }
  upper.triangles.conservativeResize(3, kept);
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 16; ++k) {
    TriangleMesh moving = whole;
    for (auto p : moving.vertices.colwise()) p += 0.4 * random_vector(random, normal);
    Registration found;
    ASSERT_NO_THROW(found = register_surfaces(moving, upper)) << k;
    EXPECT_GT(found.overlap, 0.4) << k;
    EXPECT_FALSE(registration_doubts(found).empty()) << k;
  }
}

}  // namespace
}  // namespace coapt
