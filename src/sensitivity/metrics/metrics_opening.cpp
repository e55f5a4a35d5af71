#include "sensitivity/metrics/metrics_opening.hpp"

#include "core/bounded_int.hpp"
#include "core/error.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

using Vec2 = Eigen::Vector2d;
using Places = Eigen::Matrix2Xd;

constexpr double kGridPerBlur = 3;      // points
constexpr double kSamplesPerBlur = 3;   // of a facet, along an edge
constexpr double kMargin = 0.2;         // of the grid around the rim
constexpr double kRounding = 1e-3;      // of the modulus of a signed area, over the mean area
constexpr int kMostPoints = 4'000'000;  // of the grid

struct Step {
  double value, slope;
};

// From 0 to 1 between `from` and `to`, twice differentiable.
Step smooth_step(double t, double from, double to) {
  if (t <= from) return {0, 0};
  if (t >= to) return {1, 0};
  const double u = (t - from) / (to - from), v = u * (1 - u);
  return {u * u * u * (10 - 15 * u + 6 * u * u), 30 * v * v / (to - from)};
}

struct Grid {
  Vec2 corner = Vec2::Zero();
  double spacing = 0;
  int columns = 0, rows = 0;

  int count() const { return columns * rows; }
  Vec2 point(int column, int row) const { return corner + spacing * Vec2(column, row); }

  // visit(index, point) of the points within `radius` of p.
  template <typename Visit>
  void visit_around(const Vec2& p, double radius, const Visit& visit) const {
    const auto range = [&](double at, int most) {
      const double first = std::ceil((at - radius) / spacing), last = std::floor((at + radius) / spacing);
      return std::pair(bounded_int(first, 0, most), bounded_int(last, -1, most - 1));
    };
    const auto [c0, c1] = range(p[0] - corner[0], columns);
    const auto [r0, r1] = range(p[1] - corner[1], rows);
    for (int r = r0; r <= r1; ++r)
      for (int c = c0; c <= c1; ++c) visit(r * columns + c, point(c, r));
  }
};

