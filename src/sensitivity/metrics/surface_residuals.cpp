#include "sensitivity/metrics/surface_residuals.hpp"

#include "core/error.hpp"
#include "mesh/vertex_graph.hpp"
#include "sensitivity/detail/facing_surface.hpp"

#include <array>
#include <cmath>
#include <set>

namespace coapt {
namespace {

// The vertices of a surface with their shares of its area.
struct Shares {
  std::vector<int> nodes;
  Vector roots;

  Eigen::Index count() const { return roots.size(); }
  int node(Eigen::Index k) const { return nodes[static_cast<size_t>(k)]; }
};

// The numbers of a vertex' neighbours and their neighbours in `shares`, itself included.
std::vector<std::vector<Eigen::Index>> patches_of(const Shares& shares, const Triangles& triangles) {
  std::vector<std::vector<Eigen::Index>> patches;
  if (shares.nodes.empty()) return patches;
  const int last = shares.nodes.back();
  std::vector<Eigen::Index> number(static_cast<size_t>(last) + 1, -1);
  for (Eigen::Index k = 0; k < shares.count(); ++k) number[static_cast<size_t>(shares.node(k))] = k;
  const VertexGraph graph = vertex_graph(triangles, last + 1);
  for (const int node : shares.nodes) {
    std::set<Eigen::Index> patch;
    for (const int first : graph.of(node))
      for (const int second : graph.of(first)) patch.insert(number[static_cast<size_t>(second)]);
    patches.emplace_back(patch.begin(), patch.end());
  }
  return patches;
}

Shares shares_of(const Points& x, const Triangles& triangles) {
  const Vector areas = nodal_areas(x, triangles);
  Shares shares;
  for (int v = 0; v < areas.size(); ++v)
    if (areas[v] > 0) shares.nodes.push_back(v);
  shares.roots = (areas(shares.nodes) / areas.sum()).cwiseSqrt();
  return shares;
}

class SurfaceResiduals final : public MeasuredResiduals {
 public:
  SurfaceResiduals(const Triangles& triangles, const Points& x, const TriangleMesh& target, FitSides sides)
      : triangles_(triangles),
        target_(target),
        target_surface_(target_.vertices, target_.triangles),
        target_normals_(vertex_normals(target_.vertices, target_.triangles)) {
    Shares all = shares_of(x, triangles_);
    facing_ = target_surface_.orientation_of(x, vertex_normals(x, triangles_), nodal_areas(x, triangles_));
    const double share = sides == FitSides::Both ? std::sqrt(0.5) : 1;
    if (sides != FitSides::Target) {
      own_ = std::move(all);
      own_.roots *= share;
    }
    if (sides != FitSides::Surface) {
      of_target_ = shares_of(target_.vertices, target_.triangles);
      of_target_.roots *= share;
    }
  }

  Vector values(const Points& x) const override {
    Vector r(3 * (own_.count() + of_target_.count()));
    each_own(x, [&](Eigen::Index k, int node, double root, const ClosestPoint& closest) {
      r.segment<3>(3 * k) = root * (x.col(node) - closest.point);
    });
    each_of_target(x, [&](Eigen::Index k, const Vec3& p, double root, const ClosestPoint& closest) {
      r.segment<3>(3 * k) = root * (p - closest.point);
    });
    return r;
  }

  // Of the vector from the closest point c to p, with the motion m of the corners of its facet,
  //   d(p - c) = -A sum_k w_k m_k - sum_k grad w_k ((p - c).m_k):
  // what p does not follow, and the turning of the facet or the edge.
  Eigen::MatrixXd derivatives(const Points& x, const std::vector<Points>& motions) const override {
    Eigen::MatrixXd rows(3 * (own_.count() + of_target_.count()), static_cast<Eigen::Index>(motions.size()));
    each_own(x, [&](Eigen::Index k, int node, double root, const ClosestPoint& closest) {
      for (size_t j = 0; j < motions.size(); ++j)
        rows.block<3, 1>(3 * k, static_cast<Eigen::Index>(j)) = root * closest.away * motions[j].col(node);
    });
    each_of_target(x, [&](Eigen::Index k, const Vec3& p, double root, const ClosestPoint& closest) {
      const std::array<Eigen::Matrix3d, 3> blocks = corner_blocks(p, root, closest);
      for (size_t j = 0; j < motions.size(); ++j) {
        Vec3 sum = Vec3::Zero();
        for (size_t c = 0; c < 3; ++c) sum += blocks[c] * motions[j].col(closest.corners[c]);
        rows.block<3, 1>(3 * k, static_cast<Eigen::Index>(j)) = sum;
      }
    });
    return rows;
  }

