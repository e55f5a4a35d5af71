#include "mesh/remesh/spanning_surface.hpp"

#include "core/bounded_int.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

constexpr int kCells = 64;       // along each side of the grid
constexpr int kDirections = 90;  // of chords: one every two degrees
constexpr double kOnEdge =
    1e-14;  // 1 + cosine of the angle under which an edge is seen from a place on it, by rounding

struct Hit {
  double distance = kInfinity, height = 0;
};

}  // namespace

double spanned_height(const Points& polygon, double x, double y) {
  const Eigen::Vector2d place(x, y);
  double weights = 0, weighted = 0;
  for (Eigen::Index i = 0; i < polygon.cols(); ++i) {
    const Eigen::Index k = (i + 1) % polygon.cols();
    const Eigen::Vector2d a = polygon.col(i).head<2>() - place, b = polygon.col(k).head<2>() - place;
    const double ra = a.norm(), rb = b.norm(), dot = a.dot(b), cross = a[0] * b[1] - a[1] * b[0];
    if (ra == 0) return polygon(2, i);
    if (ra * rb + dot <= kOnEdge * ra * rb) return (rb * polygon(2, i) + ra * polygon(2, k)) / (ra + rb);
    // Tangent of half the angle under which the edge is seen; each end of the edge gets its share.
    const double tangent = cross / (ra * rb + dot);
    weights += tangent / ra + tangent / rb;
    weighted += tangent / ra * polygon(2, i) + tangent / rb * polygon(2, k);
  }
  return weights == 0 ? polygon.row(2).mean() : weighted / weights;
}

double highest_chord(const Points& polygon, double x, double y) {
  // The nearest place of the polygon in each direction; kDirections further lies the opposite one.
  std::array<Hit, 2 * kDirections> hits;
  const double step = std::numbers::pi / kDirections;
  const Eigen::Vector2d place(x, y);
  for (Eigen::Index i = 0; i < polygon.cols(); ++i) {
    const Eigen::Index k = (i + 1) % polygon.cols();
    Eigen::Vector2d a = polygon.col(i).head<2>() - place, b = polygon.col(k).head<2>() - place;
    double za = polygon(2, i), zb = polygon(2, k);
    const double cross = a[0] * b[1] - a[1] * b[0];
    if (cross == 0) continue;
    if (cross < 0) {
      std::swap(a, b);
      std::swap(za, zb);
    }
    const double from = std::atan2(a[1], a[0]) / step;
    const double to = from + std::atan2(std::abs(cross), a.dot(b)) / step;
    for (int d = bounded_int(std::ceil(from), -2 * kDirections, 2 * kDirections); d <= to; ++d) {
      const Eigen::Vector2d along(std::cos(d * step), std::sin(d * step));
      const double on_b = a[0] * along[1] - a[1] * along[0], on_a = along[0] * b[1] - along[1] * b[0];
      const double part = on_b / (on_a + on_b);
      const double distance = (a + part * (b - a)).norm();
      Hit& hit = hits[static_cast<size_t>((d + 4 * kDirections) % (2 * kDirections))];
      if (distance < hit.distance) hit = {distance, za + part * (zb - za)};
    }
  }
  double highest = -kInfinity;
  for (size_t d = 0; d < kDirections; ++d) {
    const Hit &one = hits[d], &other = hits[d + kDirections];
    if (one.distance == kInfinity || other.distance == kInfinity) continue;
    const double length = one.distance + other.distance;
    highest =
        std::max(highest, length > 0 ? (one.height * other.distance + other.height * one.distance) / length
                                     : one.height);
  }
  return highest;
}

SpanningSurface::SpanningSurface(const Points& polygon) {
  const Vec3 low = polygon.rowwise().minCoeff(), extent = polygon.rowwise().maxCoeff() - low;
  x0_ = low[0];
  y0_ = low[1];
  dx_ = extent[0] / kCells;
  dy_ = extent[1] / kCells;
  for (int j = 0; j <= kCells; ++j)
    for (int i = 0; i <= kCells; ++i) nodes_.push_back(spanned_height(polygon, x0_ + i * dx_, y0_ + j * dy_));
}

double SpanningSurface::height(double x, double y) const {
  const double u = std::clamp((x - x0_) / dx_, 0.0, double(kCells));
  const double v = std::clamp((y - y0_) / dy_, 0.0, double(kCells));
  const int i = std::min(static_cast<int>(u), kCells - 1), j = std::min(static_cast<int>(v), kCells - 1);
  const auto at = [&](int k, int l) { return nodes_[static_cast<size_t>(l * (kCells + 1) + k)]; };
  const double a = u - i, b = v - j;
  return (1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
         b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1));
}

}  // namespace coapt
