#include "valve/generators/mitral_annulus.hpp"

#include "core/error.hpp"
#include "mesh/curve_match.hpp"
#include "mesh/distance/intersections.hpp"
#include "valve/generators/mitral.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

// Corners on the annulus of the generated valve, anticlockwise.
Points own_annulus(int count) {
  const MitralShape shape = mitral_shape(mitral_dimensions(0, MitralPreset::Benchmark));
  Points points(3, count);
  for (int k = 0; k < count; ++k) points.col(k) = mitral_open_point(shape, double(k) / count, 0);
  return points;
}

// A circle without saddle, with one side moved by `flat`.
Points ring(int count, double radius, double flat = 0) {
  Points points(3, count);
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    points.col(k) << radius * std::cos(angle), radius * (std::sin(angle) + flat * std::cos(2 * angle)), 0;
  }
  return points;
}

double distance_from_polygon(const Vec3& x, const Points& polygon) {
  return mean_distance(Points(x), polygon);
}

Points annulus_of(const Valve& valve) { return valve.leaflets.vertices(Eigen::all, valve.annulus); }

TEST(MeasuredAnnulus, OfTheGeneratorItselfGivesItsOwnValve) {
  const Valve usual = mitral_valve({.triangles = 625, .preset = MitralPreset::Benchmark});
  const Valve valve = mitral_valve({.triangles = 625, .preset = MitralPreset::Benchmark},
                                   {.name = "own", .annulus = own_annulus(4000)});
  const double tolerance = 1e-3;  // [mm]: a polygon of 4000 sides lies 6e-6 inside, its extents likewise
  ASSERT_EQ(valve.leaflets.triangles, usual.leaflets.triangles);
  EXPECT_LT((valve.leaflets.vertices - usual.leaflets.vertices).colwise().norm().maxCoeff(), tolerance);
  EXPECT_LT((valve.annulus_closed - usual.annulus_closed).colwise().norm().maxCoeff(), tolerance);
  EXPECT_LT((valve.chords.papillary - usual.chords.papillary).colwise().norm().maxCoeff(), tolerance);
  EXPECT_LT((valve.chords.papillary_closed - usual.chords.papillary_closed).colwise().norm().maxCoeff(),
            tolerance);
  EXPECT_EQ(valve.annulus, usual.annulus);
  EXPECT_EQ(valve.commissures, usual.commissures);
  ASSERT_EQ(valve.chords.chords.size(), usual.chords.chords.size());
  for (size_t k = 0; k < valve.chords.chords.size(); ++k) {
    EXPECT_EQ(valve.chords.chords[k].to.index, usual.chords.chords[k].to.index);
    EXPECT_NEAR(valve.chords.chords[k].rest_length, usual.chords.chords[k].rest_length, tolerance);
  }
}

TEST(MeasuredAnnulus, IsFollowedByTheVerticesWhereverItLies) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  const Vec3 shift(300, -120, 45);
  const Points placed = (turn * own_annulus(333)).colwise() + shift;
  Points reversed(3, 334);  // the other way round, from elsewhere, and closed by its first point
  for (int k = 0; k < 334; ++k) reversed.col(k) = placed.col((2 * 333 + 100 - k) % 333);
  const Valve usual = mitral_valve({.triangles = 625, .preset = MitralPreset::Benchmark},
                                   {.name = "own", .annulus = own_annulus(333)});
  for (const Points& points : {placed, reversed}) {
    const Valve valve = mitral_valve({.triangles = 625, .preset = MitralPreset::Benchmark},
                                     {.name = "placed", .annulus = points});
    const Points expected = (turn * usual.leaflets.vertices).colwise() + shift;
    EXPECT_LT((valve.leaflets.vertices - expected).colwise().norm().maxCoeff(), 1e-9);
    for (const int v : valve.annulus)
      EXPECT_LT(distance_from_polygon(valve.leaflets.vertices.col(v), points), 1e-9);
  }
}

TEST(MeasuredAnnulus, OfEveryCoarseOrUnevenCurveHasItsVerticesOnIt) {
  Points uneven = own_annulus(60);
  for (int k = 0; k < 60; ++k)
    uneven.col(k) += 0.4 * Vec3(std::sin(5.0 * k), std::sin(9.0 * k), std::cos(7.0 * k));
  for (const Points& points : {own_annulus(8), own_annulus(24), uneven}) {
    const Valve valve = mitral_valve({.triangles = 2500, .preset = MitralPreset::Benchmark},
                                     {.name = "curve", .annulus = points});
    for (const int v : valve.annulus)
      EXPECT_LT(distance_from_polygon(valve.leaflets.vertices.col(v), points), 1e-9);
    EXPECT_TRUE(valve.leaflets.vertices.allFinite());
    EXPECT_TRUE(intersections(valve.leaflets.vertices, valve.leaflets.triangles).empty());
  }
}

