#include "valve/generators/chain.hpp"

#include "core/error.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

Vec3 position(const ChordNetwork& network, const ChordEnd& end) {
  return end.kind == ChordEnd::Kind::Papillary ? network.papillary.col(end.index)
                                               : network.junctions.col(end.index);
}

TEST(Chain, RunsFromAnchorToAnchorWithLinksNearTheirRestLength) {
  const Vec3 from(0, 0, 0), to(0.8, 0.6, 0);
  const ChordNetwork network = chain(from, to, 20, 1.2, 1e-6);
  ASSERT_EQ(network.chords.size(), 20u);
  ASSERT_EQ(network.junctions.cols(), 19);
  Vec3 at = from;
  for (const Chord& link : network.chords) {
    EXPECT_EQ(position(network, link.from), at);
    at = position(network, link.to);
    EXPECT_DOUBLE_EQ(link.rest_length, 0.06);
    EXPECT_NEAR((at - position(network, link.from)).norm(), 0.06, 0.06 * 0.01);
  }
  EXPECT_EQ(at, to);
  EXPECT_LT(network.junctions(2, 9), -0.25);  // it hangs: the catenary's sag is 0.292
}

TEST(Chain, StartsStraightWhenItIsNoLongerThanTheSpan) {
  const ChordNetwork network = chain(Vec3(0, 0, 0), Vec3(2, 0, 1), 4, 1.5, 1);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR((network.junctions.col(i) - (i + 1) / 4.0 * Vec3(2, 0, 1)).norm(), 0, 1e-12);
}

TEST(Chain, RefusesWithEveryDefectNamed) {
  try {
    chain(Vec3::Zero(), Vec3::Zero(), 1, -1, 0);
    FAIL() << "an impossible chain was made";
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 4u);
  }
}

}  // namespace
}  // namespace coapt
