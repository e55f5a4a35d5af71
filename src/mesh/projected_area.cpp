#include "mesh/projected_area.hpp"

#include "core/error.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace coapt {
namespace {

using Plan = Eigen::Matrix2Xd;  // projected positions, 2 x count
using Interval = std::pair<double, double>;

constexpr int kCoarsest = 512;  // rows over the polygon's extent
constexpr int kFinestRefinement = 32;
constexpr double kTolerance = 1e-6;  // of the polygon's area

// Two unit vectors that span the plane across the normal.
Plan projected(const Points& points, const Vec3& normal) {
  const Vec3 n = normal.normalized();
  const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
  Plan result(2, points.cols());
  result.row(0) = u.transpose() * points;
  result.row(1) = v.transpose() * points;
  return result;
}

// Adds where the segment crosses the row; an end on the row counts for the segment above it only.
void add_crossing(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double y,
                  std::vector<double>& crossings) {
  if ((a[1] <= y) != (b[1] <= y)) crossings.push_back(a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1])));
}

// Walks through the rows from below and keeps the triangles that reach the present one.
class Sweep {
 public:
  // Rows end where an edge runs along them: the covered length jumps there, and has only kinks elsewhere.
  Sweep(const Plan& points, const Triangles& triangles, const Plan& polygon)
      : points_(points),
        triangles_(triangles),
        polygon_(polygon),
        order_(static_cast<size_t>(triangles.cols())) {
    std::iota(order_.begin(), order_.end(), 0);
    std::sort(order_.begin(), order_.end(), [&](int l, int r) { return low(l) < low(r); });
    breaks_ = {polygon.row(1).minCoeff(), polygon.row(1).maxCoeff()};
    const double shallow = (breaks_[1] - breaks_[0]) / kCoarsest / 8;
    const auto add_breaks = [&, bottom = breaks_[0], top = breaks_[1]](double a, double b) {
      if (std::abs(a - b) > shallow) return;
      for (const double y : {a, b})
        if (y > bottom && y < top) breaks_.push_back(y);
    };
    for (Eigen::Index i = 0; i < polygon.cols(); ++i)
      add_breaks(polygon(1, i), polygon(1, (i + 1) % polygon.cols()));
    for (Eigen::Index t = 0; t < triangles.cols(); ++t)
      for (int k = 0; k < 3; ++k)
        add_breaks(points(1, triangles(k, t)), points(1, triangles((k + 1) % 3, t)));
    std::sort(breaks_.begin(), breaks_.end());
    breaks_.erase(std::unique(breaks_.begin(), breaks_.end()), breaks_.end());
  }

  // Areas with rows of at most a `kCoarsest`-th of the polygon's extent, divided once more into
  // `refinement` rows, each taken at its middle.
  UncoveredArea areas(int refinement) {
    UncoveredArea result;
    const double highest = (breaks_.back() - breaks_.front()) / kCoarsest;
    active_.clear();
    next_ = 0;
    for (size_t i = 0; i + 1 < breaks_.size(); ++i) {
      const double height = breaks_[i + 1] - breaks_[i];
      const int rows = refinement * std::max(1, static_cast<int>(std::ceil(height / highest)));
      result.row_height = std::max(result.row_height, height / rows);
      result.row_count += rows;
      for (int row = 0; row < rows; ++row)
        add_row(breaks_[i] + (row + 0.5) * height / rows, height / rows, result);
    }
    return result;
  }

 private:
  void add_row(double y, double height, UncoveredArea& result) {
    find_covered(y);
    crossings_.clear();
    for (Eigen::Index i = 0; i < polygon_.cols(); ++i)
      add_crossing(polygon_.col(i), polygon_.col((i + 1) % polygon_.cols()), y, crossings_);
    std::sort(crossings_.begin(), crossings_.end());
    for (size_t i = 0; i + 1 < crossings_.size(); i += 2) {
      const Interval inside = {crossings_[i], crossings_[i + 1]};
      result.polygon_area += (inside.second - inside.first) * height;
      result.area += uncovered_length(inside) * height;
    }
  }

  double low(int t) const {
    return std::min(
        {points_(1, triangles_(0, t)), points_(1, triangles_(1, t)), points_(1, triangles_(2, t))});
  }
  double high(int t) const {
    return std::max(
        {points_(1, triangles_(0, t)), points_(1, triangles_(1, t)), points_(1, triangles_(2, t))});
  }

  // The intervals of the row that triangles cover, sorted by their beginning.
  void find_covered(double y) {
    while (next_ < order_.size() && low(order_[next_]) <= y) active_.push_back(order_[next_++]);
    active_.erase(std::remove_if(active_.begin(), active_.end(), [&](int t) { return high(t) <= y; }),
                  active_.end());
    covered_.clear();
    for (const int t : active_) {
      crossings_.clear();
      for (int k = 0; k < 3; ++k)
        add_crossing(points_.col(triangles_(k, t)), points_.col(triangles_((k + 1) % 3, t)), y, crossings_);
      if (crossings_.size() == 2) covered_.push_back(std::minmax(crossings_[0], crossings_[1]));
    }
    std::sort(covered_.begin(), covered_.end());
  }

  double uncovered_length(const Interval& inside) const {
    double length = 0, reached = inside.first;
    for (const Interval& interval : covered_) {
      if (interval.first >= inside.second) break;
      length += std::max(0.0, interval.first - reached);
      reached = std::max(reached, interval.second);
    }
    return length + std::max(0.0, inside.second - reached);
  }

  const Plan& points_;
  const Triangles& triangles_;
  const Plan& polygon_;
  std::vector<double> breaks_;  // heights at which rows end, see the constructor
  std::vector<int> order_;      // triangles by their lowest corner
  std::vector<int> active_;     // those that reach the present row
  size_t next_ = 0;             // in order_
  std::vector<double> crossings_;
  std::vector<Interval> covered_;
};

}  // namespace

Plane best_fit_plane(const Points& points) {
  if (points.cols() < 3) throw InputError("a plane needs at least three points");
  Plane plane;
  plane.centre = points.rowwise().mean();
  const Points centred = points.colwise() - plane.centre;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(centred * centred.transpose());
  if (!(solver.eigenvalues()[1] > 1e-13 * solver.eigenvalues()[2]))
    throw InputError("the points lie on one line; no plane fits best");
  plane.normal = solver.eigenvectors().col(0);
  int largest = 0;
  plane.normal.cwiseAbs().maxCoeff(&largest);
  if (plane.normal[largest] < 0) plane.normal = -plane.normal;
  return plane;
}

UncoveredArea uncovered_area(const Points& points, const Triangles& triangles, const Points& polygon,
                             const Vec3& normal) {
  if (polygon.cols() < 3) throw InputError("a polygon needs at least three corners");
  if (!(normal.norm() > 0)) throw InputError("the normal along which to project is zero");
  // Seen from the polygon's first corner, so that a mesh far from the origin keeps its digits.
  const Vec3 origin = polygon.col(0);
  const Plan plan = projected(points.colwise() - origin, normal);
  const Plan outline = projected(polygon.colwise() - origin, normal);
  Sweep sweep(plan, triangles, outline);
  UncoveredArea result = sweep.areas(1);
  if (!(result.polygon_area > 0)) throw InputError("the polygon has no area along the normal");
  for (int refinement = 2; refinement <= kFinestRefinement; refinement *= 2) {
    const double before = result.area;
    result = sweep.areas(refinement);
    result.error = std::abs(result.area - before);
    if (result.error <= kTolerance * result.polygon_area) break;
  }
  return result;
}

}  // namespace coapt
