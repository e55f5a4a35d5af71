#include "core/error.hpp"
#include "image/phantom_valves.hpp"
#include "image/write_phantom.hpp"
#include "support/temporary_folder.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace coapt {
namespace {

// Where the labels are looked at alone: a coarse spread takes little time, and planes of voxels that lie
// oblique to those of the valve do not all count alike.
PhantomOptions label_options() {
  PhantomOptions options;
  options.voxel = 0.8;
  options.axial = 2;
  options.lateral = 3;
  options.probe = Vec3(20, 13, 57);
  options.dropout = 0;
  options.shadows = 0;
  return options;
}

PhantomOptions plain_options() {
  PhantomOptions options;
  options.dropout = 0;
  options.shadows = 0;
  return options;
}

struct MadePhantom {
  PhantomPattern pattern;
  Phantom phantom;
};

MadePhantom made(const PhantomValve& valve, const PhantomOptions& options) {
  const Volume grid = phantom_grid({valve}, options);
  const PhantomPattern pattern = phantom_pattern(valve.surface, options);
  return {pattern, make_phantom(valve, pattern, grid, options)};
}

// Mean square of the envelope at these places [mm].
double power(const Phantom& phantom, const std::vector<Vec3>& places) {
  double sum = 0;
  for (const Vec3& place : places) sum += std::pow(sample(phantom.envelope, place, kNaN), 2);
  return sum / static_cast<double>(places.size());
}

// Where along the normal the mean power of these triangles' echoes has its middle [mm]; 0 is on the surface.
double ridge_offset(const PhantomValve& valve, const Phantom& phantom,
                    const std::function<bool(const Vec3&)>& counts) {
  double sum = 0, moment = 0;
  for (double offset = -3; offset < 3.05; offset += 0.1) {
    std::vector<Vec3> places;
    for (const auto& t : valve.surface.triangles.colwise()) {
      const Points& x = valve.surface.vertices;
      const Vec3 centroid = (x.col(t[0]) + x.col(t[1]) + x.col(t[2])) / 3;
      if (counts(centroid)) places.push_back(centroid + offset * area_vector(x, t).normalized());
    }
    const double above = power(phantom, places);
    sum += above;
    moment += offset * above;
  }
  return moment / sum;
}

long count_label(const Phantom& phantom, int label) {
  return std::count(phantom.labels.values.begin(), phantom.labels.values.end(), static_cast<float>(label));
}

int label_at(const Phantom& phantom, const Vec3& place) {
  const Vec3 at = voxels_of(phantom.labels, place).array().round();
  return static_cast<int>(phantom.labels.values[phantom.labels.voxel(int(at.x()), int(at.y()), int(at.z()))]);
}

TEST(Phantom, SameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  const TemporaryFolder folder;
  PhantomOptions options;
  options.voxel = 1;
  const PhantomValve valve = funnel_valve();
  for (const char* name : {"a", "b", "c"}) {
    options.seed = name == std::string("c") ? 2 : 1;
    const MadePhantom one = made(valve, options);
    std::filesystem::create_directory(folder.path() / name);
    write_phantom(folder.path() / name, valve, one.pattern, one.phantom, options);
  }
  for (const std::string& file : phantom_files()) {
    EXPECT_FALSE(text_of(folder.path() / "a" / file).empty()) << file;
    EXPECT_EQ(text_of(folder.path() / "a" / file), text_of(folder.path() / "b" / file)) << file;
  }
  for (const char* file : {"image.nrrd", "surface.vtp"})
    EXPECT_NE(text_of(folder.path() / "a" / file), text_of(folder.path() / "c" / file)) << file;
}

TEST(Phantom, StatesOfOneSeriesHaveSpeckleOfTheirOwn) {
  PhantomOptions options = plain_options();
  options.voxel = 1;
  const PhantomValve valve = flat_valve();
  const Volume grid = phantom_grid({valve}, options);
  const PhantomPattern pattern = phantom_pattern(valve.surface, options);
  const Phantom one = make_phantom(valve, pattern, grid, options, 0),
                other = make_phantom(valve, pattern, grid, options, 1);
  EXPECT_NE(one.envelope.values, other.envelope.values);
  EXPECT_EQ(one.labels.values, other.labels.values);
}

TEST(Phantom, SpeckleOfAHomogeneousRegionIsRayleighDistributedAtEveryDepth) {
  PhantomOptions options = plain_options();
  options.voxel = 1;
  options.margin = 25;
  options.sector = 120;
  const Phantom phantom = made(flat_valve(), options).phantom;
  std::array<double, 2> powers{};
  for (const double side : {1.0, -1.0}) {  // nearer to the probe, and farther
    double count = 0, sum = 0, squares = 0;
    for (std::size_t k = 0; k < phantom.envelope.values.size(); ++k) {
      const auto nx = static_cast<std::size_t>(phantom.labels.size[0]),
                 ny = static_cast<std::size_t>(phantom.labels.size[1]);
      const Vec3 at =
          position_of(phantom.labels, Vec3(double(k % nx), double(k / nx % ny), double(k / nx / ny)));
      if (std::hypot(at.x(), at.y()) < 26 || side * at.z() < 5) continue;  // beyond the walls
      const double value = phantom.envelope.values[k];
      ++count;
      sum += value;
      squares += value * value;
    }
    const double mean = sum / count, deviation = std::sqrt(squares / count - mean * mean);
    EXPECT_NEAR(mean / deviation, std::sqrt(std::numbers::pi / (4 - std::numbers::pi)), 0.05);
    powers[side > 0 ? 0 : 1] = squares / count;
  }
  EXPECT_NEAR(powers[0] / powers[1], 1, 0.08);
}

TEST(Phantom, BrightRidgeLiesOnTheSurfaceAllAround) {
  const PhantomValve valve = funnel_valve();
  PhantomOptions options = plain_options();
  const Phantom phantom = made(valve, options).phantom;
  for (int sector = 0; sector < 8; ++sector) {
    const auto counts = [&](const Vec3& at) {
      const double turns = std::atan2(at.y(), at.x()) / (2 * std::numbers::pi) + 1;
      return at.z() < -4 && at.z() > -11 && static_cast<int>(turns * 8) % 8 == sector;
    };
    EXPECT_LT(std::abs(ridge_offset(valve, phantom, counts)), options.voxel / 2) << sector;
  }
}

TEST(Phantom, AnObliqueProbeTurnsTheGridAndTheValveStaysWhereItIs) {
  const PhantomValve valve = funnel_valve();
  PhantomOptions options = plain_options();
  options.probe = Vec3(40, 25, 50);
  const Phantom phantom = made(valve, options).phantom;
  EXPECT_LT((phantom.image.direction.col(2) - Vec3(-40, -25, -50).normalized()).norm(), 1e-9);
  EXPECT_NEAR(phantom.image.direction.determinant(), 1, 1e-12);
  const auto counts = [](const Vec3& at) { return at.z() < -4 && at.z() > -11; };
  EXPECT_LT(std::abs(ridge_offset(valve, phantom, counts)), options.voxel / 2);
  for (int v = 64 * 3; v < 64 * 8; v += 7)
    EXPECT_EQ(label_at(phantom, valve.surface.vertices.col(v)), kLabelLeaflet);
  EXPECT_EQ(label_at(phantom, Vec3(0, 0, -5)), kLabelAtrium);
  EXPECT_EQ(label_at(phantom, Vec3(0, 0, -17)), kLabelVentricle);
}

TEST(Phantom, LabelsOfAFlatValveHaveTheVolumesOfItsChambers) {
  PhantomOptions options = label_options();
  options.thickness = 2;
  options.margin = 27;
  const Phantom phantom = made(flat_valve(), options).phantom;
  const double voxel = std::pow(options.voxel, 3), pi = std::numbers::pi, disc = pi * 15 * 15;
  const double chamber = 2.0 / 3 * disc * 20 - disc * 1, rim = 2 * pi * 15 * pi / 2;
  EXPECT_NEAR(voxel * double(count_label(phantom, kLabelAtrium)) / chamber, 1, 0.02);
  EXPECT_NEAR(voxel * double(count_label(phantom, kLabelVentricle)) / chamber, 1, 0.02);
  EXPECT_NEAR(voxel * double(count_label(phantom, kLabelLeaflet)) / (disc * 2 + rim), 1, 0.02);
  const double walls = 4.0 / 3 * pi * (21 * 21 * 26 - 15 * 15 * 20) - rim;
  EXPECT_NEAR(voxel * double(count_label(phantom, kLabelWall)) / walls, 1, 0.02);
}

TEST(Phantom, AnOpenValvePartsTheChambersAtItsFreeEdge) {
  PhantomOptions options = label_options();
  options.thickness = 0.6;
  options.margin = 25;
  const Phantom phantom = made(funnel_valve(), options).phantom;
  EXPECT_EQ(label_at(phantom, Vec3(0, 0, -10)), kLabelAtrium);
  EXPECT_EQ(label_at(phantom, Vec3(12, 0, -10)), kLabelVentricle);
  EXPECT_EQ(label_at(phantom, Vec3(0, 0, -16)), kLabelVentricle);
  const double pi = std::numbers::pi, funnel = pi * 14 / 3 * (15 * 15 + 15 * 8 + 8 * 8),
               skin = pi * (15 + 8) * std::hypot(7, 14) * 0.3;
  EXPECT_NEAR(std::pow(options.voxel, 3) * double(count_label(phantom, kLabelAtrium)) /
                  (2.0 / 3 * pi * 15 * 15 * 20 + funnel - skin),
              1, 0.02);
}

TEST(Phantom, DropoutTakesItsShareOfTheAreaAndItsEcho) {
  PhantomOptions options = plain_options();
  options.dropout = 0.2;
  options.shadows = 3;
  const PhantomValve valve = funnel_valve();
  const auto [pattern, phantom] = made(valve, options);
  const Points& x = valve.surface.vertices;
  EXPECT_EQ(pattern.spots.size(), 3u);
  double faint_area = 0;
  std::vector<Vec3> faint, bright;
  for (int t = 0; t < valve.surface.triangle_count(); ++t) {
    const Eigen::Vector3i corners = valve.surface.triangles.col(t);
    const bool is_faint = pattern.dropouts[static_cast<std::size_t>(t)] != 0;
    if (is_faint) faint_area += area_vector(x, corners).norm();
    (is_faint ? faint : bright).push_back((x.col(corners[0]) + x.col(corners[1]) + x.col(corners[2])) / 3);
  }
  EXPECT_NEAR(faint_area / surface_area(x, valve.surface.triangles), 0.2, 0.002);
  EXPECT_LT(power(phantom, faint), 0.35 * power(phantom, bright));  // the spread fills them from their rims
}

TEST(Phantom, AShadowDarkensWhatLiesBehindItsSpotAndNothingElse) {
  const PhantomValve valve = flat_valve();
  PhantomOptions options = plain_options();
  const Phantom without = made(valve, options).phantom;
  PhantomPattern pattern = phantom_pattern(valve.surface, options);
  ASSERT_TRUE(pattern.spots.empty());
  pattern.spots.push_back({2 * 64 * 4, Vec3::Constant(1.0 / 3), 2.5});
  const Phantom with = make_phantom(valve, pattern, phantom_grid({valve}, options), options);
  const Eigen::Vector3i corners = valve.surface.triangles.col(pattern.spots[0].triangle);
  const Points& x = valve.surface.vertices;
  const Vec3 spot = (x.col(corners[0]) + x.col(corners[1]) + x.col(corners[2])) / 3;
  const Vec3 beam = (spot - Vec3(0, 0, 60)).normalized();
  std::vector<Vec3> behind;
  for (double way = 3; way < 5.5; way += 0.25) behind.push_back(spot + way * beam);
  EXPECT_LT(power(with, behind), 0.2 * power(without, behind));
  const auto is_aside = [&](const Vec3& at) { return (at - spot - (at - spot).dot(beam) * beam).norm() > 8; };
  for (int k = 0; k < with.envelope.size[2]; ++k) {
    if (!is_aside(position_of(with.envelope, Vec3(2, 2, k)))) continue;
    const std::size_t voxel = with.envelope.voxel(2, 2, k);
    EXPECT_EQ(with.envelope.values[voxel], without.envelope.values[voxel]);
  }
}

TEST(Phantom, ChordsAreThinBrightLines) {
  PhantomValve valve = funnel_valve();
  valve.line_ends.resize(3, 2);
  valve.line_ends << 8, 12, 0, 3, -14, -26;
  valve.line_radii = {0.5};
  const Phantom phantom = made(valve, plain_options()).phantom;
  std::vector<Vec3> on, beside;
  for (double share = 0.3; share < 0.9; share += 0.02) {
    on.push_back((1 - share) * valve.line_ends.col(0) + share * valve.line_ends.col(1));
    beside.push_back(on.back() + Vec3(0, -5, 0));
  }
  EXPECT_GT(power(phantom, on), 10 * power(phantom, beside));
  for (const Vec3& place : on) EXPECT_EQ(label_at(phantom, place), kLabelChord);
}

TEST(Phantom, BehindALeafletOnTheWallThereIsNoBlood) {
  PhantomValve valve = funnel_valve();
  EXPECT_EQ(label_at(made(valve, label_options()).phantom, Vec3(-10.8, 0, -12)), kLabelVentricle);
  for (int t = 0; t < valve.surface.triangle_count(); ++t)
    if (valve.surface.vertices(0, valve.surface.triangles(0, t)) < 0) valve.on_wall.push_back(t);
  const Phantom phantom = made(valve, label_options()).phantom;
  EXPECT_EQ(label_at(phantom, Vec3(-10.8, 0, -12)), kLabelWall);
  EXPECT_EQ(label_at(phantom, Vec3(10.8, 0, -12)), kLabelVentricle);
  EXPECT_EQ(label_at(phantom, Vec3(-5, 0, -8)), kLabelAtrium);
}

TEST(Phantom, BeyondTheSectorTheImageIsBlack) {
  PhantomOptions options = plain_options();
  options.sector = 20;
  const Phantom phantom = made(flat_valve(), options).phantom;
  for (const Vec3& place : {Vec3(13, 0, 0), Vec3(0, -13, 3)})
    EXPECT_EQ(sample(phantom.image, place, kNaN), 0);
  EXPECT_GT(sample(phantom.image, Vec3(5, 5, 0), kNaN), 50);
}

TEST(Phantom, FreeRimsAreClosedOnesAndThoseBetweenTwoPlacesOfTheAnnulus) {
  const PhantomValve valve = funnel_valve();
  const std::vector<FreeRim> rims = free_rims(valve.surface, valve.annulus);
  ASSERT_EQ(rims.size(), 1u);
  EXPECT_TRUE(rims[0].is_closed);
  EXPECT_EQ(rims[0].vertices.size(), 64u);
  std::vector<int> half(valve.annulus.begin(), valve.annulus.begin() + 33);
  const std::vector<FreeRim> others = free_rims(valve.surface, half);
  ASSERT_EQ(others.size(), 2u);
  EXPECT_FALSE(others[0].is_closed);
  EXPECT_EQ(others[0].vertices.size(), 33u);
}

TEST(Phantom, OptionsWithoutMeaningAreRefused) {
  const PhantomValve valve = flat_valve();
  PhantomOptions options;
  options.voxel = 0;
  EXPECT_THROW(phantom_grid({valve}, options), InputError);
  options.voxel = 1e-3;
  EXPECT_THROW(phantom_grid({valve}, options), InputError);
  options = {};
  options.dropout = 1;
  EXPECT_THROW(phantom_grid({valve}, options), InputError);
  options = {};
  options.probe = Vec3(0, 0, 3);
  EXPECT_THROW(phantom_grid({valve}, options), InputError);
  options = {};
  options.lateral = 1e-4;
  const Volume grid = phantom_grid({valve}, options);
  EXPECT_THROW(make_phantom(valve, phantom_pattern(valve.surface, options), grid, options), InputError);
}

}  // namespace
}  // namespace coapt