class OpeningArea final : public Metric {
 public:
  OpeningArea(std::string name, const Triangles& triangles, std::vector<int> rim, const Points& x,
              const OpeningOptions& options)
      : Metric(std::move(name)), triangles_(triangles), rim_(std::move(rim)), blur_(options.blur) {
    const Vec3 w = options.axis.normalized(), u = w.unitOrthogonal();
    view_ << u.transpose(), w.cross(u).transpose();
    const Places outline = (view_ * x)(Eigen::all, rim_);
    const Vec2 low = outline.rowwise().minCoeff(), high = outline.rowwise().maxCoeff();
    const Vec2 margin = Vec2::Constant(kMargin * (high - low).maxCoeff() + 2 * blur_);
    grid_.spacing = blur_ / kGridPerBlur;
    grid_.corner = low - margin;
    const Vec2 extent = high - low + 2 * margin;
    grid_.columns = bounded_int(extent[0] / grid_.spacing, 0, kMostPoints) + 1;
    grid_.rows = bounded_int(extent[1] / grid_.spacing, 0, kMostPoints) + 1;
    double area = 0;
    for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
      const Vec3 a = x.col(triangles_(0, t)), b = x.col(triangles_(1, t)), c = x.col(triangles_(2, t));
      const double edge = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
      divisions_.push_back(bounded_int(std::ceil(kSamplesPerBlur * edge / blur_), 1, kMostPoints));
      area += 0.5 * (b - a).cross(c - a).norm();
    }
    rounding_ = kRounding * area / static_cast<double>(std::max<Eigen::Index>(1, triangles_.cols()));
  }

  bool is_grid_too_large() const {
    return static_cast<double>(grid_.columns) * static_cast<double>(grid_.rows) > kMostPoints;
  }

  double evaluate(const Points& x, Points* gradient) const override {
    if (gradient != nullptr) gradient->setZero(3, x.cols());
    const Places y = view_ * x;
    Vector open = inside(y);
    visit_samples(y, [&](Eigen::Index, double share, const Vec3&, const Vec2& at, double area) {
      grid_.visit_around(
          at, blur_, [&](int k, const Vec2& p) { open[k] -= share * area * kernel((p - at).squaredNorm()); });
    });
    const double cell = grid_.spacing * grid_.spacing;
    double value = 0;
    Vector slope(open.size());
    for (Eigen::Index k = 0; k < open.size(); ++k) {
      const Step phi = smooth_step(open[k], 0.25, 0.75);
      value += cell * phi.value;
      slope[k] = cell * phi.slope;
    }
    if (gradient == nullptr || slope.isZero(0)) return value;
    Places by_y = Places::Zero(2, y.cols());
    add_cover_gradient(y, slope, by_y);
    add_rim_gradient(y, slope, by_y);
    *gradient = view_.transpose() * by_y;
    return value;
  }

 private:
  double kernel(double square) const {
    const double u = 1 - square / (blur_ * blur_);
    return u > 0 ? 4 / (std::numbers::pi * blur_ * blur_) * u * u * u : 0;
  }
  // By the square of the distance.
  double kernel_slope(double square) const {
    const double u = 1 - square / (blur_ * blur_);
    return u > 0 ? -12 / (std::numbers::pi * std::pow(blur_, 4)) * u * u : 0;
  }

  double signed_area(const Places& y, Eigen::Index t) const {
    const Vec2 a = y.col(triangles_(1, t)) - y.col(triangles_(0, t)),
               b = y.col(triangles_(2, t)) - y.col(triangles_(0, t));
    return 0.5 * (a[0] * b[1] - a[1] * b[0]);
  }
  double rounded(double area) const { return std::hypot(area, rounding_) - rounding_; }

  // visit(triangle, share of its area, barycentric coordinates, place, projected area) of all samples: the
  // centroids of the parts that equal divisions of the edges cut a triangle into.
  template <typename Visit>
  void visit_samples(const Places& y, const Visit& visit) const {
    for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
      const int n = divisions_[static_cast<size_t>(t)];
      const double area = rounded(signed_area(y, t)), share = 1.0 / (n * n);
      const Vec2 a = y.col(triangles_(0, t)), b = y.col(triangles_(1, t)), c = y.col(triangles_(2, t));
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n - i; ++j)
          for (const double third : {1.0, 2.0}) {
            if (third == 2 && i + j + 1 >= n) continue;  // no part that points the other way
            const Vec3 weights(1 - (i + j + 2 * third / 3) / n, (i + third / 3) / n, (j + third / 3) / n);
            visit(t, share, weights, Vec2(weights[0] * a + weights[1] * b + weights[2] * c), area);
          }
    }
  }

  void add_cover_gradient(const Places& y, const Vector& slope, Places& by_y) const {
    Vector by_area = Vector::Zero(triangles_.cols());
    visit_samples(y, [&](Eigen::Index t, double share, const Vec3& weights, const Vec2& at, double area) {
      Vec2 pull = Vec2::Zero();
      grid_.visit_around(at, blur_, [&](int k, const Vec2& p) {
        if (slope[k] == 0) return;
        const double square = (p - at).squaredNorm();
        by_area[t] -= slope[k] * share * kernel(square);
        pull -= slope[k] * share * area * kernel_slope(square) * 2 * (at - p);
      });
      for (int c = 0; c < 3; ++c) by_y.col(triangles_(c, t)) += weights[c] * pull;
    });
    for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
      const double area = signed_area(y, t), factor = 0.5 * by_area[t] * area / std::hypot(area, rounding_);
      for (int c = 0; c < 3; ++c) {
        const Vec2 edge = y.col(triangles_((c + 2) % 3, t)) - y.col(triangles_((c + 1) % 3, t));
        by_y.col(triangles_(c, t)) += factor * Vec2(-edge[1], edge[0]);
      }
    }
  }

  // The nearest point of the rim: on the edge from corner `first`, at `along` of it.
  struct Nearest {
    size_t first = 0;
    double along = 0;
    Vec2 away = Vec2::Zero();  // from it
    double distance = kInfinity;
  };
  Vec2 corner(const Places& y, size_t k) const { return y.col(rim_[k % rim_.size()]); }

  Nearest nearest_on_rim(const Places& y, const Vec2& p) const {
    Nearest nearest;
    for (size_t k = 0; k < rim_.size(); ++k) {
      const Vec2 a = corner(y, k), edge = corner(y, k + 1) - a;
      const double square = edge.squaredNorm();
      const double s = square > 0 ? std::clamp((p - a).dot(edge) / square, 0.0, 1.0) : 0;
      const Vec2 away = p - a - s * edge;
      if (const double d = away.norm(); d < nearest.distance) nearest = {k, s, away, d};
    }
    return nearest;
  }

  bool is_inside(const Places& y, const Vec2& p) const {
    bool inside = false;
    for (size_t k = 0; k < rim_.size(); ++k) {
      const Vec2 a = corner(y, k), b = corner(y, k + 1);
      if ((a[1] > p[1]) != (b[1] > p[1]) && p[0] < a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        inside = !inside;
    }
    return inside;
  }

  // a(y) from the signed distance to the rim, positive inside.
  Step indicator(double signed_distance) const { return smooth_step(signed_distance / blur_, -0.5, 0.5); }

  Vector inside(const Places& y) const {
    Vector values(grid_.count());
    for (int r = 0; r < grid_.rows; ++r)
      for (int c = 0; c < grid_.columns; ++c) {
        const Vec2 p = grid_.point(c, r);
        const double sign = is_inside(y, p) ? 1 : -1;
        values[r * grid_.columns + c] = indicator(sign * nearest_on_rim(y, p).distance).value;
      }
    return values;
  }

  void add_rim_gradient(const Places& y, const Vector& slope, Places& by_y) const {
    for (int r = 0; r < grid_.rows; ++r)
      for (int c = 0; c < grid_.columns; ++c) {
        const double weight = slope[r * grid_.columns + c];
        if (weight == 0) continue;
        const Vec2 p = grid_.point(c, r);
        const Nearest nearest = nearest_on_rim(y, p);
        const double sign = is_inside(y, p) ? 1 : -1;
        const double rate = indicator(sign * nearest.distance).slope / blur_;
        if (rate == 0 || nearest.distance == 0) continue;
        const Vec2 pull = -weight * rate * sign / nearest.distance * nearest.away;
        by_y.col(rim_[nearest.first]) += (1 - nearest.along) * pull;
        by_y.col(rim_[(nearest.first + 1) % rim_.size()]) += nearest.along * pull;
      }
  }

  Triangles triangles_;
  std::vector<int> rim_;
  double blur_;
  Eigen::Matrix<double, 2, 3> view_;
  Grid grid_;
  std::vector<int> divisions_;  // of the edges of each triangle
  double rounding_ = 0;
};

}  // namespace

std::unique_ptr<Metric> make_opening_area(std::string name, const Triangles& triangles, std::vector<int> rim,
                                          const Points& x_start, const OpeningOptions& options) {
  const std::string where = "metric \"" + name + "\": ";
  std::vector<std::string> defects;
  if (rim.size() < 3) defects.push_back(where + "the rim needs at least three nodes");
  for (const int node : rim)
    if (node < 0 || node >= x_start.cols())
      defects.push_back(where + "there is no node " + std::to_string(node));
  if (!(options.blur > 0 && std::isfinite(options.blur)))
    defects.push_back(where + "blur must be a positive length");
  if (!(options.axis.norm() > 0) || !options.axis.allFinite())
    defects.push_back(where + "the axis has no direction");
  if (!x_start.allFinite()) defects.push_back(where + "a position is not finite");
  if (!defects.empty()) throw InputError(defects);
  auto metric = std::make_unique<OpeningArea>(std::move(name), triangles, std::move(rim), x_start, options);
  if (metric->is_grid_too_large())
    throw InputError(where + "blur is too small for a rim of this size; take a hundredth of it or more");
  return metric;
}

}  // namespace coapt