  Points pull_back(const Points& x, const Vector& weights) const override {
    Points sum = Points::Zero(3, x.cols());
    each_own(x, [&](Eigen::Index k, int node, double root, const ClosestPoint& closest) {
      sum.col(node) += root * closest.away * weights.segment<3>(3 * k);
    });
    each_of_target(x, [&](Eigen::Index k, const Vec3& p, double root, const ClosestPoint& closest) {
      const std::array<Eigen::Matrix3d, 3> blocks = corner_blocks(p, root, closest);
      for (size_t c = 0; c < 3; ++c)
        sum.col(closest.corners[c]) += blocks[c].transpose() * weights.segment<3>(3 * k);
    });
    return sum;
  }

  // From both sides the same target is seen twice.
  int repetitions() const override { return own_.count() > 0 && of_target_.count() > 0 ? 2 : 1; }

  Vector patch_sums(const Vector& numbers) const override {
    Vector sums(numbers.size());
    Eigen::Index k = 0, first = 0;
    const auto add = [&](const Shares& shares, const Triangles& triangles) {
      for (const std::vector<Eigen::Index>& patch : patches_of(shares, triangles)) {
        Vec3 sum = Vec3::Zero();
        for (const Eigen::Index member : patch) sum += numbers.segment<3>(3 * (first + member));
        sums.segment<3>(3 * k++) = sum / std::sqrt(static_cast<double>(patch.size()));
      }
      first += shares.count();
    };
    add(own_, triangles_);
    add(of_target_, target_.triangles);
    return sums;
  }

  Vector noise_factors() const override {
    Vector factors(3 * (own_.count() + of_target_.count()));
    Eigen::Index k = 0;
    for (const Shares* shares : {&own_, &of_target_})
      for (const double root : shares->roots) factors.segment<3>(3 * k++).setConstant(root);
    return factors;
  }

 private:
  // Of the residual of a target's vertex, by the motion of each corner.
  static std::array<Eigen::Matrix3d, 3> corner_blocks(const Vec3& p, double root,
                                                      const ClosestPoint& closest) {
    std::array<Eigen::Matrix3d, 3> blocks;
    for (int c = 0; c < 3; ++c)
      blocks[static_cast<size_t>(c)] = -root * (closest.weights[c] * closest.away +
                                                closest.slopes.col(c) * (p - closest.point).transpose());
    return blocks;
  }

  template <typename Visit>
  void each_own(const Points& x, const Visit& visit) const {
    if (own_.count() == 0) return;
    const Points normals = vertex_normals(x, triangles_);
    for (Eigen::Index k = 0; k < own_.count(); ++k) {
      const int node = own_.node(k);
      visit(k, node, own_.roots[k], target_surface_.closest(x.col(node), facing_ * normals.col(node)));
    }
  }

  template <typename Visit>
  void each_of_target(const Points& x, const Visit& visit) const {
    if (of_target_.count() == 0) return;
    const FacingSurface surface(x, triangles_);
    for (Eigen::Index k = 0; k < of_target_.count(); ++k) {
      const int vertex = of_target_.node(k);
      const Vec3 p = target_.vertices.col(vertex);
      visit(own_.count() + k, p, of_target_.roots[k],
            surface.closest(p, facing_ * target_normals_.col(vertex)));
    }
  }

  Triangles triangles_;
  TriangleMesh target_;
  FacingSurface target_surface_;
  Points target_normals_;
  Shares own_, of_target_;
  double facing_ = 1;  // of the target's normals
};

}  // namespace

std::unique_ptr<MeasuredResiduals> make_surface_residuals(const Triangles& triangles, const Points& x_weights,
                                                          const TriangleMesh& target, FitSides sides) {
  std::vector<std::string> defects;
  if (!(surface_area(x_weights, triangles) > 0))
    defects.emplace_back("surface residuals: the surface has no area");
  if (target.triangle_count() == 0 || !target.vertices.allFinite())
    defects.emplace_back("surface residuals: the target has no triangle, or a vertex that is not finite");
  else if (!(surface_area(target.vertices, target.triangles) > 0))
    defects.emplace_back("surface residuals: the target has no area");
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<SurfaceResiduals>(triangles, x_weights, target, sides);
}

}  // namespace coapt
