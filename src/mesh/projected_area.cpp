#include "mesh/projected_area.hpp"

#include "core/bounded_int.hpp"
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

// Of a row: from one edge to another of a triangle, or of the polygon.
struct Interval {
  double first = 0, second = 0;
  int triangle = -1;

  bool operator<(const Interval& other) const {
    return first != other.first ? first < other.first : second < other.second;
  }
};

constexpr int kCoarsest = 512;       // rows over the polygon's extent
constexpr double kTolerance = 1e-6;  // of the polygon's area
constexpr int kGradientRefinement = 8;

// Two unit vectors that span the plane across the normal.
Eigen::Matrix<double, 3, 2> view_axes(const Vec3& normal) {
  const Vec3 n = normal.normalized(), u = n.unitOrthogonal();
  Eigen::Matrix<double, 3, 2> axes;
  axes << u, n.cross(u);
  return axes;
}

Plan projected(const Points& points, const Eigen::Matrix<double, 3, 2>& axes) {
  Plan result(2, points.cols());
  result.row(0) = axes.col(0).transpose() * points;
  result.row(1) = axes.col(1).transpose() * points;
  return result;
}

// A quarter turn. Swaps coordinates without rounding.
Plan turned(const Plan& plan) {
  Plan result(2, plan.cols());
  result.row(0) = plan.row(1);
  result.row(1) = -plan.row(0);
  return result;
}

// Derivatives by projected positions, of how edges move that are at more than 45 degrees to the rows: where a
// flatter one ends, rows do not tell well.
struct PlanGradient {
  Plan by_points, by_polygon;
  bool takes_diagonals;  // those at just 45 degrees, too
};

double crossing(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double y) {
  return a[0] + (b[0] - a[0]) * ((y - a[1]) / (b[1] - a[1]));
}

bool crosses(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double y) {
  return (a[1] <= y) != (b[1] <= y);
}

// Adds where the segment crosses the row; an end on the row counts for the segment above it only.
void add_crossing(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double y,
                  std::vector<double>& crossings) {
  if (crosses(a, b, y)) crossings.push_back(crossing(a, b, y));
}

