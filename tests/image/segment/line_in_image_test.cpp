// The coaptation line that an image shows, where two sheets meet at a known place.
#include "image/segment/line_in_image.hpp"

#include "core/random_source.hpp"
#include "image/segment/annulus_region.hpp"
#include "mesh/distance/surface_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace coapt {
namespace {

constexpr int kAlong = 21;  // points of the line, 1 mm apart

// Two leaflets that rise from the line at x = z = 0 to both sides, and hang below it as one sheet.
TriangleMesh meeting_leaflets() {
  const std::vector<Vec3> profile = {{-9, 0, 3}, {-4, 0, 2.5}, {0, 0, 0}, {0.05, 0, -4},
                                     {0, 0, -4}, {0, 0, 0},    {4, 0, 2}, {9, 0, 2}};
  const auto across = static_cast<int>(profile.size());
  TriangleMesh mesh;
  mesh.vertices.resize(3, across * kAlong);
  std::vector<Eigen::Vector3i> triangles;
  for (int row = 0; row < kAlong; ++row)
    for (int n = 0; n < across; ++n) {
      mesh.vertices.col(row * across + n) = profile[static_cast<size_t>(n)] + Vec3(0, row, 0);
      if (row == 0 || n == 0 || n == 4) continue;  // the two leaflets do not hang together
      const int here = row * across + n, below = here - across;
      triangles.emplace_back(below - 1, below, here);
      triangles.emplace_back(below - 1, here, here - 1);
    }
  mesh.triangles.resize(3, static_cast<Eigen::Index>(triangles.size()));
  for (size_t t = 0; t < triangles.size(); ++t)
    mesh.triangles.col(static_cast<Eigen::Index>(t)) = triangles[t];
  return mesh;
}

Points the_line() {
  Points line = Points::Zero(3, kAlong);
  for (int n = 0; n < kAlong; ++n) line(1, n) = n;
  return line;
}

// Bright sheets of these leaflets, moved, in noise; voxels of 0.5 mm.
Volume image_of(TriangleMesh leaflets, const Vec3& shift, double brightness) {
  leaflets.vertices.colwise() += shift;
  Volume volume;
  volume.size = {48, 48, 48};
  volume.spacing = Vec3::Constant(0.5);
  volume.origin = Vec3(-12, -2, -12);
  Points centres(3, 48 * 48 * 48);
  for (int k = 0; k < 48; ++k)
    for (int j = 0; j < 48; ++j)
      for (int i = 0; i < 48; ++i)
        centres.col(static_cast<Eigen::Index>(volume.voxel(i, j, k))) = position_of(volume, Vec3(i, j, k));
  RandomSource random(5);
  for (const double away : surface_distance(centres, leaflets).vertex_distances)
    volume.values.push_back(
        static_cast<float>(60 * random.unit() + brightness * std::exp(-0.5 * away * away / 0.36)));
  return volume;
}

double shown_share(const LineInImage& line) {
  return std::accumulate(line.is_shown.begin(), line.is_shown.end(), 0.0) /
         static_cast<double>(line.is_shown.size());
}

TEST(LineInImage, IsFoundWhereTheSheetsMeetInTheImage) {
  for (const Vec3& shift : {Vec3(0, 0, 0), Vec3(1.8, 0, -1.1), Vec3(-2.6, 0, 0.7)}) {
    const Volume image = image_of(meeting_leaflets(), shift, 120);
    const auto lines = line_in_image(image, meeting_leaflets(), {the_line()}, Vec3::UnitZ());
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0].predicted.cols(), 41);
    EXPECT_EQ(shown_share(lines[0]), 1);
    for (Eigen::Index n = 0; n < lines[0].found.cols(); ++n) {
      const Vec3 moved = lines[0].found.col(n) - lines[0].predicted.col(n) - shift;
      EXPECT_LE(moved.cwiseAbs().maxCoeff(), 0.3) << n;  // mm; half a pixel and noise
      EXPECT_GT(lines[0].likeness[n], 0.7);
    }
  }
}

TEST(LineInImage, IsNotShownByNoiseNorBeyondItsReach) {
  const Volume noise = image_of(meeting_leaflets(), Vec3::Zero(), 0);
  EXPECT_EQ(shown_share(line_in_image(noise, meeting_leaflets(), {the_line()}, Vec3::UnitZ())[0]), 0);
  const Volume far = image_of(meeting_leaflets(), Vec3(0, 0, -6), 120);
  EXPECT_LT(shown_share(line_in_image(far, meeting_leaflets(), {the_line()}, Vec3::UnitZ())[0]), 0.1);
}

TEST(LineInImage, LeavesOutPiecesThatAreTooShortToSay) {
  const Volume image = image_of(meeting_leaflets(), Vec3::Zero(), 120);
  EXPECT_TRUE(line_in_image(image, meeting_leaflets(), {the_line().leftCols(3), Points(3, 0)}, Vec3::UnitZ())
                  .empty());
}

TEST(GoesRoundOnce, TellsARingFromPointsInNoOrder) {
  Points ring(3, 12), twice(3, 12), eight(3, 12);
  for (int n = 0; n < 12; ++n) {
    const double angle = 2 * std::numbers::pi * n / 12;
    ring.col(n) = Vec3(20 * std::cos(angle), 14 * std::sin(angle), 2 * std::cos(2 * angle));
    twice.col(n) = Vec3(20 * std::cos(2 * angle + 0.01 * n), 14 * std::sin(2 * angle), 0);
    eight.col(n) = Vec3(20 * std::sin(2 * angle + 0.1), 14 * std::sin(angle), 0);
  }
  EXPECT_TRUE(goes_round_once(ring));
  EXPECT_TRUE(goes_round_once(ring.rowwise().reverse()));
  EXPECT_FALSE(goes_round_once(twice));
  EXPECT_FALSE(goes_round_once(eight));
  ring.col(3).swap(ring.col(9));
  EXPECT_FALSE(goes_round_once(ring));
}

}  // namespace
}  // namespace coapt
