#include "valve/generators/mitral_annulus.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace coapt {
namespace {

constexpr int kFewestPoints = 8, kMostPoints = 20000;
constexpr double kSmallest = 10, kLargest = 80;  // of the extents in the plane [mm]
constexpr double kRound = 0.95;                  // ratio of the axes from which on there is no short one
constexpr double kLeastAsymmetry = 0.02;         // of the ends of the short axis, in parts of its extent
constexpr double kFlattest = 0.2;                // beyond, the smooth outline is not convex
constexpr double kLeastSaddle = 0.02;            // height of the saddle in parts of the long extent

using Point2 = Eigen::Vector2d;
using Points2 = Eigen::Matrix2Xd;

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }

// Corners that differ from the one before, the first one included.
Points different_corners(const Points& points) {
  Points corners(3, points.cols());
  Eigen::Index count = 0;
  for (Eigen::Index k = 0; k < points.cols(); ++k)
    if (points.col(k) != points.col((k + points.cols() - 1) % points.cols()) || points.cols() == 1)
      corners.col(count++) = points.col(k);
  return corners.leftCols(count);
}

Vec3 vector_area(const Points& x) {
  const Vec3 first = x.col(0);
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index k = 0; k < x.cols(); ++k)
    sum += 0.5 * Vec3(x.col(k) - first).cross(Vec3(x.col((k + 1) % x.cols()) - first));
  return sum;
}

// Centroid and second moments of the area within a closed polygon of two coordinates.
struct AreaMoments {
  Point2 centroid = Point2::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();  // about the centroid [length^4]
};

AreaMoments area_moments(const Points2& x) {
  AreaMoments moments;
  const auto triangles = [&](const Point2& about, auto&& add) {
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      const Point2 a = x.col(k) - about, b = x.col((k + 1) % x.cols()) - about;
      add(a, b, 0.5 * cross(a, b));
    }
  };
  double area = 0;
  Point2 first = Point2::Zero();
  triangles(x.col(0), [&](const Point2& a, const Point2& b, double part) {
    area += part;
    first += part * (a + b) / 3;
  });
  moments.centroid = x.col(0) + first / area;
  triangles(moments.centroid, [&](const Point2& a, const Point2& b, double part) {
    const Point2 sum = a + b;
    moments.second += part / 12 * (a * a.transpose() + b * b.transpose() + sum * sum.transpose());
  });
  return moments;
}

// Do the closed segments ab and cd have a point in common? Those along one line do where they overlap.
bool meet(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
  const double ca = cross(b - a, c - a), da = cross(b - a, d - a), ac = cross(d - c, a - c),
               bc = cross(d - c, b - c);
  if (ca == 0 && da == 0)
    return std::max(std::min(a.x(), b.x()), std::min(c.x(), d.x())) <=
               std::min(std::max(a.x(), b.x()), std::max(c.x(), d.x())) &&
           std::max(std::min(a.y(), b.y()), std::min(c.y(), d.y())) <=
               std::min(std::max(a.y(), b.y()), std::max(c.y(), d.y()));
  return ca * da <= 0 && ac * bc <= 0;
}

// The first pair of sides without a common corner that meet; each side by its first corner.
std::optional<std::pair<Eigen::Index, Eigen::Index>> crossing(const Points2& x) {
  const Eigen::Index n = x.cols();
  for (Eigen::Index i = 0; i + 2 < n; ++i)
    for (Eigen::Index j = i + 2; j < n; ++j) {
      if (i == 0 && j == n - 1) continue;
      if (meet(x.col(i), x.col(i + 1), x.col(j), x.col((j + 1) % n))) return std::pair{i, j};
    }
  return std::nullopt;
}

// The fitted curve while it is being made.
class Fit {
 public:
  Fit(Points corners, const AnnulusSides& sides, const std::string& name)
      : x_(std::move(corners)), sides_(sides), name_(name) {}

  MitralAnnulus fit(double commissure_angle) {
    lay_plane();
    find_axes();
    throw_if_any();
    turn_to_frame();
    cut_at_commissures(commissure_angle * std::numbers::pi / 180);
    throw_if_any();
    return std::move(result_);
  }

 private:
  void refuse(const std::string& reason) { defects_.push_back(name_ + ": " + reason); }
  void throw_if_any() const {
    if (!defects_.empty()) throw InputError(defects_);
  }

