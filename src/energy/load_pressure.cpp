#include "energy/load_pressure.hpp"

#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/cross_matrix.hpp"
#include "energy/kernels/facet_volume.hpp"
#include "energy/load_dead.hpp"
#include "energy/moving_part.hpp"
#include "mesh/rim_fan.hpp"
#include "mesh/triangle_mesh.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace coapt {
namespace {

std::vector<int> corner_list(const Triangles& triangles) {
  return {triangles.data(), triangles.data() + triangles.size()};
}

bool is_wholly_fixed(const std::vector<int>& nodes, const FixedMask& fixed) {
  return std::all_of(nodes.begin(), nodes.end(), [&](int node) { return fixed.col(node).all(); });
}

std::vector<std::vector<int>> moving_rims(const Triangles& triangles, const FixedMask& fixed) {
  std::vector<std::vector<int>> loops = boundary_loops(triangles);
  std::erase_if(loops, [&](const auto& loop) { return is_wholly_fixed(loop, fixed); });
  return loops;
}

// An origin for which the potential is right although rims slide: seen from it, every moving rim edge
// spans a triangle within a coordinate plane that the edge cannot leave. Nothing when there is none.
std::optional<Vec3> sliding_origin(const Points& X, const std::vector<std::vector<int>>& rims,
                                   const FixedMask& fixed) {
  Vec3 origin = X.cols() == 0 ? Vec3::Zero() : Vec3(X.rowwise().mean());
  std::array<bool, 3> is_set = {false, false, false};
  const double tolerance = 1e-9 * bounding_box_diagonal(X);
  for (const auto& rim : rims)
    for (size_t k = 0; k < rim.size(); ++k) {
      const int a = rim[k], b = rim[(k + 1) % rim.size()];
      if (fixed.col(a).all() && fixed.col(b).all()) continue;
      bool is_held = false;
      for (int c = 0; c < 3 && !is_held; ++c) {
        if (!fixed(c, a) || !fixed(c, b) || std::abs(X(c, a) - X(c, b)) > tolerance) continue;
        if (is_set[c] && std::abs(origin[c] - X(c, a)) > tolerance) continue;
        origin[c] = X(c, a);
        is_held = is_set[c] = true;
      }
      if (!is_held) return std::nullopt;
    }
  return origin;
}

std::unique_ptr<EnergyTerm> volume_term(std::string name, const Triangles& triangles, double p,
                                        const Vec3& origin) {
  return std::make_unique<ElementTerm<FacetVolume>>(
      std::move(name), corner_list(triangles),
      std::vector<FacetVolume::Rest>(static_cast<size_t>(triangles.cols()), {p, origin}));
}

std::vector<std::array<int, 2>> rim_edges(const std::vector<std::vector<int>>& rims) {
  std::vector<std::array<int, 2>> edges;
  for (const auto& rim : rims)
    for (size_t k = 0; k < rim.size(); ++k) edges.push_back({rim[k], rim[(k + 1) % rim.size()]});
  return edges;
}

// The surface closed by fans over its moving rims carries the potential; the remainder lives on the rims.
class LoadPressureFollower final : public EnergyTerm, public TermAccess {
 public:
  LoadPressureFollower(std::string name, const Points& X, const Triangles& triangles, double p,
                       std::vector<std::vector<int>> rims)
      : EnergyTerm(std::move(name)),
        triangles_(triangles),
        rims_(std::move(rims)),
        edges_(rim_edges(rims_)),
        rest_{p, Vec3(X.rowwise().mean())} {
    set_fans({});
  }

  // Some triangles and rim edges of another, without fans.
  LoadPressureFollower(std::string name, Triangles triangles, std::vector<std::array<int, 2>> edges,
                       const FacetVolume::Rest& rest)
      : EnergyTerm(std::move(name)), triangles_(std::move(triangles)), edges_(std::move(edges)), rest_(rest) {
    set_fans({});
  }

  std::string_view type() const override { return FacetVolume::kType; }
  TermKind kind() const override { return TermKind::Pressure; }
  TermRole role() const override { return TermRole::Load; }
  const Stencils& stencils() const override { return closed_->stencils(); }
  double evaluate(const Points& x, Sink& sink) const override { return closed_->evaluate(x, sink); }
  bool has_circulatory_force() const override { return true; }
  TermCounters counters() const override { return {triangles_.cols(), 0, 0}; }

