// The potential of an image: the spline against polynomials, and the term suite.
#include "image/template/image_sheet.hpp"

#include "energy/element_term.hpp"
#include "image/template/spline_field.hpp"
#include "support/sheets.hpp"
#include "support/term_suite.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace coapt {
namespace {

// A grid that stands askew, with values from a function of the place in voxels.
template <typename Function>
Volume volume_of(const Function& value) {
  Volume volume;
  volume.size = {12, 10, 11};
  volume.origin = Vec3(-2, 1, 3);
  volume.spacing = Vec3(0.5, 0.7, 0.6);
  volume.direction = Eigen::AngleAxisd(0.6, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  for (int k = 0; k < volume.size[2]; ++k)
    for (int j = 0; j < volume.size[1]; ++j)
      for (int i = 0; i < volume.size[0]; ++i)
        volume.values.push_back(static_cast<float>(value(Vec3(i, j, k))));
  return volume;
}

// In voxels; whole numbers, which are exact in single precision.
double cubic(const Vec3& v) { return v[0] * v[0] * v[0] - 2 * v[0] * v[1] + v[2] * v[2] + 3 * v[1] - 5; }

// Coefficients of B-splines give x^3 + x for x^3 and z^2 + 1/3 for z^2, and all else as it is (Marsden 1970).
TEST(SplineField, IsThatOfAPolynomialWithTwoDerivatives) {
  const Volume volume = volume_of(cubic);
  const SplineField field(volume);
  const Vec3 v(5.3, 4.1, 6.7);
  Vec3 g;
  Eigen::Matrix3d h;
  const double value = field.at(position_of(volume, v), &g, &h);
  EXPECT_NEAR(value, cubic(v) + v[0] + 1.0 / 3, 1e-10);
  const Eigen::Matrix3d to_space = volume.direction * volume.spacing.cwiseInverse().asDiagonal();
  const Vec3 slope(3 * v[0] * v[0] - 2 * v[1] + 1, -2 * v[0] + 3, 2 * v[2]);
  Eigen::Matrix3d bend;
  bend << 6 * v[0], -2, 0, -2, 0, 0, 0, 0, 2;
  EXPECT_LT((g - to_space * slope).norm(), 1e-10);
  EXPECT_LT((h - to_space * bend * to_space.transpose()).norm(), 1e-9);
  EXPECT_EQ(field.at(position_of(volume, v)), value);
}

TEST(SplineField, GoesOnSmoothlyBeyondTheVolume) {
  const Volume volume = volume_of(cubic);
  const SplineField field(volume);
  for (const Vec3& v : {Vec3(-0.2, 4, 5), Vec3(11.3, 9.2, 10.6), Vec3(-1, 4.5, 5), Vec3(5, 9, 11)}) {
    const double step = 1e-5;
    Vec3 g;
    Eigen::Matrix3d h;
    field.at(position_of(volume, v), &g, &h);
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 along = step * Vec3::Unit(axis), x = position_of(volume, v);
      Vec3 after, before;
      const double there = field.at(x + along, &after), back = field.at(x - along, &before);
      EXPECT_NEAR((there - back) / (2 * step), g[axis], 1e-5 * std::max(1.0, g.norm()));
      EXPECT_LT(((after - before) / (2 * step) - h.col(axis)).norm(), 1e-4 * std::max(1.0, h.norm()));
    }
  }
  Vec3 g;
  EXPECT_NEAR(field.at(position_of(volume, Vec3(-50, 4, 5))), field.at(position_of(volume, Vec3(-7, 4, 5))),
              1e-12);
  EXPECT_TRUE(std::isfinite(field.at(Vec3(1e9, -1e9, 1e9), &g)) && g.isZero());
}

TEST(SplineField, NeverOvershoots) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> coin(0, 1);
  const Volume volume = volume_of([&](const Vec3&) { return coin(random); });
  const SplineField field(volume);
  std::uniform_real_distribution<double> place(-1, 12);
  for (int k = 0; k < 2000; ++k) {
    const double value = field.at(position_of(volume, Vec3(place(random), place(random), place(random))));
    EXPECT_GE(value, -1e-12);
    EXPECT_LE(value, 1 + 1e-12);
  }
}

// A bumpy field as seen from a frame; kept for as long as the test runs.
const SplineField& field_in(const Frame& frame) {
  static std::vector<std::unique_ptr<SplineField>> fields;
  Volume volume =
      volume_of([](const Vec3& v) { return std::sin(v[0]) + std::cos(0.8 * v[1]) * std::sin(0.7 * v[2]); });
  volume.origin = frame.point(volume.origin);
  volume.direction = frame.rotation * volume.direction;
  volume.spacing *= frame.length;
  fields.push_back(std::make_unique<SplineField>(std::move(volume)));
  return *fields.back();
}

TermCase sheet_case(const std::string& label, double share) {
  const Volume volume = volume_of(cubic);
  Points X(3, 4);
  X << 4, 7, 4.5, 7.2, 4, 3.8, 6.5, 6.9, 5, 5.2, 4.8, 5.9;
  for (int k = 0; k < 4; ++k) X.col(k) = position_of(volume, X.col(k));
  Triangles triangles(3, 2);
  triangles << 0, 1, 1, 3, 2, 2;
  TermCase c;
  c.label = label;
  c.rest = X;
  c.state = X;
  c.state(0, 1) += 0.1;
  c.state(2, 2) -= 0.15;
  c.reach = 0.05;  // within which no place of the rule crosses to other splines: third derivatives jump there
  c.is_zero_at_rest = false;
  c.ignores_rigid_motion = false;
  c.make = [X, triangles, share](const Frame& frame) {
    const Triangles seen = frame.triangles(triangles);
    const SplineField& field = field_in(frame);
    std::vector<ImageSheet::Rest> rest;
    for (int t = 0; t < seen.cols(); ++t)
      rest.push_back({&field, 0.6, area_vector(X, triangles.col(t)).norm() * frame.length * frame.length,
                      share, frame.force / frame.length});
    return std::make_unique<ElementTerm<ImageSheet>>(
        "image", std::vector<int>(seen.data(), seen.data() + seen.size()), rest);
  };
  return c;
}

TEST(ImageSheet, PassesTheTermSuite) {
  EXPECT_EQ(examine_term(sheet_case("current area", 1)), "");
  EXPECT_EQ(examine_term(sheet_case("area at rest", 0)), "");
  EXPECT_EQ(examine_term(sheet_case("between", 0.4)), "");
}

// In a potential that is the same everywhere the energy is area times potential, and its force a film's.
TEST(ImageSheet, IsAFilmWhereThePotentialIsTheSame) {
  const SplineField field(volume_of([](const Vec3&) { return -2; }));
  Eigen::Vector<double, 9> x, g, film;
  x << 0, 0, 0, 1, 0.2, 0, 0.1, 1.1, 0.3;
  Eigen::Matrix<double, 9, 9> h, film_h;
  const double energy = ImageSheet::evaluate({&field, 0.5, 0, 1}, x, &g, &h);
  EXPECT_NEAR(energy, SurfaceTension::evaluate({-1.5}, x, &film, &film_h), 1e-12);
  EXPECT_LT((g - film).norm(), 1e-12);
  EXPECT_LT((h - film_h).norm(), 1e-12);
  EXPECT_NEAR(ImageSheet::evaluate({&field, 0.5, 2, 0}, x, &g, &h), -3, 1e-12);
  EXPECT_LT(g.norm() + h.norm(), 1e-10);
}

}  // namespace
}  // namespace coapt
