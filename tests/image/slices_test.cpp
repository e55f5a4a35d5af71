#include "core/error.hpp"
#include "image/slices/valve_slices.hpp"
#include "mesh/shapes.hpp"
#include "support/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

namespace coapt {
namespace {

constexpr Colour kMark = {255, 0, 0};

// 21 x 21 x 21 voxels of 1 mm around the origin, as bright as their x + 10.
Volume ramp() {
  Volume volume;
  volume.size = {21, 21, 21};
  volume.origin = Vec3(-10, -10, -10);
  for (int k = 0; k < 21; ++k)
    for (int j = 0; j < 21; ++j)
      for (int i = 0; i < 21; ++i) volume.values.push_back(static_cast<float>(i));
  return volume;
}

Colour colour_at(const Picture& picture, int i, int j) {
  const auto at = static_cast<std::size_t>(3 * (j * picture.width + i));
  return {picture.colours[at], picture.colours[at + 1], picture.colours[at + 2]};
}

std::vector<std::array<int, 2>> marked(const Picture& picture) {
  std::vector<std::array<int, 2>> places;
  for (int j = 0; j < picture.height; ++j)
    for (int i = 0; i < picture.width; ++i)
      if (colour_at(picture, i, j) == kMark) places.push_back({i, j});
  return places;
}

const SlicePlane kFromFront = {Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ(), 20, 10};

TEST(SlicePicture, ShowsTheValuesWhereTheyLie) {
  const Picture picture = slice_picture(ramp(), kFromFront, 0.5, {0, 20});
  ASSERT_EQ(picture.width, 40);
  ASSERT_EQ(picture.height, 20);
  EXPECT_EQ(picture.colours.size(), 3u * 40 * 20);
  const double left = -10 + 0.25;  // mm, of the centre of the first pixel
  EXPECT_NEAR(colour_at(picture, 0, 3)[0], 255 * (left + 10) / 20, 1);
  EXPECT_NEAR(colour_at(picture, 39, 17)[2], 255 * (10 - left) / 20, 1);
  const SlicePlane beyond = {Vec3(0, 50, 0), Vec3::UnitX(), Vec3::UnitZ(), 4, 4};
  const Picture black = slice_picture(ramp(), beyond, 1, {0, 20});
  EXPECT_EQ(*std::max_element(black.colours.begin(), black.colours.end()), 0);
}

TEST(SlicePicture, TheGreatestValuesOfAFewVoxelsDoNotDarkenTheRest) {
  Volume volume = ramp();
  volume.values[17] = 1e6F;
  const GreyRange range = grey_range(volume);
  EXPECT_EQ(range.black, 0);
  EXPECT_EQ(range.white, 20);
  volume.values.assign(volume.values.size(), 0);
  volume.values[5] = 1;  // too few to be seen beside the others, and all that there is
  EXPECT_EQ(grey_range(volume).white, 1);
}

TEST(SlicePicture, TheSectionOfASphereIsACircle) {
  const TriangleMesh ball = sphere(4, 2000);
  Picture picture = slice_picture(ramp(), kFromFront, 0.25, {0, 20});
  ASSERT_TRUE(marked(picture).empty());
  draw_section(picture, kFromFront, 0.25, ball, kMark);
  const auto places = marked(picture);
  EXPECT_GT(places.size(), 2 * std::numbers::pi * 4 / 0.25 / std::numbers::sqrt2);
  for (const auto& [i, j] : places) {
    const double x = (i - 39.5) * 0.25, z = -(j - 19.5) * 0.25;
    EXPECT_NEAR(std::hypot(x, z), 4, 0.35);
  }
  SlicePlane beside = kFromFront;
  beside.centre.y() = 4.5;
  Picture empty = slice_picture(ramp(), beside, 0.25, {0, 20});
  draw_section(empty, beside, 0.25, ball, kMark);
  EXPECT_TRUE(marked(empty).empty());
}

TEST(SlicePicture, PointsAreDrawnNearThePlaneAlone) {
  Points points(3, 3);
  points.col(0) << 5, 0.4, 2;
  points.col(1) << 5, 3, -2;     // too far before it
  points.col(2) << 50, 0.1, 50;  // outside of the picture
  Picture picture = slice_picture(ramp(), kFromFront, 0.5, {0, 20});
  draw_points(picture, kFromFront, 0.5, points, 0.5, kMark);
  const auto places = marked(picture);
  ASSERT_EQ(places.size(), 1u);
  EXPECT_NEAR(places[0][0], 5 / 0.5 + 19.5, 0.6);
  EXPECT_NEAR(places[0][1], -2 / 0.5 + 9.5, 0.6);
}

TEST(ValveSlices, GoAlongTheAxisWithTheAtriumAbove) {
  Points annulus(3, 40);
  for (int k = 0; k < 40; ++k) {
    const double angle = 2 * std::numbers::pi * k / 40;
    annulus.col(k) << 8 * std::cos(angle), 6 * std::sin(angle), 1;
  }
  for (const double side : {-1.0, 1.0}) {
    const auto planes = valve_planes(annulus, Vec3(0, 0, 1 + 5 * side));
    ASSERT_EQ(planes.size(), 3u);
    for (const SlicePlane& plane : planes) {
      EXPECT_NEAR(plane.up.z(), -side, 1e-9);
      EXPECT_NEAR(plane.up.dot(plane.right), 0, 1e-9);
      EXPECT_GT((plane.centre.z() - 1) * side, 1);  // towards the leaflets
    }
    EXPECT_NEAR(std::abs(planes[2].right.x()), 1, 1e-6);
    EXPECT_NEAR(std::abs(planes[0].right.y()), 1, 1e-6);
    EXPECT_NEAR(planes[1].centre.x() - planes[0].centre.x(), 16.0 / 3 * (planes[2].right.x() > 0 ? 1 : -1),
                0.1);
  }
}

TEST(ValveSlices, AFileHoldsThePictureAndAPathThatIsNoneIsRefused) {
  const TemporaryFolder folder;
  const Picture picture = valve_slices(ramp(), middle_planes(ramp()), {{sphere(4, 500), kMark}}, {});
  EXPECT_EQ(picture.width, 3 * picture.height + 8);
  EXPECT_GT(marked(picture).size(), 100u);
  write_png(folder.path() / "slices.png", picture);
  std::ifstream file(folder.path() / "slices.png", std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  ASSERT_GT(bytes.size(), 100u);
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  const auto number = [&bytes](std::size_t at) {
    int value = 0;
    for (std::size_t k = at; k < at + 4; ++k) value = 256 * value + static_cast<unsigned char>(bytes[k]);
    return value;
  };
  EXPECT_EQ(number(16), picture.width);
  EXPECT_EQ(number(20), picture.height);
  EXPECT_EQ(bytes[25], 2);  // red, green and blue
  EXPECT_THROW(write_png(folder.path() / "none" / "slices.png", picture), InputError);
}

}  // namespace
}  // namespace coapt
