#include "mesh/distance/collision_detection.hpp"

#include "collision_queries.hpp"
#include "support/exact_ccd.hpp"
#include "support/sanitized.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>

namespace coapt {
namespace {

using exact_ccd::Answer;
using exact_ccd::MovingPair;

double step_of(const Query& query, double kept) {
  return query.first == 1 ? point_triangle_step(query.x, query.d, 1, kept)
                          : edge_edge_step(query.x, query.d, 1, kept);
}

constexpr double kKept = 0.1;

struct Count {
  int limited = 0, stopped = 0, missed = 0, too_near = 0, undecided = 0, false_alarms = 0;
};

void checker(const Query& query, double step, Count& count) {
  ASSERT_GE(step, 0);
  ASSERT_LE(step, 1);
  const MovingPair pair(query.x, query.d, query.first);
  const double distance = pair.distance(),
               promised = 0.999 * kKept * distance;  // the rest for the judge's planes
  count.limited += step < 1;
  count.stopped += step == 0 && distance > 0;
  count.missed += step >= query.collides_at && step > 0;
  if (step > 0) {
    const Answer answer = pair.stays_apart(step, promised);
    const MovingPair moved(query.x + step * query.d, PairCorners::Zero(), query.first);
    count.too_near += answer == Answer::Near || moved.distance() < promised;
    count.undecided += answer == Answer::Undecided;
  }
  if (step < 1 && distance > 0)
    count.false_alarms += pair.stays_apart(1, 2 * kKept * distance) == Answer::Apart;
}

// As many queries of each family and kind; prints what became of them, and the time of one.
void judge_all_families(int queries) {
  std::printf("%-21s %8s %8s %6s %7s %9s %10s %13s %6s\n", "", "queries", "limited", "at 0", "missed",
              "too near", "undecided", "false alarms", "ns");
  for (const int first : {1, 2})
    for (const Family& family : query_families()) {
      Draw draw(17);
      std::vector<Query> all;
      for (int k = 0; k < queries; ++k) all.push_back(elsewhere(draw, family.make(draw, first)));
      std::vector<double> steps;
      const std::clock_t start = std::clock();
      for (const Query& query : all) steps.push_back(step_of(query, kKept));
      const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      Count count;
      for (int k = 0; k < queries; ++k) checker(all[k], steps[k], count);
      const std::string name = (first == 1 ? "PT " : "EE ") + family.name;
      std::printf("%-21s %8d %8d %6d %7d %9d %10d %13d %6.0f\n", name.c_str(), queries, count.limited,
                  count.stopped, count.missed, count.too_near, count.undecided, count.false_alarms,
                  seconds / queries * 1e9);
      EXPECT_EQ(count.missed, 0) << name;
      EXPECT_EQ(count.too_near, 0) << name;
      EXPECT_EQ(count.undecided, 0) << name;
      EXPECT_LE(count.false_alarms, queries / 50) << name;
    }
}

TEST(CollisionDetection, KeepsItsPromiseJudgedExactly) {  // VERIFICATION S15
  judge_all_families(is_sanitized() ? 50 : 600);
}

TEST(Nightly, CollisionDetectionKeepsItsPromiseInAHundredThousandMovesJudgedExactly) {  // VERIFICATION S15
  judge_all_families(is_sanitized() ? 200 : 6000);
}

TEST(CollisionDetection, HasAJudgeThatSeesEveryCollision) {
  Draw draw(3);
  for (const int first : {1, 2})
    for (const Where where : {Where::Inside, Where::Edge, Where::Corner})
      for (int k = 0; k < 50; ++k) {
        const Query query = collision(draw, first, where);
        const MovingPair pair(query.x, query.d, first);
        EXPECT_NE(pair.stays_apart(query.collides_at, 1e-6), Answer::Apart);
        EXPECT_NE(pair.stays_apart(1, 1e-6), Answer::Apart);
      }
}

// A point above the inside of the triangle, and an edge across another one, at distance 1 along z.
const PairCorners kPoint = (PairCorners() << 0.2, 0, 1, 0, 0.2, 0, 0, 1, 1, 0, 0, 0).finished();
const PairCorners kEdges = (PairCorners() << -1, 1, 0, 0, 0, 0, -1, 1, 1, 1, 0, 0).finished();
const Vec3 kUp(0, 0, 1);

PairCorners moving(int first, const Vec3& one_side, const Vec3& other_side = Vec3::Zero()) {
  PairCorners d;
  for (int k = 0; k < 4; ++k) d.col(k) = k < first ? one_side : other_side;
  return d;
}

TEST(CollisionDetection, StopsAtTheShareThatIsKept) {
  for (const double kept : {0.1, 0.5}) {
    EXPECT_NEAR(point_triangle_step(kPoint, moving(1, -4 * kUp), 1, kept), (1 - kept) / 4, 1e-12);
    EXPECT_NEAR(edge_edge_step(kEdges, moving(2, -2 * kUp, 2 * kUp), 1, kept), (1 - kept) / 4, 1e-12);
    EXPECT_NEAR(edge_edge_step(kEdges, moving(2, -4 * kUp), 0.1, kept), 0.1, 0);
  }
}

TEST(CollisionDetection, LetsPassWhatDoesNotCollide) {
  for (const Vec3& away : {Vec3(0, 0, 5), Vec3(9, 0, 0), Vec3(0, -1e6, 0), Vec3(0, 0, -0.8)}) {
    EXPECT_EQ(point_triangle_step(kPoint, moving(1, away), 1, 0.1), 1) << away;
    EXPECT_EQ(edge_edge_step(kEdges, moving(2, away), 1, 0.1), 1) << away;
  }
  const Vec3 together(1e4, -3e4, 1e5);
  EXPECT_EQ(point_triangle_step(kPoint, moving(1, together, together), 1, 0.1), 1);
  EXPECT_EQ(edge_edge_step(kEdges, moving(2, together, together), 1, 0.1), 1);
  EXPECT_EQ(point_triangle_step(kPoint, PairCorners::Zero(), 1, 0.1), 1);
}

TEST(CollisionDetection, RefusesToMoveWhatTouchesOrIsNotFinite) {
  PairCorners touching = kPoint, broken = kPoint;
  touching(2, 0) = 0;
  EXPECT_EQ(point_triangle_step(touching, moving(1, kUp), 1, 0.1), 0);
  EXPECT_EQ(edge_edge_step(PairCorners::Zero(), moving(2, kUp), 1, 0.1), 0);
  for (const double bad : {kNaN, kInfinity, 1e300}) {
    broken(1, 2) = bad;
    EXPECT_EQ(point_triangle_step(broken, moving(1, kUp), 1, 0.1), 0);
    EXPECT_EQ(edge_edge_step(kEdges, broken, 1, 0.1), 0);
  }
}

}  // namespace
}  // namespace coapt