  // Some right-handed frame with the vector area along its third axis; z_ is turned to the atrium later.
  void lay_plane() {
    const Vec3 area = vector_area(x_);
    const double least = 1e-6 * (x_.colwise() - x_.col(0)).colwise().squaredNorm().maxCoeff();
    if (!(area.norm() > least)) {
      refuse("the curve encloses no area");
      throw_if_any();
    }
    z_ = area.normalized();
    first_ = z_.unitOrthogonal();
    second_ = z_.cross(first_);
    planar_.resize(2, x_.cols());
    planar_.row(0) = first_.transpose() * (x_.colwise() - x_.col(0));
    planar_.row(1) = second_.transpose() * (x_.colwise() - x_.col(0));
    if (const auto pair = crossing(planar_))
      refuse("the curve crosses itself in its plane: its sides behind points " +
             std::to_string(pair->first + 1) + " and " + std::to_string(pair->second + 1) + " meet");
    const AreaMoments moments = area_moments(planar_);
    centroid_ = x_.col(0) + moments.centroid.x() * first_ + moments.centroid.y() * second_;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(moments.second);
    ratio_ = std::sqrt(std::max(0.0, solver.eigenvalues()[0]) / solver.eigenvalues()[1]);
    short_ = solver.eigenvectors()(0, 0) * first_ + solver.eigenvectors()(1, 0) * second_;
    const auto [low, high] = extent(short_);
    const auto [left, right] = extent(z_.cross(short_));
    const double least_extent = std::min(high - low, right - left),
                 greatest = std::max(high - low, right - left);
    if (least_extent < kSmallest || greatest > kLargest)
      refuse("is " + number_text(greatest) + " by " + number_text(least_extent) +
             " mm in its plane; a mitral annulus has 10 to 80 mm (are its positions in mm?)");
  }

  // Ends of the curve along a direction, from the centroid [mm].
  std::pair<double, double> extent(const Vec3& direction) const {
    const Eigen::RowVectorXd along = direction.transpose() * (x_.colwise() - centroid_);
    return {along.minCoeff(), along.maxCoeff()};
  }

  double height_at_end(const Vec3& direction) const {
    Eigen::Index end = 0;
    (direction.transpose() * (x_.colwise() - centroid_)).maxCoeff(&end);
    return z_.dot(x_.col(end) - centroid_);
  }

  void find_axes() {
    y_ = short_;
    if (sides_.anterior) {
      const Vec3 to = *sides_.anterior - centroid_, flat = to - z_.dot(to) * z_;
      if (!(flat.norm() > 1e-3 * kSmallest))
        refuse("the anterior position lies on the axis of the annulus; give one beside it");
      else
        y_ = flat.normalized();
    } else {
      const auto [low, high] = extent(short_);
      if (ratio_ > kRound)
        refuse("is too round to tell its anterior side; give a position there (--anterior X Y Z)");
      else if (std::abs(high + low) < kLeastAsymmetry * (high - low))
        refuse("no side is flatter than the other; give a position on the anterior side (--anterior X Y Z)");
      if (high > -low) y_ = -short_;  // the nearer end is anterior
    }
    const Vec3 across = z_.cross(y_);
    if (sides_.ventricle) {
      const double depth = z_.dot(*sides_.ventricle - centroid_);
      if (std::abs(depth) < 1e-3 * kSmallest)
        refuse("the position on the side of the ventricle lies in the plane of the annulus");
      if (depth > 0) z_ = -z_;
      return;
    }
    const auto [left, right] = extent(across);
    const double saddle =
        0.5 * (height_at_end(y_) + height_at_end(-y_) - height_at_end(across) - height_at_end(-across));
    if (std::abs(saddle) < kLeastSaddle * (right - left))
      refuse(
          "is too flat to tell the side of the ventricle; give a position there (--ventricle X Y Z) or "
          "papillary "
          "tips (--papillary FILE)");
    if (saddle < 0) z_ = -z_;
  }

  void turn_to_frame() {
    const Vec3 x = y_.cross(z_);
    const auto [posterior, anterior] = extent(y_);
    const auto [left, right] = extent(x);
    const auto [low, high] = extent(z_);
    result_.axes << x, y_, z_;
    result_.origin =
        centroid_ + 0.5 * (left + right) * x - 0.5 * (anterior + posterior) * y_ + 0.5 * (low + high) * z_;
    result_.commissural_diameter = right - left;
    result_.anteroposterior_diameter = anterior - posterior;
    result_.height = high - low;
    result_.flatness =
        std::clamp(-2 * (anterior + posterior) / (anterior - posterior), -kFlattest, kFlattest);
    x_ = result_.axes.transpose() * (x_.colwise() - result_.origin).eval();
    if (vector_area(x_).z() < 0) x_ = x_.rowwise().reverse().eval();
  }

