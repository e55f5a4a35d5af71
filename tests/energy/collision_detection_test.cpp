#include "energy/contact/collision_detection.hpp"

#include "collision_queries.hpp"
#include "support/exact_ccd.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

using exact_ccd::Answer;
using exact_ccd::MovingPair;

double step_of(const Query& query, double kept) {
  return query.first == 1 ? point_triangle_step(query.x, query.d, 1, kept)
                          : edge_edge_step(query.x, query.d, 1, kept);
}

struct Count {
  int queries = 0, limited = 0, stopped = 0, missed = 0, too_near = 0, undecided = 0, false_alarms = 0;
};

void judge(const Query& query, Count& count) {
  const double kept = 0.1;
  const double step = step_of(query, kept);
  const MovingPair pair(query.x, query.d, query.first);
  const double distance = pair.distance();
  ++count.queries;
  count.limited += step < 1;
  count.stopped += step == 0 && distance > 0;
  ASSERT_GE(step, 0);
  ASSERT_LE(step, 1);
  count.missed += step >= query.collides_at && step > 0;
  if (step > 0) {  // a thousandth is left to the judge, which has to find separating planes
    const Answer answer = pair.stays_apart(step, 0.999 * kept * distance);
    count.too_near += answer == Answer::Near;
    count.undecided += answer == Answer::Undecided;
    const MovingPair moved(query.x + step * query.d, Corners4::Zero(), query.first);
    count.too_near += !(moved.distance() >= 0.999 * kept * distance);
  }
  if (step < 1 && distance > 0)
    count.false_alarms += pair.stays_apart(1, 2 * kept * distance) == Answer::Apart;
}

TEST(CollisionDetection, MissesNoneOfAHundredThousandCollisionsJudgedExactly) {  // VERIFICATION S15
  const int queries = is_sanitized() ? 200 : 6000;
  Count all;
  std::printf("%-18s %8s %8s %8s %8s %8s %9s %12s\n", "", "queries", "limited", "at 0", "missed", "too near",
              "undecided", "false alarms");
  for (const int first : {1, 2})
    for (const Family& family : query_families()) {
      Draw draw(17);
      Count count;
      for (int k = 0; k < queries; ++k) judge(elsewhere(draw, family.make(draw, first)), count);
      std::printf("%-18s %8d %8d %8d %8d %8d %9d %12d\n", family.name.c_str(), count.queries, count.limited,
                  count.stopped, count.missed, count.too_near, count.undecided, count.false_alarms);
      EXPECT_EQ(count.missed, 0) << family.name;
      EXPECT_EQ(count.too_near, 0) << family.name;
      EXPECT_EQ(count.undecided, 0) << family.name;
    }
}

}  // namespace
}  // namespace coapt
