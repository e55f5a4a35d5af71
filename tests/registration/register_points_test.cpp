#include "registration/register_points.hpp"

#include "core/error.hpp"
#include "registration/motions.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

TEST(RegisterPoints, LandmarksComeBackToRounding) {
  std::mt19937 random(1);
  for (int k = 0; k < 20; ++k) {
    const Points target = 20 * Points::Random(3, 5);
    RigidMotion motion = random_motion(target, random);
    motion.scale = 1.25;
    const Points moving = motion.apply(target);
    EXPECT_LT(greatest_distance(register_landmarks(moving, target, true).motion.apply(moving), target),
              1e-12);
  }
}

TEST(RegisterPoints, AMotionAndItsInverseUndoEachOther) {
  std::mt19937 random(2);
  const Points x = 20 * Points::Random(3, 5);
  RigidMotion motion = random_motion(x, random);
  motion.scale = 0.5;
  EXPECT_GT(greatest_distance(motion.apply(x), x), 5);
  EXPECT_LT(greatest_distance(motion.inverse().apply(motion.apply(x)), x), 1e-12);
  EXPECT_NEAR(motion.angle_deg(), 30, 1e-10);
}

TEST(RegisterPoints, RefuseWhatSaysNothingOrAMirrorImage) {
  Points line(3, 4);
  line << 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3;
  EXPECT_THROW(register_landmarks(line, line), InputError);
  const Points x = 20 * Points::Random(3, 6);
  EXPECT_THROW(register_landmarks(x.leftCols(2), x.leftCols(2)), InputError);
  EXPECT_THROW(register_landmarks(x.leftCols(4), x.leftCols(5)), InputError);
  Points mirrored = x;
  mirrored.row(0) *= -1;
  EXPECT_THROW(register_landmarks(mirrored, x), InputError);
}

TEST(RegisterPoints, AnAnnulusComesBackFromAnyStartAndSense) {
  const TriangleMesh mesh = valve_like(1500);
  const Points target = annulus_loop(mesh);
  std::mt19937 random(3);
  for (int k = 0; k < 20; ++k) {
    const Points moved = random_motion(target, random).apply(target);
    Points moving(3, target.cols());
    for (Eigen::Index i = 0; i < target.cols(); ++i)
      moving.col(i) = moved.col(k % 2 == 0 ? (i + 7 * k) % target.cols()
                                           : (2 * target.cols() + 7 * k - i) % target.cols());
    const Registration found = register_curves(moving, target, {.trim = 0});
    Points back = found.motion.apply(moved);
    EXPECT_LT(greatest_distance(back, target), 1e-9);
  }
}

TEST(RegisterPoints, ASurfaceWithoutBorderHasNoAnnulus) {
  EXPECT_THROW(annulus_loop(sphere(10, 80)), InputError);
}

}  // namespace
}  // namespace coapt
