#include "energy/contact_facet.hpp"

#include "core/error.hpp"
#include "energy/term_access.hpp"
#include "mesh/triangle_mesh.hpp"

#ifdef COAPT_HAS_NANOFLANN
#include <nanoflann.hpp>
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace coapt {

double contact_facet_capacity(double strength, double range, int exponent) {
  const double n = exponent;
  return 2 * std::numbers::pi * strength * range * std::pow(n, n) / std::pow(n + 1, n + 1);
}

double contact_facet_strength(double pressure, double range, int exponent, double margin) {
  return margin * pressure / contact_facet_capacity(1, range, exponent);
}

#ifndef COAPT_HAS_NANOFLANN

std::unique_ptr<EnergyTerm> make_contact_facet(std::string name, const Points&, const Triangles&,
                                               const ContactFacetOptions&) {
  throw InputError("term \"" + name +
                   "\": contact_facet needs nanoflann, which this build was made without; install "
                   "libnanoflann-dev and configure again with -DCOAPT_WITH_NANOFLANN=ON");
}

std::vector<FacetContact> facet_contacts(const EnergyTerm&, const Points&) { return {}; }

#else

namespace {

struct QuadraturePoint {
  Vec3 barycentric;
  double weight;  // share of the facet's area
};

// Symmetric rules on the triangle: centroid; three points (degree 2, Strang & Fix 1973); six points
// (degree 4, Dunavant 1985), each applied to subdivision^2 congruent parts.
std::vector<QuadraturePoint> quadrature_rule(int points, int subdivision) {
  std::vector<QuadraturePoint> base;
  const auto add_orbit = [&](double a, double weight) {  // barycentric (1 - 2a, a, a) and its turns
    for (int k = 0; k < 3; ++k) {
      Vec3 b(a, a, a);
      b[k] = 1 - 2 * a;
      base.push_back({b, weight});
    }
  };
  if (points == 1) {
    base.push_back({Vec3::Constant(1.0 / 3), 1});
  } else if (points == 3) {
    add_orbit(1.0 / 6, 1.0 / 3);
  } else {
    add_orbit(0.445948490915965, 0.223381589678011);
    add_orbit(0.091576213509771, 0.109951743655322);
  }
  std::vector<QuadraturePoint> rule;
  const double s = subdivision;
  const auto add_part = [&](const Vec3& p0, const Vec3& p1, const Vec3& p2) {
    for (const QuadraturePoint& q : base)
      rule.push_back(
          {q.barycentric[0] * p0 + q.barycentric[1] * p1 + q.barycentric[2] * p2, q.weight / (s * s)});
  };
  const auto corner = [&](int i, int j) { return Vec3((s - i - j) / s, i / s, j / s); };
  for (int i = 0; i < subdivision; ++i)
    for (int j = 0; i + j < subdivision; ++j) {
      add_part(corner(i, j), corner(i + 1, j), corner(i, j + 1));
      if (i + j < subdivision - 1) add_part(corner(i + 1, j + 1), corner(i, j + 1), corner(i + 1, j));
    }
  return rule;
}

// For each facet the facets that share a vertex with it or are joined to it by an edge, ascending.
std::vector<std::vector<int>> topological_neighbours(const Triangles& triangles, int node_count) {
  std::vector<std::vector<int>> around(node_count);
  for (int t = 0; t < triangles.cols(); ++t)
    for (int k = 0; k < 3; ++k) around[triangles(k, t)].push_back(t);
  std::vector<std::vector<int>> neighbours(triangles.cols());
  const auto make_unique = [](std::vector<int>& list) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  };
  std::vector<int> ring;  // the facet's vertices and those joined to them by an edge
  for (int t = 0; t < triangles.cols(); ++t) {
    ring.clear();
    for (int k = 0; k < 3; ++k)
      for (int adjacent : around[triangles(k, t)])
        for (int c = 0; c < 3; ++c) ring.push_back(triangles(c, adjacent));
    make_unique(ring);
    for (int node : ring) neighbours[t].insert(neighbours[t].end(), around[node].begin(), around[node].end());
    make_unique(neighbours[t]);
  }
  return neighbours;
}

struct CentroidCloud {
  Points points;
  size_t kdtree_get_point_count() const { return static_cast<size_t>(points.cols()); }
  double kdtree_get_pt(size_t index, size_t dimension) const {
    return points(static_cast<Eigen::Index>(dimension), static_cast<Eigen::Index>(index));
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

double power(double base, int exponent) {
  double result = 1;
  for (int k = 0; k < exponent; ++k) result *= base;
  return result;
}

class ContactFacet final : public EnergyTerm, public TermAccess {
 public:
  ContactFacet(std::string name, const Points& X, const Triangles& triangles,
               const ContactFacetOptions& options)
      : EnergyTerm(std::move(name)),
        options_(options),
        triangles_(triangles),
        rule_(quadrature_rule(options.quadrature, options.subdivision)),
        excluded_(topological_neighbours(triangles, static_cast<int>(X.cols()))),
        areas_(triangles.cols()),
        skin_(options.range) {
    stencils_.width = 6;
    for (int t = 0; t < triangles.cols(); ++t) areas_[t] = area_vector(X, triangles.col(t)).norm();
  }

  std::string_view type() const override { return "contact_facet"; }
  TermKind kind() const override { return TermKind::Contact; }
  TermRole role() const override { return TermRole::Contact; }
  const Stencils& stencils() const override { return stencils_; }
  TermCounters counters() const override { return {active_pairs_, stencils_.count(), searches_}; }

  // A pair can come within range only after its nodes have moved by half the skin each.
  bool prepare(const Points& x) override {
    if (searched_at_.size() != 0 &&
        (x - searched_at_).colwise().squaredNorm().maxCoeff() <= 0.25 * skin_ * skin_)
      return false;
    search(x);
    return true;
  }

  double evaluate(const Points& x, Sink& sink) const override {
    const Spheres spheres = bounding_spheres(x);
    double energy = 0;
    active_pairs_ = 0;
    for (size_t pair = 0; pair < pairs_.size(); ++pair) {
      const auto [j, k] = pairs_[pair];
      const double reach = options_.range + spheres.radii[j] + spheres.radii[k];
      if ((spheres.centres.col(j) - spheres.centres.col(k)).squaredNorm() > 1.001 * reach * reach) continue;
      energy += evaluate_pair(x, static_cast<long>(pair), sink);
    }
    return energy;
  }

  std::vector<FacetContact> contacts(const Points& x) const {
    std::vector<FacetContact> found;
    for (const auto& [j, k] : pairs_) {
      const auto corners = [&](int t) { return Eigen::Matrix3d(x(Eigen::all, triangles_.col(t))); };
      const Eigen::Matrix3d on_j = corners(j), on_k = corners(k);
      FacetContact contact{j, k, 0, options_.exponent > 2};
      for (const QuadraturePoint& p : rule_)
        for (const QuadraturePoint& q : rule_)
          contact.point_pairs += (on_j * p.barycentric - on_k * q.barycentric).norm() < options_.range;
      if (contact.point_pairs > 0) found.push_back(contact);
    }
    return found;
  }

 private:
  struct Pair {
    int j, k;
  };
  struct Spheres {
    Points centres;
    Vector radii;
  };

  // Around each facet's centroid: a cheap way to see that two facets are out of range.
  Spheres bounding_spheres(const Points& x) const {
    Spheres spheres{Points(3, triangles_.cols()), Vector(triangles_.cols())};
    for (int t = 0; t < triangles_.cols(); ++t) {
      const Vec3 a = x.col(triangles_(0, t)), b = x.col(triangles_(1, t)), c = x.col(triangles_(2, t));
      const Vec3 centroid = (a + b + c) / 3;
      spheres.centres.col(t) = centroid;
      spheres.radii[t] = std::sqrt(std::max(
          {(a - centroid).squaredNorm(), (b - centroid).squaredNorm(), (c - centroid).squaredNorm()}));
    }
    return spheres;
  }

  void search(const Points& x) {
    ++searches_;
    searched_at_ = x;
    const Spheres spheres = bounding_spheres(x);
    const CentroidCloud cloud{spheres.centres};
    const Vector& radius = spheres.radii;
    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, CentroidCloud>,
                                                     CentroidCloud, 3>;
    const Tree tree(3, cloud);
    const double reach = options_.range + skin_;
    const double largest = radius.maxCoeff();
    pairs_.clear();
    std::vector<std::pair<std::uint32_t, double>> found;
    for (int j = 0; j < triangles_.cols(); ++j) {
      const double search_radius = reach + radius[j] + largest;
      tree.radiusSearch(cloud.points.col(j).data(), search_radius * search_radius, found,
                        nanoflann::SearchParams(0, 0, false));
      for (const auto& [index, distance_squared] : found) {
        const int k = static_cast<int>(index);
        const double limit = reach + radius[j] + radius[k];
        if (k <= j || distance_squared >= limit * limit) continue;
        if (std::binary_search(excluded_[j].begin(), excluded_[j].end(), k)) continue;
        pairs_.push_back({j, k});
      }
    }
    // One order whatever the tree's: sums then do not depend on when the list was made.
    std::sort(pairs_.begin(), pairs_.end(),
              [](const Pair& l, const Pair& r) { return l.j != r.j ? l.j < r.j : l.k < r.k; });
    stencils_.nodes.clear();
    stencils_.nodes.reserve(6 * pairs_.size());
    for (const Pair& pair : pairs_) {
      for (int c = 0; c < 3; ++c) stencils_.nodes.push_back(triangles_(c, pair.j));
      for (int c = 0; c < 3; ++c) stencils_.nodes.push_back(triangles_(c, pair.k));
    }
  }

  double evaluate_pair(const Points& x, long pair, Sink& sink) const {
    const int* nodes = &stencils_.nodes[6 * static_cast<size_t>(pair)];
    Eigen::Matrix<double, 3, 6> corners;
    for (int c = 0; c < 6; ++c) corners.col(c) = x.col(nodes[c]);
    const double range = options_.range;
    const int n = options_.exponent;
    const double scale = options_.strength * areas_[pairs_[pair].j] * areas_[pairs_[pair].k];

    double energy = 0;
    bool is_active = false;
    Eigen::Matrix<double, 3, 6> g = Eigen::Matrix<double, 3, 6>::Zero();
    Eigen::Matrix<double, 18, 18> h;
    for (const QuadraturePoint& p : rule_) {
      const Vec3 on_j = corners.leftCols<3>() * p.barycentric;
      for (const QuadraturePoint& q : rule_) {
        const Vec3 difference = on_j - corners.rightCols<3>() * q.barycentric;
        const double squared = difference.squaredNorm();
        if (squared >= range * range) continue;
        if (!is_active) {
          is_active = true;
          if (sink.wants_hessian()) h.setZero();
        }
        const double d = std::sqrt(squared), u = 1 - d / range;
        const double weight = scale * p.weight * q.weight;
        energy += weight * power(u, n);
        if (!sink.wants_gradient() || d == 0) continue;  // coincident points have no direction
        Eigen::Vector<double, 6> share;
        share << p.barycentric, -q.barycentric;
        const Vec3 direction = difference / d;
        const double slope = -weight * n / range * power(u, n - 1);
        g += slope * direction * share.transpose();
        if (!sink.wants_hessian()) continue;
        const double curvature = weight * n * (n - 1) / (range * range) * power(u, n - 2);
        const Eigen::Matrix3d along = direction * direction.transpose();
        Eigen::Matrix3d block = curvature * along;
        if (sink.projection() == Projection::None)  // the rest is negative: repulsion softens sideways
          block += slope / d * (Eigen::Matrix3d::Identity() - along);
        for (int a = 0; a < 6; ++a)
          for (int b = 0; b < 6; ++b) h.block<3, 3>(3 * a, 3 * b) += share[a] * share[b] * block;
      }
    }
    if (!is_active) return 0;
    ++active_pairs_;
    if (sink.wants_gradient())
      for (int c = 0; c < 6; ++c) sink.add_gradient(nodes[c], g.col(c));
    if (sink.wants_hessian())
      for (int a = 0; a < 6; ++a)
        for (int b = 0; b < 6; ++b) sink.add_block(36 * pair, 6, a, b, h.block<3, 3>(3 * a, 3 * b));
    return energy;
  }

  ContactFacetOptions options_;
  Triangles triangles_;
  std::vector<QuadraturePoint> rule_;
  std::vector<std::vector<int>> excluded_;
  Vector areas_;  // at rest
  double skin_;
  Stencils stencils_;        // the candidates' nodes
  std::vector<Pair> pairs_;  // the candidates
  Points searched_at_;
  long searches_ = 0;
  mutable long active_pairs_ = 0;  // a counter for reports, never read by an evaluation
};

}  // namespace

std::vector<FacetContact> facet_contacts(const EnergyTerm& term, const Points& x) {
  const auto* contact = dynamic_cast<const ContactFacet*>(&term);
  return contact == nullptr ? std::vector<FacetContact>{} : contact->contacts(x);
}

std::unique_ptr<EnergyTerm> make_contact_facet(std::string name, const Points& X, const Triangles& triangles,
                                               const ContactFacetOptions& options) {
  std::vector<std::string> defects;
  const auto require = [&](bool condition, const std::string& what) {
    if (!condition) defects.push_back("term \"" + name + "\": " + what);
  };
  require(options.range > 0 && std::isfinite(options.range), "range must be positive");
  require(options.strength > 0 && std::isfinite(options.strength), "strength must be positive");
  require(options.exponent >= 2 && options.exponent <= 16, "exponent must be between 2 and 16");
  require(options.quadrature == 1 || options.quadrature == 3 || options.quadrature == 6,
          "quadrature must be 1, 3 or 6");
  require(options.subdivision >= 1 && options.subdivision <= 64, "subdivision must be between 1 and 64");
  if (!defects.empty()) throw InputError(defects);
  return std::make_unique<ContactFacet>(std::move(name), X, triangles, options);
}

#endif

}  // namespace coapt
