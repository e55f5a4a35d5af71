#include "sensitivity/metrics/metrics_contact.hpp"

#include "core/error.hpp"
#include "mesh/distance/triangle_distance.hpp"
#include "mesh/distance/triangle_tree.hpp"
#include "mesh/triangle_mesh.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <vector>

namespace coapt {
namespace {

constexpr double kBall = 1.5;   // of the range: neighbours at rest
constexpr double kWhole = 0.5;  // of the range: below it a vertex counts wholly

struct Fall {
  double value, slope;
};

// psi and its derivative by s = gap / range.
Fall psi(double s) {
  if (s <= kWhole) return {1, 0};
  if (s >= 1) return {0, 0};
  const double u = (s - kWhole) / (1 - kWhole), v = u * (1 - u);
  return {1 - u * u * u * (10 - 15 * u + 6 * u * u), -30 * v * v / (1 - kWhole)};
}

// Sorted neighbours of each vertex: within two edges, or near at rest.
std::vector<std::vector<int>> neighbours_of(const Triangles& triangles, const Points& X, double radius) {
  std::vector<std::vector<int>> ring(static_cast<size_t>(X.cols())), all = ring;
  for (Eigen::Index t = 0; t < triangles.cols(); ++t)
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) ring[static_cast<size_t>(triangles(a, t))].push_back(triangles(b, t));
  const TriangleTree tree(X, triangles);
  for (size_t v = 0; v < all.size(); ++v) {
    if (ring[v].empty()) continue;
    std::vector<int>& found = all[v];
    for (const int first : ring[v])
      for (const int second : ring[static_cast<size_t>(first)]) found.push_back(second);
    const Vec3 p = X.col(static_cast<Eigen::Index>(v));
    for (const int t : tree.overlapping(bounds_around(p, radius)))
      for (const int corner : triangles.col(t))
        if ((X.col(corner) - p).norm() <= radius) found.push_back(corner);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  }
  return all;
}

class ContactZone final : public Metric {
 public:
  // direction: of the height; zero for the area.
  ContactZone(std::string name, const Triangles& triangles, const Points& X, const Vec3& direction,
              const ContactZoneOptions& options)
      : Metric(std::move(name)),
        triangles_(triangles),
        options_(options),
        direction_(direction),
        neighbours_(neighbours_of(triangles, X, kBall * options.range)) {}

  double evaluate(const Points& x, Points* gradient) const override {
    if (gradient != nullptr) gradient->setZero(3, x.cols());
    const std::vector<Touch> touches = touches_at(x);
    const Vector areas = nodal_areas(x, triangles_);
    Vector weights(static_cast<Eigen::Index>(touches.size())), by_weight = weights, by_height = weights;
    for (Eigen::Index k = 0; k < weights.size(); ++k)
      weights[k] = touch(touches, k).share.value * areas[touch(touches, k).vertex];
    const double value = reduce(x, touches, weights, by_weight, by_height);
    if (gradient == nullptr) return value;
    Vector by_area = Vector::Zero(x.cols());
    for (Eigen::Index k = 0; k < weights.size(); ++k) {
      const Touch& t = touch(touches, k);
      by_area[t.vertex] += by_weight[k] * t.share.value;
      gradient->col(t.vertex) += by_height[k] * direction_;
      const Vec3 pull = by_weight[k] * areas[t.vertex] * t.share.slope / options_.range * t.normal;
      gradient->col(t.vertex) += pull;
      for (int c = 0; c < 3; ++c) gradient->col(triangles_(c, t.triangle)) -= t.weights[c] * pull;
    }
    add_area_gradient(x, by_area, *gradient);
    return value;
  }

 private:
  // A vertex within range of another part of the surface.
  struct Touch {
    int vertex, triangle;
    Vec3 weights, normal;  // of the closest point; from there to the vertex
    Fall share;
  };
  static const Touch& touch(const std::vector<Touch>& touches, Eigen::Index k) {
    return touches[static_cast<size_t>(k)];
  }

