#include "image/edge/edge_network.hpp"

#include "core/error.hpp"
#include "image/segment/segment_leaflets.hpp"
#include "image/support/speckle_phantom.hpp"
#include "image/support/valve_image.hpp"
#include "valve/generators/leaflet_chords.hpp"
#include "valve/generators/mitral.hpp"
#include "valve/generators/rough_valve.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr int kChannels = 24, kColumns = 20, kPlaces = 16;

// Smooth numbers without meaning; the last channel says that there is a layer.
Eigen::MatrixXf made_up_channels() {
  Eigen::MatrixXf channels(kChannels, kPlaces * kColumns);
  for (int place = 0; place < kPlaces; ++place)
    for (int column = 0; column < kColumns; ++column)
      for (int k = 0; k < kChannels; ++k)
        channels(k, place * kColumns + column) =
            0.5F + 0.5F * std::sin(0.7F * k + 0.3F * place +
                                   2 * std::numbers::pi_v<float> * static_cast<float>(column) / kColumns);
  channels.row(kChannels - 1).setOnes();
  return channels;
}

TEST(EdgeNetwork, TurnsWithTheRing) {
  const Eigen::MatrixXf channels = made_up_channels();
  Eigen::MatrixXf turned = channels;
  for (int place = 0; place < kPlaces; ++place)
    for (int column = 0; column < kColumns; ++column)
      turned.col(place * kColumns + (column + 3) % kColumns) = channels.col(place * kColumns + column);
  const Eigen::MatrixXd logits = leaflet_logits(channels, kColumns);
  const Eigen::MatrixXd of_turned = leaflet_logits(turned, kColumns);
  for (int column = 0; column < kColumns; ++column)
    EXPECT_LT((of_turned.col((column + 3) % kColumns) - logits.col(column)).cwiseAbs().maxCoeff(), 1e-5);
}

TEST(EdgeNetwork, TakesNothingBeyondTheEndOfAColumnForLeaflet) {
  Eigen::MatrixXf channels = made_up_channels();
  channels.rightCols(2 * kColumns).setZero();
  const Eigen::MatrixXd logits = leaflet_logits(channels, kColumns);
  EXPECT_EQ(logits.rows(), kPlaces);
  EXPECT_EQ(logits.bottomRows(2).maxCoeff(), -4);
  EXPECT_LE(logits.cwiseAbs().maxCoeff(), 4);
}

Valve valve_with_rough_chords(unsigned seed) {
  Valve valve = mitral_valve(MitralOptions{.triangles = 2500, .seed = seed});
  LeafletChordOptions chords;
  chords.zones = {chord_zone("free_edge"), chord_zone("rough")};
  valve.chords = leaflet_chords(valve, chords);
  return valve;
}

Points ring_points(const Valve& valve, const std::vector<int>& loop) {
  return valve.leaflets.vertices(Eigen::all, loop);
}

// Mean distance of the found edge's vertices from those of the true one [mm].
double edge_error(const Valve& valve, const Volume& image, EdgeRule rule) {
  SegmentOptions options;
  options.annulus = ring_points(valve, valve.annulus);
  options.dynamic_range = 50;
  options.edge = rule;
  const Segmentation found = segment_leaflets(image, options);
  const Points from = ring_points(found.valve, found.valve.free_edge);
  const Points to = ring_points(valve, valve.free_edge);
  double sum = 0;
  for (Eigen::Index k = 0; k < from.cols(); ++k)
    sum += (to.colwise() - from.col(k)).colwise().norm().minCoeff();
  return sum / static_cast<double>(from.cols());
}

// Seeds that were not learnt from. Of one kind of shape alone a network may know the lengths by heart.
TEST(EdgeNetwork, FindsTheEdgeAmongChordsOfTheRoughZone) {
  const Valve valve = valve_with_rough_chords(1);
  const Volume image = testing::image_with_chords(valve, testing::clear_phantom(1));
  const double learnt = edge_error(valve, image, EdgeRule::Learnt);
  EXPECT_LT(learnt, 1.3);
  EXPECT_LT(learnt, 0.7 * edge_error(valve, image, EdgeRule::Contrast));
}

TEST(EdgeNetwork, FindsTheEdgeOfARoughValve) {
  const Valve valve = rough_valve({.kind = RoughKind::Mitral, .seed = 2, .triangles = 900});
  const Volume image = testing::image_with_chords(valve, testing::clear_phantom(1));
  EXPECT_LT(edge_error(valve, image, EdgeRule::Learnt), edge_error(valve, image, EdgeRule::Contrast));
}

TEST(EdgeNetwork, IsRefusedWhereValuesAreNoUltrasound) {
  const Valve valve = valve_with_rough_chords(1);
  SegmentOptions options;
  options.annulus = ring_points(valve, valve.annulus);
  options.edge = EdgeRule::Learnt;
  const Volume image = testing::plain_volume(valve.leaflets, {.voxel = 1.5});
  EXPECT_THROW(segment_leaflets(image, options), InputError);
  options.edge = EdgeRule::Contrast;
  EXPECT_NO_THROW(segment_leaflets(image, options));
}

}  // namespace
}  // namespace coapt
