#include "mesh/curve_match.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

// Length from the first point to each, and at the end that of the whole closed polygon.
std::vector<double> lengths(const Points& x) {
  std::vector<double> s{0};
  for (int k = 0; k < x.cols(); ++k) s.push_back(s.back() + (x.col((k + 1) % x.cols()) - x.col(k)).norm());
  return s;
}

// The closed polygon at a part of its length, taken modulo 1.
Vec3 at(const Points& curve, const std::vector<double>& s, double part) {
  const double place = (part - std::floor(part)) * s.back();
  const auto next = std::upper_bound(s.begin() + 1, s.end() - 1, place);
  const auto k = static_cast<Eigen::Index>(next - s.begin()) - 1;
  const double length = *next - *(next - 1);
  const double share = length > 0 ? (place - *(next - 1)) / length : 0;
  return curve.col(k) + share * (curve.col((k + 1) % curve.cols()) - curve.col(k));
}

struct Match {
  double offset = 0, cost = 0;
  int direction = 1;
};

Points points_of(const Match& match, const Points& curve, const std::vector<double>& s,
                 const std::vector<double>& loop) {
  Points result(3, static_cast<Eigen::Index>(loop.size()) - 1);
  for (Eigen::Index k = 0; k < result.cols(); ++k)
    result.col(k) = at(curve, s, match.offset + match.direction * loop[static_cast<size_t>(k)] / loop.back());
  return result;
}

}  // namespace

Points smooth_closed_curve(const Points& points, int count) {
  const Eigen::Index n = points.cols();
  Points curve(3, n * count);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Vec3 a = points.col((k + n - 1) % n), b = points.col(k), c = points.col((k + 1) % n),
               d = points.col((k + 2) % n);
    for (int i = 0; i < count; ++i) {
      const double t = static_cast<double>(i) / count;
      curve.col(k * count + i) =
          b + 0.5 * t * ((c - a) + t * ((2 * a - 5 * b + 4 * c - d) + t * (3 * (b - c) + d - a)));
    }
  }
  return curve;
}

Points matched_by_length(const Points& x, const Points& curve) {
  const std::vector<double> loop = lengths(x), s = lengths(curve);
  const auto cost = [&](double offset, int direction) {
    return (points_of({offset, 0, direction}, curve, s, loop) - x).squaredNorm();
  };
  constexpr int kStarts = 256, kRefinements = 40;
  Match best{0, cost(0, 1), 1};
  for (const int direction : {1, -1})
    for (int k = 0; k < kStarts; ++k) {
      const double offset = static_cast<double>(k) / kStarts;
      if (const double value = cost(offset, direction); value < best.cost) best = {offset, value, direction};
    }
  double step = 0.5 / kStarts;
  for (int k = 0; k < kRefinements; ++k, step /= 2)
    for (const double offset : {best.offset - step, best.offset + step})
      if (const double value = cost(offset, best.direction); value < best.cost)
        best = {offset, value, best.direction};
  return points_of(best, curve, s, loop);
}

Vec3 closest_on_curve(const Points& curve, const Vec3& x) {
  Vec3 best = curve.col(0);
  double least = kInfinity;
  for (Eigen::Index k = 0; k < curve.cols(); ++k) {
    const Vec3 a = curve.col(k), along = curve.col((k + 1) % curve.cols()) - a;
    const double part =
        along.squaredNorm() > 0 ? std::clamp((x - a).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0;
    const Vec3 place = a + part * along;
    if ((place - x).squaredNorm() >= least) continue;
    least = (place - x).squaredNorm();
    best = place;
  }
  return best;
}

double mean_distance(const Points& x, const Points& curve) {
  double sum = 0;
  for (int k = 0; k < x.cols(); ++k) {
    double least = INFINITY;
    for (int j = 0; j < curve.cols(); ++j) {
      const Vec3 a = curve.col(j), edge = curve.col((j + 1) % curve.cols()) - a;
      const double length = edge.squaredNorm();
      const double part = length > 0 ? std::clamp(edge.dot(x.col(k) - a) / length, 0.0, 1.0) : 0;
      least = std::min(least, (x.col(k) - a - part * edge).squaredNorm());
    }
    sum += std::sqrt(least);
  }
  return x.cols() > 0 ? sum / static_cast<double>(x.cols()) : 0;
}

}  // namespace coapt
