// Stress rows S1 and S7: the answer does not depend on units, numbering, orientation or point of view. (S2, a
// scene far from the origin, is the scene's own matter: tests/solve/build_test.cpp.)
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <cstdio>

namespace coapt {
namespace {

class ValveFrames : public testing::Test {
 protected:
  ValveFrames() : plain_(scene_.solve_in({}, 1e-10)), held_(scene_.held_nodes(plain_.x)) {}

  // Largest distance of the held nodes from where they are in the plain frame [mm].
  void expect_same(const char* name, const Frame& frame, double most, bool is_reversed = false) const {
    const Equilibrium found = scene_.solve_in(frame, 1e-10, is_reversed);
    const double distance = (found.x - plain_.x)(Eigen::all, held_).colwise().norm().maxCoeff();
    std::printf("%s: distance %.1e of the size, %d iterations (plain: %d)\n", name, distance / size(),
                found.result.iterations, plain_.result.iterations);
    EXPECT_EQ(found.result.status, plain_.result.status) << name << ": " << found.result.message;
    EXPECT_LT(distance / size(), most) << name;
    EXPECT_LE(found.result.iterations, 1.2 * plain_.result.iterations) << name;
    EXPECT_GE(found.result.iterations, 0.8 * plain_.result.iterations) << name;
  }
  double size() const { return bounding_box_diagonal(scene_.X); }

  const ValveScene scene_{ValveOptions{}};
  const Equilibrium plain_;
  const std::vector<int> held_;
};

TEST_F(ValveFrames, S1UnitsDoNotMatter) {
  // From mm and MPa (hence N): metres and pascals, mm and kPa, micrometres and pascals, and absurd scales.
  expect_same("S1 m-Pa", scaled_frame(1e-3, 1), 1e-8);
  expect_same("S1 mm-kPa", scaled_frame(1, 1e3), 1e-8);
  expect_same("S1 um-Pa", scaled_frame(1e3, 1e12), 1e-8);
  expect_same("S1 1e-6", scaled_frame(1e-6, 1), 1e-8);
  expect_same("S1 1e6", scaled_frame(1e6, 1), 1e-8);
}

TEST_F(ValveFrames, S7NumbersSidesAndViewsDoNotMatter) {
  Frame mirrored;
  mirrored.rotation = Vec3(-1, 1, 1).asDiagonal();
  expect_same("S7 renumbered", renumbered_frame(static_cast<int>(scene_.X.cols())), 1e-9);
  expect_same("S7 rotated", rotated_frame(), 1e-9);
  expect_same("S7 mirrored", mirrored, 1e-9);
  expect_same("S7 turned over", {}, 1e-9, true);
}

}  // namespace
}  // namespace coapt