  // The consistent force of a facet at its corner a is p/6 (b x c + a x b + c x a), that of the potential
  // p/6 (b x c). Summed over the facets the difference cancels on every inner edge and leaves p/6 (a x b)
  // at both ends of each rim edge a -> b. The force on the fans, which no membrane feels, is taken off.
  void add_circulatory_force(const Points& x, Points& force) const override {
    const Vec3& o = rest_.origin;
    const double sixth = rest_.pressure / 6;
    for (const auto& [a, b] : edges_) {
      const Vec3 remainder = sixth * (x.col(a) - o).cross(x.col(b) - o);
      force.col(a) += remainder;
      force.col(b) += remainder;
    }
    for (int t = 0; t < fans_.cols(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int b = fans_((k + 1) % 3, t), c = fans_((k + 2) % 3, t);
        force.col(fans_(k, t)) -= sixth * (x.col(b) - o).cross(x.col(c) - o);
      }
  }

  void add_circulatory_tangent(const Points& x, std::vector<TangentBlock>& blocks) const override {
    const Vec3& o = rest_.origin;
    const double sixth = rest_.pressure / 6;
    // d(u x v)/du = -[v x], d(u x v)/dv = [u x]
    for (const auto& [a, b] : edges_) {
      const Eigen::Matrix3d by_a = -sixth * cross_matrix(x.col(b) - o);
      const Eigen::Matrix3d by_b = sixth * cross_matrix(x.col(a) - o);
      for (const int row : {a, b}) {
        blocks.push_back({row, a, by_a});
        blocks.push_back({row, b, by_b});
      }
    }
    for (int t = 0; t < fans_.cols(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int b = fans_((k + 1) % 3, t), c = fans_((k + 2) % 3, t);
        blocks.push_back({fans_(k, t), b, sixth * cross_matrix(x.col(c) - o)});
        blocks.push_back({fans_(k, t), c, -sixth * cross_matrix(x.col(b) - o)});
      }
  }

  std::optional<double> pressure() const override { return rest_.pressure; }
  void set_pressure(double p) override {
    rest_.pressure = p;
    set_fans({fans_.data(), fans_.data() + fans_.size()});
  }

  bool rebuild_potential(const Points& x) override {
    std::vector<int> fan_corners;
    for (const auto& rim : rims_) {
      if (rim.size() < 3) continue;
      const std::vector<int> fan = corner_list(close_rim(x, rim));
      fan_corners.insert(fan_corners.end(), fan.begin(), fan.end());
    }
    set_fans(fan_corners);
    return true;
  }

  const EnergyTerm& simplest() const override {
    return simplest_ == nullptr ? *this : static_cast<const EnergyTerm&>(*simplest_);
  }

  std::unique_ptr<EnergyTerm> part(MovingPart& moving) const override {
    if (fans_.cols() != 0) return nullptr;
    std::vector<int> corners;
    for (int t = 0; t < triangles_.cols(); ++t) {
      const Eigen::Vector3i triangle = triangles_.col(t);
      if (!moving.moves_any(triangle)) continue;
      for (const int node : triangle) corners.push_back(moving.number(node));
    }
    std::vector<std::array<int, 2>> touched;
    for (const auto& edge : edges_)
      if (moving.moves_any(edge)) touched.push_back({moving.number(edge[0]), moving.number(edge[1])});
    Triangles triangles =
        Eigen::Map<const Triangles>(corners.data(), 3, static_cast<Eigen::Index>(corners.size() / 3));
    return std::make_unique<LoadPressureFollower>(name(), std::move(triangles), std::move(touched), rest_);
  }

  bool simplify() override {
    if (fans_.cols() == 0) return false;
    set_fans({});
    return true;
  }

 private:
  void set_fans(const std::vector<int>& fan_corners) {
    fans_ = Eigen::Map<const Triangles>(fan_corners.data(), 3, static_cast<int>(fan_corners.size() / 3));
    std::vector<int> corners = corner_list(triangles_);
    corners.insert(corners.end(), fan_corners.begin(), fan_corners.end());
    const size_t count = corners.size() / 3;
    closed_.emplace(name(), std::move(corners), std::vector<FacetVolume::Rest>(count, rest_));
    simplest_ = fan_corners.empty()
                    ? nullptr
                    : std::make_unique<LoadPressureFollower>(name(), triangles_, edges_, rest_);
  }

  Triangles triangles_;
  std::vector<std::vector<int>> rims_;     // those that move, in the direction of the facets
  std::vector<std::array<int, 2>> edges_;  // of the rims
  FacetVolume::Rest rest_;
  Triangles fans_;                                  // none until rebuild_potential()
  std::optional<ElementTerm<FacetVolume>> closed_;  // surface and fans
  std::unique_ptr<LoadPressureFollower> simplest_;  // without the fans; none where there are none
};

}  // namespace

Points follower_pressure_forces(const Points& x, const Triangles& triangles, double p) {
  return frozen_pressure_forces(x, triangles, p);
}

std::optional<double> pressure_of(const EnergyTerm& term) {
  const TermAccess* access = access_of(term);
  return access == nullptr ? std::nullopt : access->pressure();
}

bool set_pressure(EnergyTerm& term, double p) {
  if (!pressure_of(term)) return false;
  access_of(term)->set_pressure(p);
  return true;
}

std::unique_ptr<EnergyTerm> make_volume_pressure(std::string name, const Points& X,
                                                 const Triangles& triangles, double p,
                                                 const FixedMask& fixed) {
  const std::optional<Vec3> origin = sliding_origin(X, moving_rims(triangles, fixed), fixed);
  if (!origin)
    throw InputError("term \"" + name +
                     "\": the pressure model \"volume\" needs a closed surface or a rim that is fixed (or "
                     "slides within coordinate planes that meet in a point); this surface has a rim that "
                     "moves freely, where pressure has no potential: use \"model\": \"follower\"");
  return volume_term(std::move(name), triangles, p, *origin);
}

std::unique_ptr<EnergyTerm> make_follower_pressure(std::string name, const Points& X,
                                                   const Triangles& triangles, double p,
                                                   const FixedMask& fixed) {
  std::vector<std::vector<int>> rims = moving_rims(triangles, fixed);
  if (const std::optional<Vec3> origin = sliding_origin(X, rims, fixed))
    return volume_term(std::move(name), triangles, p, *origin);
  return std::make_unique<LoadPressureFollower>(std::move(name), X, triangles, p, std::move(rims));
}

}  // namespace coapt
