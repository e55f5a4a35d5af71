#include "valve/generators/chain.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace coapt {
namespace {

// The parabola from + s (to - from) - 4 sag s (1 - s) e_z, sampled finely.
Points parabola(const Vec3& from, const Vec3& to, double sag) {
  constexpr int kSamples = 4001;
  Points points(3, kSamples);
  for (int i = 0; i < kSamples; ++i) {
    const double s = double(i) / (kSamples - 1);
    points.col(i) = from + s * (to - from) - 4 * sag * s * (1 - s) * Vec3::UnitZ();
  }
  return points;
}

Vector lengths_along(const Points& points) {
  Vector along = Vector::Zero(points.cols());
  for (int i = 1; i < points.cols(); ++i)
    along[i] = along[i - 1] + (points.col(i) - points.col(i - 1)).norm();
  return along;
}

// The sag that makes the parabola `length` long; its length grows with the sag.
double sag_for_length(const Vec3& from, const Vec3& to, double length) {
  double low = 0, high = length;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (lengths_along(parabola(from, to, middle)).tail<1>()[0] < length ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Points at_equal_steps(const Points& curve, int steps) {
  const Vector along = lengths_along(curve);
  Points nodes(3, steps - 1);
  for (int i = 1; i < steps; ++i) {
    const double wanted = along[along.size() - 1] * i / steps;
    const auto k = std::upper_bound(along.begin(), along.end(), wanted) - along.begin();
    const double weight = (wanted - along[k - 1]) / (along[k] - along[k - 1]);
    nodes.col(i - 1) = (1 - weight) * curve.col(k - 1) + weight * curve.col(k);
  }
  return nodes;
}

}  // namespace

ChordNetwork chain(const Vec3& from, const Vec3& to, int links, double total_length, double area) {
  std::vector<std::string> defects;
  if (links < 2) defects.push_back("chain: links is " + std::to_string(links) + ": give at least 2");
  if (!(std::isfinite(total_length) && total_length > 0))
    defects.push_back("chain: total_length is " + std::to_string(total_length) + ": give a positive length");
  if (!(std::isfinite(area) && area > 0))
    defects.push_back("chain: area is " + std::to_string(area) + ": give a positive cross-section");
  if (!((to - from).norm() > 0)) defects.push_back("chain: the anchors coincide: move one of them");
  if (!defects.empty()) throw InputError(defects);

  const bool hangs = total_length > (to - from).norm() && (to - from).head<2>().norm() > 0;
  const double sag = hangs ? sag_for_length(from, to, total_length) : 0;
  ChordNetwork network;
  network.papillary.resize(3, 2);
  network.papillary << from, to;
  network.junctions = at_equal_steps(parabola(from, to, sag), links);
  auto node = [&](int i) -> ChordEnd {
    if (i == 0) return {ChordEnd::Kind::Papillary, 0};
    if (i == links) return {ChordEnd::Kind::Papillary, 1};
    return {ChordEnd::Kind::Junction, i - 1};
  };
  for (int i = 0; i < links; ++i)
    network.chords.push_back({node(i), node(i + 1), total_length / links, area, "chain", 0});
  return network;
}

}  // namespace coapt