TEST(MeasuredAnnulus, ScalesTheValve) {
  const Valve usual = mitral_valve({.triangles = 625, .preset = MitralPreset::Benchmark},
                                   {.name = "own", .annulus = own_annulus(400)});
  const Valve large = mitral_valve({.triangles = 625, .preset = MitralPreset::Benchmark},
                                   {.name = "large", .annulus = 1.25 * own_annulus(400)});
  EXPECT_LT((large.leaflets.vertices - 1.25 * usual.leaflets.vertices).colwise().norm().maxCoeff(), 1e-9);
  EXPECT_EQ(large.thickness, usual.thickness);
  const auto depth = [](const Valve& valve) {
    return annulus_of(valve).row(2).mean() - valve.chords.papillary.row(2).mean();
  };
  EXPECT_NEAR(depth(large) / depth(usual), 1.25, 0.01);
}

TEST(MeasuredAnnulus, HasTheSidesThatAreNamed) {
  const Points own = own_annulus(400);  // whose sides differ in length, so that its plane leans by 5e-6
  const Vec3 anterior(3, 40, 0), posterior(0, -40, 0);
  const auto front = fit_mitral_annulus(own, {.anterior = Vec3(0, 40, 0)}, 15, "own");
  EXPECT_LT((front.axes - Eigen::Matrix3d::Identity()).norm(), 1e-4);
  const auto back = fit_mitral_annulus(own, {.anterior = posterior}, 15, "own");
  EXPECT_LT((back.axes.col(1) + Vec3::UnitY()).norm(), 1e-4);
  EXPECT_LT(back.flatness, 0);
  const auto below = fit_mitral_annulus(own, {.anterior = anterior, .ventricle = Vec3(0, 0, 9)}, 15, "own");
  EXPECT_LT((below.axes.col(2) + Vec3::UnitZ()).norm(), 1e-4);
  EXPECT_NEAR(below.axes.determinant(), 1, 1e-12);
  const auto flat = fit_mitral_annulus(ring(100, 15), {anterior, Vec3(0, 0, -9)}, 15, "ring");
  EXPECT_NEAR(flat.commissural_diameter, 30, 0.1);
  EXPECT_EQ(flat.height, 0);
}

TEST(MeasuredAnnulus, TakesItsPapillaryTips) {
  Points tips(3, 5);
  tips << -16, 15, 17, -14, 16, 3, 2, -1, 0, 4, -24, -25, -23, -24, -22;
  const Points own = own_annulus(400);
  const Valve valve = mitral_valve({.triangles = 625, .preset = MitralPreset::Benchmark},
                                   {.name = "own", .annulus = own, .papillary = tips});
  ASSERT_EQ(valve.chords.papillary.cols(), 5);
  EXPECT_LT((valve.chords.papillary - tips(Eigen::all, std::vector<int>{1, 2, 4, 0, 3})).norm(), 1e-9)
      << "muscle by muscle";
  for (const Chord& chord : valve.chords.chords) {
    if (chord.level != 1) continue;
    const double tip = valve.chords.papillary(0, chord.from.index);
    EXPECT_GT(tip * valve.chords.junctions(0, chord.to.index), 0) << "a muscle holds its own side";
  }
  const auto refusal = [&](const Points& points) {
    try {
      mitral_valve(
          {.triangles = 625},
          {.name = "tips", .annulus = own, .sides = {.ventricle = Vec3(0, 0, -30)}, .papillary = points});
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_NE(refusal(tips.middleCols(1, 2)).find("one side of the valve"), std::string::npos);
  tips(2, 3) = 8;
  EXPECT_NE(refusal(tips).find("papillary tip 4"), std::string::npos) << refusal(tips);
}

std::string refusal(const Points& points, const AnnulusSides& sides = {}) {
  try {
    mitral_valve({.triangles = 300, .preset = MitralPreset::Benchmark},
                 {.name = "ring.csv", .annulus = points, .sides = sides});
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(MeasuredAnnulus, IsRefusedWithItsReason) {
  const auto expect = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
    EXPECT_NE(text.find("ring.csv: "), std::string::npos) << text;
  };
  expect(refusal(own_annulus(7)), "has 7 different points; an annulus takes at least 8");
  expect(refusal(Points::Ones(3, 20)), "has 0 different points");
  expect(refusal(0.1 * own_annulus(100)), "are its positions in mm?");
  expect(refusal(1000 * own_annulus(100)), "are its positions in mm?");
  Points crossed = own_annulus(40);
  crossed.col(10).swap(crossed.col(14));
  expect(refusal(crossed), "crosses itself in its plane: its sides behind points");
  Points line(3, 12);
  for (int k = 0; k < 12; ++k) line.col(k) << 3 * (k < 6 ? k : 11.5 - k), 0, 0;
  expect(refusal(line), "encloses no area");
  expect(refusal(ring(100, 15)), "too round to tell its anterior side");
  expect(refusal(ring(100, 15), {.anterior = Vec3(0, 20, 0)}), "too flat to tell the side of the ventricle");
  expect(refusal(ring(100, 15), {.anterior = Vec3(0, 0, 20)}), "lies on the axis of the annulus");
  expect(refusal(ring(100, 15), {.anterior = Vec3(0, 20, 0), .ventricle = Vec3(1, 1, 0)}),
         "lies in the plane");
  Points even = ring(100, 15);
  even.row(0) *= 1.3;
  expect(refusal(even), "no side is flatter than the other");
  // Both at once.
  const std::string both = refusal(even);
  EXPECT_NE(both.find("--ventricle"), std::string::npos) << both;
}

}  // namespace
}  // namespace coapt
