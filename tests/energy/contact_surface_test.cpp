// The search for pairs of features that may meet.
#include "energy/contact/contact_surface.hpp"

#include "support/meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
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

// At the last moment, at the first one, or `reach` away: in any units, and far from the origin.
TEST(ContactSurface, FindsWhatJustTouches) {
  Triangles triangles(3, 2);
  triangles << 0, 3, 1, 4, 2, 5;
  for (const double size : {1e-6, 0.03, 1.0, 700.0})
    for (const double offset : {0.0, 40.0})
      for (const double height : {1e-3, 0.1, 1.0})
        for (const Vec3& alike : {Vec3(0, 0, 0), Vec3(3, -1, 7)}) {
          Points x(3, 6), d(3, 6);
          x << 0, 1, 0, 0.2, 0.3, 0.25, 0, 0, 1, 0.2, 0.3, 0.25, 0, 0, 0, height, 2, 3;
          d.colwise() = alike;
          d(2, 3) -= height;
          const Points at = size * (x.array() + offset).matrix();
          const ContactSurface surface(at, triangles, 2, {});
          const auto finds = [&](const Points& from, const Points& way, double reach, double most) {
            bool found = false;
            surface.visit_swept(from, way, reach, most, [&](const FeaturePair& pair) {
              found = found || (pair.kind == PairKind::PointTriangle && pair.first == 3 && pair.second == 0);
            });
            return found;
          };
          EXPECT_TRUE(finds(at, size * d, 0, 1)) << size << " " << offset << " " << height;
          EXPECT_TRUE(finds(at, 4 * size * d, 0, 0.25));
          EXPECT_FALSE(finds(at, size * d, 0, 0.9));
          EXPECT_TRUE(finds(at, size * d, 0.11 * size * height, 0.9)) << "within reach";
          EXPECT_TRUE(finds(at + size * d, size * d, 0, 1)) << "at the first moment";
        }
}

// Nothing is known of a way that is not finite.
TEST(ContactSurface, FindsWhatMayGoAnywhere) {
  Triangles triangles(3, 2);
  triangles << 0, 3, 1, 4, 2, 5;
  Points x(3, 6), d = Points::Zero(3, 6);
  x << 0, 1, 0, 5, 6, 5, 0, 0, 1, 5, 5, 6, 0, 0, 0, 1, 2, 3;
  const ContactSurface surface(x, triangles, 2, {});
  for (const double way : {0.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    d(2, 3) = way;
    int visits = 0;
    surface.visit_swept(x, d, 0, 1, [&](const FeaturePair&) { ++visits; });
    EXPECT_EQ(visits > 0, way != 0) << way;
  }
}

// Two sheets, the second an obstacle or not, which cross on the way.
TEST(ContactSurface, FindsObstaclesOnTheWayButNoneAmongThemselves) {
  const TriangleMesh sheet = grid_mesh(3, 3);
  const int n = sheet.vertex_count(), count = sheet.triangle_count();
  Points x(3, 2 * n), d = Points::Zero(3, 2 * n);
  x << sheet.vertices, sheet.vertices.colwise() + Vec3(0.1, 0.05, 0.5);
  d.leftCols(n).row(2).setConstant(1);
  d.col(2 * n - 1) = Vec3(-2, -2, 0);  // through its own sheet, as no obstacle does
  Triangles triangles(3, 2 * count);
  triangles << sheet.triangles, sheet.triangles.array() + n;
  const auto visited = [&](int membrane_count) {
    std::array<int, 3> of{};  // by the number of nodes in the first sheet: none, some, all
    ContactSurface(x, triangles, membrane_count, {}).visit_swept(x, d, 0, 1, [&](const FeaturePair& pair) {
      const auto first = std::count_if(pair.nodes.begin(), pair.nodes.end(), [n](int k) { return k < n; });
      ++of[first == 0 ? 0 : first == 4 ? 2 : 1];
    });
    return of;
  };
  const auto membranes = visited(2 * count), obstacle = visited(count);
  EXPECT_GT(membranes[0], 0);
  EXPECT_EQ(obstacle[0], 0);
  EXPECT_GT(obstacle[1], 9);
  EXPECT_EQ(obstacle[1], membranes[1]);
  EXPECT_EQ(obstacle[2], membranes[2]);
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