  std::vector<Touch> touches_at(const Points& x) const {
    std::vector<Touch> touches;
    const TriangleTree tree(x, triangles_);
    for (int v = 0; v < static_cast<int>(neighbours_.size()); ++v) {
      const std::vector<int>& own = neighbours_[static_cast<size_t>(v)];
      if (own.empty()) continue;
      const Vec3 p = x.col(v);
      double least = options_.range;
      Touch nearest{v, -1, Vec3::Zero(), Vec3::Zero(), {0, 0}};
      std::vector<int> near = tree.overlapping(bounds_around(p, options_.range));
      std::sort(near.begin(), near.end());
      for (const int t : near) {
        const Eigen::Vector3i c = triangles_.col(t);
        if (std::any_of(c.begin(), c.end(),
                        [&](int corner) { return std::binary_search(own.begin(), own.end(), corner); }))
          continue;
        const ClosestOnTriangle found = closest_on_triangle(p, x.col(c[0]), x.col(c[1]), x.col(c[2]));
        const double distance = std::sqrt(found.distance_squared);
        if (!(distance < least)) continue;
        least = distance;
        nearest.triangle = t;
        nearest.weights = found.weights;
        nearest.normal = distance > 0 ? Vec3((p - found.point) / distance) : Vec3(Vec3::Zero());
      }
      if (nearest.triangle < 0) continue;
      nearest.share = psi(least / options_.range);
      touches.push_back(nearest);
    }
    return touches;
  }

  // The metric from weights and heights, with its derivatives by both.
  double reduce(const Points& x, const std::vector<Touch>& touches, const Vector& weights, Vector& by_weight,
                Vector& by_height) const {
    by_height.setZero();
    const double total = weights.sum();
    if (direction_.isZero(0)) {
      by_weight.setOnes();
      return total;
    }
    by_weight.setZero();
    if (!(total > 0)) return 0;
    Vector height(weights.size());
    for (Eigen::Index k = 0; k < height.size(); ++k)
      height[k] = direction_.dot(x.col(touch(touches, k).vertex));
    double value = 0;
    for (const double sign : {1.0, -1.0}) {
      const double b = sign * options_.sharpness, top = (b * height).maxCoeff();
      const Vector grown = (b * height.array() - top).exp();
      const double sum = weights.dot(grown);
      value += (top + std::log(sum / total)) / options_.sharpness;
      by_weight.array() += (grown.array() / sum - 1 / total) / options_.sharpness;
      by_height.array() += sign * weights.array() * grown.array() / sum;
    }
    return value;
  }

  // A third of the gradient of each triangle's area to the areas of its corners.
  void add_area_gradient(const Points& x, const Vector& by_area, Points& gradient) const {
    for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
      const Eigen::Vector3i c = triangles_.col(t);
      const double weight = (by_area[c[0]] + by_area[c[1]] + by_area[c[2]]) / 3;
      if (weight == 0) continue;
      const Vec3 normal = area_vector(x, c).stableNormalized();
      for (int a = 0; a < 3; ++a)
        gradient.col(c[a]) += 0.5 * weight * normal.cross(x.col(c[(a + 2) % 3]) - x.col(c[(a + 1) % 3]));
    }
  }

  Triangles triangles_;
  ContactZoneOptions options_;
  Vec3 direction_;
  std::vector<std::vector<int>> neighbours_;
};

std::unique_ptr<Metric> contact_zone(std::string name, const Triangles& triangles, const Points& X,
                                     const Vec3& direction, const ContactZoneOptions& options) {
  const std::string where = "metric \"" + name + "\": ";
  std::vector<std::string> defects;
  if (!(options.range > 0 && std::isfinite(options.range)))
    defects.push_back(where + "range must be positive, such as 1.5 times the gap of the contact");
  if (!(options.sharpness > 0 && std::isfinite(options.sharpness)))
    defects.push_back(where + "sharpness must be positive");
  if (triangles.cols() == 0) defects.push_back(where + "the surface has no triangle");
  if (!direction.allFinite()) defects.push_back(where + "the direction is not finite");
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<ContactZone>(std::move(name), triangles, X, direction, options);
}

}  // namespace

std::unique_ptr<Metric> make_contact_zone_area(std::string name, const Triangles& triangles, const Points& X,
                                               const ContactZoneOptions& options) {
  return contact_zone(std::move(name), triangles, X, Vec3::Zero(), options);
}

std::unique_ptr<Metric> make_contact_zone_height(std::string name, const Triangles& triangles,
                                                 const Points& X, const Vec3& direction,
                                                 const ContactZoneOptions& options) {
  if (!(direction.norm() > 0))
    throw InputError("metric \"" + name + "\": the direction of the height has no length");
  return contact_zone(std::move(name), triangles, X, direction.normalized(), options);
}

}  // namespace coapt