  // Where the ray from the origin leaves the polygon: the side and the part of it. Nothing where it never
  // meets.
  std::optional<std::pair<Eigen::Index, double>> exit(const Point2& direction) const {
    std::optional<std::pair<Eigen::Index, double>> result;
    double farthest = 0;
    for (Eigen::Index k = 0; k < x_.cols(); ++k) {
      const Point2 a = x_.col(k).head<2>(), edge = x_.col((k + 1) % x_.cols()).head<2>() - a;
      const double determinant = cross(direction, edge);
      if (determinant == 0) continue;
      const double along = cross(a, edge) / determinant, part = cross(a, direction) / determinant;
      if (part < 0 || part >= 1 || along <= farthest) continue;
      farthest = along;
      result = {k, part};
    }
    return result;
  }

  // The commissures of the smooth annulus (mitral_shape.cpp) with the diameters and flatness of this one lie
  // on the rays.
  void cut_at_commissures(double angle) {
    const double a = result_.commissural_diameter / 2, b = result_.anteroposterior_diameter / 2;
    const Point2 ray(a * std::cos(angle), b * (std::sin(angle) + result_.flatness * std::cos(2 * angle)));
    const auto first = exit(ray), second = exit({-ray.x(), ray.y()});
    if (!first || !second || *first == *second)
      return refuse("the curve does not run around its middle, where the leaflets hang");
    const Eigen::Index n = x_.cols();
    std::vector<Vec3> corners;
    const auto corner = [&](const std::pair<Eigen::Index, double>& place) -> Vec3 {
      return x_.col(place.first) + place.second * (x_.col((place.first + 1) % n) - x_.col(place.first));
    };
    // Corners strictly behind `from` up to `to`, in the direction of the polygon.
    const auto add = [&](const std::pair<Eigen::Index, double>& from,
                         const std::pair<Eigen::Index, double>& to) {
      corners.push_back(corner(from));
      const bool wraps = to < from;
      const Eigen::Index last = to.first + (wraps ? n : 0);
      for (Eigen::Index k = from.first + 1; k <= last; ++k)
        if (k < last || to.second > 0) corners.push_back(x_.col(k % n));
    };
    add(*first, *second);
    result_.second_commissure = static_cast<int>(corners.size());
    add(*second, *first);
    result_.curve.resize(3, static_cast<Eigen::Index>(corners.size()));
    result_.lengths = {0};
    for (size_t k = 0; k < corners.size(); ++k) {
      result_.curve.col(static_cast<Eigen::Index>(k)) = corners[k];
      result_.lengths.push_back(result_.lengths.back() +
                                (corners[(k + 1) % corners.size()] - corners[k]).norm());
    }
  }

  Points x_;
  const AnnulusSides& sides_;
  const std::string& name_;
  Vec3 first_ = Vec3::Zero(), second_ = Vec3::Zero(), short_ = Vec3::Zero(), y_ = Vec3::Zero(),
       z_ = Vec3::Zero(), centroid_ = Vec3::Zero();
  Points2 planar_;
  double ratio_ = 0;
  MitralAnnulus result_;
  std::vector<std::string> defects_;
};

}  // namespace

Vec3 MitralAnnulus::point(bool is_anterior, double fraction) const {
  const size_t middle = static_cast<size_t>(second_commissure), last = lengths.size() - 1;
  const double from = is_anterior ? 0 : lengths[middle], to = is_anterior ? lengths[middle] : lengths[last];
  const double place = from + std::clamp(fraction, 0.0, 1.0) * (to - from);
  const auto next = std::upper_bound(lengths.begin() + 1, lengths.end() - 1, place);
  const double share = (place - *(next - 1)) / (*next - *(next - 1));  // no two corners fall together
  const Eigen::Index k = next - lengths.begin() - 1;
  return curve.col(k) + share * (curve.col((k + 1) % curve.cols()) - curve.col(k));
}

MitralAnnulus fit_mitral_annulus(const Points& points, const AnnulusSides& sides, double commissure_angle,
                                 const std::string& name) {
  const bool is_finite = points.allFinite() && (!sides.anterior || sides.anterior->allFinite()) &&
                         (!sides.ventricle || sides.ventricle->allFinite());
  if (!is_finite)
    throw InputError(name + ": all positions of the curve and of its sides must be finite numbers");
  const Points corners = different_corners(points);
  if (corners.cols() > kMostPoints)
    throw InputError(name + ": has " + std::to_string(corners.cols()) + " points; at most " +
                     std::to_string(kMostPoints) + " are taken");
  if (corners.cols() < kFewestPoints)
    throw InputError(name + ": has " + std::to_string(corners.cols()) +
                     " different points; an annulus takes at least " + std::to_string(kFewestPoints));
  return Fit(corners, sides, name).fit(commissure_angle);
}

}  // namespace coapt
