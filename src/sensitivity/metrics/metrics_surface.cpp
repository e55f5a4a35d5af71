#include "sensitivity/metrics/metrics_surface.hpp"

#include "core/error.hpp"
#include "mesh/distance/triangle_tree.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

struct RoundedDistance {
  double value;
  Vec3 slope;
};

RoundedDistance distance_to(const TriangleTree& target, const Vec3& p, double rounding) {
  const Vec3 away = p - target.closest(p).point;
  const double root = std::sqrt(away.squaredNorm() + rounding * rounding);
  return {root - rounding, away / root};
}

class SurfaceDistanceMetric final : public Metric {
 public:
  SurfaceDistanceMetric(std::string name, std::vector<int> nodes, Vector shares,
                        std::shared_ptr<const TriangleTree> target, const SurfaceDistanceOptions& options)
      : Metric(std::move(name)),
        nodes_(std::move(nodes)),
        shares_(std::move(shares)),
        target_(std::move(target)),
        options_(options) {}

  double evaluate(const Points& x, Points* gradient) const override {
    if (gradient != nullptr) gradient->setZero(3, x.cols());
    const auto count = static_cast<Eigen::Index>(nodes_.size());
    Vector distance(count);
    Points slope(3, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const RoundedDistance at = distance_to(*target_, x.col(node(k)), options_.rounding);
      distance[k] = at.value;
      slope.col(k) = at.slope;
    }
    Vector weights = shares_;
    double value = shares_.dot(distance);
    if (const double sharp = options_.sharpness; sharp > 0) {
      const double greatest = distance.maxCoeff();
      weights = shares_.array() * (sharp * (distance.array() - greatest)).exp();
      value = greatest + std::log(weights.sum()) / sharp;
      weights /= weights.sum();
    }
    if (gradient != nullptr)
      for (Eigen::Index k = 0; k < count; ++k) gradient->col(node(k)) += weights[k] * slope.col(k);
    return value;
  }

 private:
  int node(Eigen::Index k) const { return nodes_[static_cast<size_t>(k)]; }

  std::vector<int> nodes_;
  Vector shares_;  // of the weight, of each node
  std::shared_ptr<const TriangleTree> target_;
  SurfaceDistanceOptions options_;
};

class DistanceResidual final : public Metric {
 public:
  DistanceResidual(std::string name, int node, double factor, std::shared_ptr<const TriangleTree> target,
                   double rounding)
      : Metric(std::move(name)),
        node_(node),
        factor_(factor),
        target_(std::move(target)),
        rounding_(rounding) {}

  double evaluate(const Points& x, Points* gradient) const override {
    const RoundedDistance at = distance_to(*target_, x.col(node_), rounding_);
    if (gradient != nullptr) {
      gradient->setZero(3, x.cols());
      gradient->col(node_) = factor_ * at.slope;
    }
    return factor_ * at.value;
  }

 private:
  int node_;
  double factor_;
  std::shared_ptr<const TriangleTree> target_;
  double rounding_;
};

// Vertices that carry area, and their shares of it.
struct Samples {
  std::vector<int> nodes;
  Vector shares;
};

Samples samples_of(const std::string& name, const Triangles& triangles, const Points& x,
                   const TriangleMesh& target, double rounding, double sharpness) {
  const std::string where = "metric \"" + name + "\": ";
  std::vector<std::string> defects;
  const Vector areas = nodal_areas(x, triangles);
  if (!(areas.sum() > 0)) defects.push_back(where + "the surface has no area");
  if (target.triangle_count() == 0 || !target.vertices.allFinite())
    defects.push_back(where + "the target has no triangle, or a vertex that is not finite");
  if (!(rounding > 0 && std::isfinite(rounding))) defects.push_back(where + "rounding must be positive");
  if (!(sharpness >= 0 && std::isfinite(sharpness)))
    defects.push_back(where + "sharpness must not be negative");
  if (!defects.empty()) throw InputError(defects);
  Samples samples;
  for (int v = 0; v < areas.size(); ++v)
    if (areas[v] > 0) samples.nodes.push_back(v);
  samples.shares = areas(samples.nodes) / areas.sum();
  return samples;
}

}  // namespace

std::unique_ptr<Metric> make_surface_distance(std::string name, const Triangles& triangles,
                                              const Points& x_weights, const TriangleMesh& target,
                                              const SurfaceDistanceOptions& options) {
  Samples samples = samples_of(name, triangles, x_weights, target, options.rounding, options.sharpness);
  return std::make_unique<SurfaceDistanceMetric>(
      std::move(name), std::move(samples.nodes), std::move(samples.shares),
      std::make_shared<TriangleTree>(target.vertices, target.triangles), options);
}

std::vector<std::unique_ptr<Metric>> make_distance_residuals(const std::string& name,
                                                             const Triangles& triangles,
                                                             const Points& x_weights,
                                                             const TriangleMesh& target, double rounding) {
  const Samples samples = samples_of(name, triangles, x_weights, target, rounding, 0);
  const auto tree = std::make_shared<TriangleTree>(target.vertices, target.triangles);
  std::vector<std::unique_ptr<Metric>> residuals;
  for (size_t k = 0; k < samples.nodes.size(); ++k)
    residuals.push_back(std::make_unique<DistanceResidual>(
        name + "[" + std::to_string(samples.nodes[k]) + "]", samples.nodes[k],
        std::sqrt(samples.shares[static_cast<Eigen::Index>(k)]), tree, rounding));
  return residuals;
}

}  // namespace coapt