// Adds how the crossing at `at` moves with the ends of its edge, one of edge(0), edge(1) ..., times `factor`.
template <typename Edge>
void add_motion(const Plan& points, int edge_count, const Edge& edge, double y, double at, double factor,
                bool takes_diagonals, Plan& gradient) {
  for (int k = 0; k < edge_count; ++k) {
    const auto [i, j] = edge(k);
    const Eigen::Vector2d a = points.col(i), b = points.col(j);
    if (!crosses(a, b, y) || crossing(a, b, y) != at) continue;
    const double across = std::abs(b[0] - a[0]), along = std::abs(b[1] - a[1]);
    if (across > along || (across == along && !takes_diagonals)) return;
    const double share = (y - a[1]) / (b[1] - a[1]);
    const Eigen::Vector2d by_end(1, -(b[0] - a[0]) / (b[1] - a[1]));
    gradient.col(i) += factor * (1 - share) * by_end;
    gradient.col(j) += factor * share * by_end;
    return;
  }
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
  UncoveredArea areas(int refinement, PlanGradient* gradient = nullptr) {
    UncoveredArea result;
    gradient_ = gradient;
    const double highest = (breaks_.back() - breaks_.front()) / kCoarsest;
    active_.clear();
    next_ = 0;
    for (size_t i = 0; i + 1 < breaks_.size(); ++i) {
      const double height = breaks_[i + 1] - breaks_[i];
      const int rows = refinement * bounded_int(std::ceil(height / highest), 1, kCoarsest);
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
      if (gradient_ != nullptr) add_gradient(inside, y, height);
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
      if (crossings_.size() != 2) continue;
      const auto [from, to] = std::minmax(crossings_[0], crossings_[1]);
      covered_.push_back({from, to, t});
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

  // The same, of how the ends of each uncovered stretch move: at a triangle, or at the polygon (-1).
  void add_gradient(const Interval& inside, double y, double height) {
    double reached = inside.first;
    int owner = -1;
    const auto add_stretch = [&](double end, int owner_of_end) {
      if (!(end > reached)) return;
      add_end(owner, y, reached, -height);
      add_end(owner_of_end, y, end, height);
    };
    for (const Interval& interval : covered_) {
      if (interval.first >= inside.second) break;
      add_stretch(interval.first, interval.triangle);
      if (interval.second <= reached) continue;
      reached = interval.second;
      owner = interval.triangle;
    }
    add_stretch(inside.second, -1);
  }

  void add_end(int triangle, double y, double at, double factor) {
    if (triangle >= 0) {
      const auto edge = [&](int k) {
        return std::pair(triangles_(k, triangle), triangles_((k + 1) % 3, triangle));
      };
      add_motion(points_, 3, edge, y, at, factor, gradient_->takes_diagonals, gradient_->by_points);
    } else {
      const int count = static_cast<int>(polygon_.cols());
      const auto edge = [&](int k) { return std::pair(k, (k + 1) % count); };
      add_motion(polygon_, count, edge, y, at, factor, gradient_->takes_diagonals, gradient_->by_polygon);
    }
  }

  const Plan& points_;
  const Triangles& triangles_;
  const Plan& polygon_;
  PlanGradient* gradient_ = nullptr;  // null: none is wanted
  std::vector<double> breaks_;        // heights at which rows end, see the constructor
  std::vector<int> order_;            // triangles by their lowest corner
  std::vector<int> active_;           // those that reach the present row
  size_t next_ = 0;                   // in order_
  std::vector<double> crossings_;
  std::vector<Interval> covered_;
};

void check_view(const Points& polygon, const Vec3& normal) {
  if (polygon.cols() < 3) throw InputError("a polygon needs at least three corners");
  if (!(normal.norm() > 0)) throw InputError("the normal along which to project is zero");
}

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
                             const Vec3& normal, int finest) {
  check_view(polygon, normal);
  // Seen from the polygon's first corner, so that a mesh far from the origin keeps its digits.
  const Vec3 origin = polygon.col(0);
  const auto axes = view_axes(normal);
  const Plan plan = projected(points.colwise() - origin, axes);
  const Plan outline = projected(polygon.colwise() - origin, axes);
  Sweep sweep(plan, triangles, outline);
  UncoveredArea result = sweep.areas(1);
  if (!(result.polygon_area > 0)) throw InputError("the polygon has no area along the normal");
  for (int refinement = 2; refinement <= finest; refinement *= 2) {
    const double before = result.area;
    result = sweep.areas(refinement);
    result.error = std::abs(result.area - before);
    if (result.error <= kTolerance * result.polygon_area) break;
  }
  return result;
}

UncoveredAreaGradient uncovered_area_gradient(const Points& points, const Triangles& triangles,
                                              const Points& polygon, const Vec3& normal) {
  check_view(polygon, normal);
  const Vec3 origin = polygon.col(0);
  const auto axes = view_axes(normal);
  const Plan plan = projected(points.colwise() - origin, axes);
  const Plan outline = projected(polygon.colwise() - origin, axes);
  PlanGradient gradient{Plan::Zero(2, points.cols()), Plan::Zero(2, polygon.cols()), true};
  const UncoveredArea area = Sweep(plan, triangles, outline).areas(kGradientRefinement, &gradient);
  if (!(area.polygon_area > 0)) throw InputError("the polygon has no area along the normal");
  const Plan turned_plan = turned(plan), turned_outline = turned(outline);
  PlanGradient other{Plan::Zero(2, points.cols()), Plan::Zero(2, polygon.cols()), false};
  Sweep(turned_plan, triangles, turned_outline).areas(kGradientRefinement, &other);
  Eigen::Matrix<double, 3, 2> turned_axes;
  turned_axes << axes.col(1), -axes.col(0);
  return {axes * gradient.by_points + turned_axes * other.by_points,
          axes * gradient.by_polygon + turned_axes * other.by_polygon};
}

}  // namespace coapt
