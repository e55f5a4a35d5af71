#include "mesh/distance/triangle_distance.hpp"
#include "support/exact_ccd.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include <random>

namespace coapt {
namespace {

using exact_ccd::MovingPair;
using Corners = MovingPair::Corners;

double exact_distance(const Corners& x, int first) {
  return MovingPair(x, Corners::Zero(), first).distance();
}

// Uniform in [-1, 1]^3, and powers of ten.
class Draw {
 public:
  Vec3 vector() { return {uniform_(random_), uniform_(random_), uniform_(random_)}; }
  double power(int low, int high) {
    return std::pow(10.0, std::uniform_int_distribution(low, high)(random_));
  }
  double share() { return 0.5 + 0.5 * uniform_(random_); }

 private:
  std::mt19937 random_{11};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};

TEST(ExactDistance, IsThatOfNearlyParallelEdgesThatCrossAtAnyHeight) {  // VERIFICATION F1c
  Draw draw;
  double worst = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 u = draw.vector(), v = u + draw.power(-12, -1) * draw.vector();
    const Vec3 middle = draw.vector(), lift = draw.power(-12, 0) * u.cross(v).normalized();
    const double s = draw.share(), t = draw.share();
    const Vec3 a = middle - s * u, c = middle + lift - t * v;
    const Vec3 b = a + u, d = c + v;
    const double exact = exact_distance((Corners() << a, b, c, d).finished(), 2);
    worst = std::max(worst, std::abs(segment_distance(a, b, c, d) - exact));
  }
  EXPECT_LT(worst, 2e-15);
}

TEST(ExactDistance, IsThatOfThinAndDegenerateTriangles) {  // VERIFICATION F1b
  Draw draw;
  double worst = 0;
  for (int k = 0; k < 4000; ++k) {
    const Vec3 a = draw.vector(), b = draw.vector();
    const double s = k % 3 == 0 ? 0 : draw.share();  // a needle, or flat
    const Vec3 c = a + s * (b - a) + (k % 7 == 0 ? 0 : draw.power(-14, -1)) * draw.vector();
    const double wb = draw.share(), wc = draw.share() * (1 - wb);
    Vec3 p = (1 - wb - wc) * a + wb * b + wc * c;
    p += draw.power(-12, 0) * (k % 2 == 0 ? draw.vector() : Vec3((b - a).cross(c - a).normalized()));
    const double exact = exact_distance((Corners() << p, a, b, c).finished(), 1);
    worst = std::max(worst, std::abs(point_triangle_distance(p, a, b, c) - exact));
  }
  EXPECT_LT(worst, 1e-11);
}

}  // namespace
}  // namespace coapt
