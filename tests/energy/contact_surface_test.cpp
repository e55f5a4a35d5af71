// The search for pairs of features that may meet.
#include "energy/contact/contact_surface.hpp"

#include "energy/contact/barrier_candidates.hpp"
#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <set>
#include <vector>

namespace coapt {
namespace {

using PairName = std::array<int, 3>;  // kind and features

PairName name_of(const FeaturePair& pair) { return {static_cast<int>(pair.kind), pair.first, pair.second}; }

// Whether the boxes of the two features overlap at x.
bool are_boxes_touching(const FeaturePair& pair, const Points& x) {
  const int split = pair.kind == PairKind::PointTriangle ? 1 : 2;
  Bounds first, second;
  for (int k = 0; k < 4; ++k)
    (k < split ? first : second).include(Vec3(x.col(pair.nodes[static_cast<size_t>(k)])));
  return (first.low <= second.high).all() && (second.low <= first.high).all();
}

// Two crumpled sheets far from the origin, moved by little and by more than their extent, each node its own
// way and all alike: what touches at some time is found, also where the way shortens during the search.
TEST(ContactSurface, FindsWhateverTouchesOnTheWay) {
  const TriangleMesh sheet = grid_mesh(5, 4);
  const int n = sheet.vertex_count();
  Points rest(3, 2 * n);
  rest << sheet.vertices, sheet.vertices.colwise() + Vec3(0, 0, 5);
  Triangles triangles(3, 2 * sheet.triangle_count());
  triangles << sheet.triangles, sheet.triangles.array() + n;
  const ContactSurface surface(rest, triangles, static_cast<int>(triangles.cols()), {});
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto any = [&](double size) {
    return Vec3(size * Vec3(uniform(random), uniform(random), uniform(random)));
  };
  size_t wanted = 0, found = 0, all = 0;
  for (const double way : {1e-4, 0.3, 300.0})
    for (const double shared : {0.0, 1e3}) {
      Points x = rest, d(3, 2 * n);
      for (int k = 0; k < 2 * n; ++k) x.col(k) += Vec3(40, -70, 100) + any(0.2);
      x.rightCols(n).row(2).array() -= 4.8;
      const Vec3 alike = any(shared);
      for (int k = 0; k < 2 * n; ++k) d.col(k) = alike + any(way);
      std::vector<FeaturePair> pairs;
      surface.visit_near(x, 1e6, [&](const FeaturePair& pair) { pairs.push_back(pair); });
      for (const double end : {1.0, 0.25}) {
        std::set<PairName> visited;
        double most = 1;
        surface.visit_swept(x, d, 0, most, [&](const FeaturePair& pair) {
          visited.insert(name_of(pair));
          most = end;
        });
        for (const FeaturePair& pair : pairs) {
          bool touches = false;
          for (int k = 0; k <= 30 && !touches; ++k)
            touches = are_boxes_touching(pair, x + end * k / 30.0 * d);
          wanted += touches;
          EXPECT_TRUE(!touches || visited.count(name_of(pair)) > 0) << way << " " << shared << " " << end;
        }
        found += visited.size();
        all += pairs.size();
      }
    }
  EXPECT_GT(wanted, all / 10);
  EXPECT_LT(found, 2 * wanted) << "little that touches nothing";
}

TEST(ContactSurface, LooksAroundSomeNodesAlone) {
  const TriangleMesh sheet = grid_mesh(6, 6);
  const int n = sheet.vertex_count();
  const ContactSurface surface(sheet.vertices, sheet.triangles, sheet.triangle_count(), {});
  Points d = Points::Zero(3, n);
  d.col(0) = Vec3(20, 20, 0);  // across the sheet
  NodeMask around(static_cast<size_t>(n), 0);
  int visits = 0;
  const auto count = [&](const FeaturePair&) { ++visits; };
  surface.visit_swept(sheet.vertices, d, 0, 1, count, {.all_but_around = &around});
  EXPECT_EQ(visits, 0);
  around[0] = 1;
  surface.visit_swept(sheet.vertices, d, 0, 1, count, {.all_but_around = &around});
  EXPECT_GT(visits, 0);
  visits = 0;
  surface.visit_swept(sheet.vertices, d, 0, 0,
                      [&](const FeaturePair& pair) {
                        visits += pair.kind == PairKind::PointTriangle && pair.nodes[0] == n - 1;
                      },
                      {.all_but_around = &around});
  EXPECT_EQ(visits, 0) << "no way";
}

}  // namespace
}  // namespace coapt
