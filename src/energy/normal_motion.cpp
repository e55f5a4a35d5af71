#include "energy/normal_motion.hpp"

#include "energy/film_net.hpp"
#include "energy/term_access.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>

namespace coapt {
namespace {

constexpr double kLeastDirection = 0.1;   // of a normal, within the plane in which a node may slide
constexpr double kOblique = 0.5;          // cosine between a line and the normal
constexpr double kRough = 0.85;           // cosine between the normals at a node and of one of its triangles
constexpr double kLeastStiffness = 1e-3;  // of the directions in the film, beside the whole of a node

Vec3 twice_area(const Points& x, const int* corners) {
  const Vec3 first = x.col(corners[0]);
  return (x.col(corners[1]) - first).cross(Vec3(x.col(corners[2]) - first));
}

struct FilmEdge {
  int triangles = 0;
  int sense = 0;  // how often it is run through from its lesser node to its greater one, less the reverse
  bool is_rim() const { return triangles == 1; }
  bool is_regular() const { return triangles == 2 && sense == 0; }
};

// All films of a scene as one set of triangles.
class Films {
 public:
  Films(const std::vector<std::unique_ptr<EnergyTerm>>& terms, size_t node_count)
      : tension_(node_count, 0), is_apart_(node_count, false), parent_(node_count) {
    std::iota(parent_.begin(), parent_.end(), 0);
    for (const auto& term : terms) {
      const TermKind kind = kind_of(*term);
      if (kind == TermKind::Film)
        add(*term, *access_of(*term));
      else if (kind != TermKind::Pressure && term->role() != TermRole::Contact)
        for (const int node : term->stencils().nodes) is_apart_[static_cast<size_t>(node)] = true;
    }
    for (const auto& [ends, edge] : edges_)
      if (!edge.is_rim() && !edge.is_regular())
        for (const int node : ends) is_apart_[static_cast<size_t>(node)] = true;
  }

  const std::vector<int>& corners() const { return corners_; }
  const std::map<std::array<int, 2>, FilmEdge>& edges() const { return edges_; }
  bool contains(int node) const { return tension_[static_cast<size_t>(node)] > 0; }
  // Whether something else has a say in where the node goes along the film.
  bool is_apart(int node) const { return is_apart_[static_cast<size_t>(node)]; }
  int part(int node) const {
    while (parent_[static_cast<size_t>(node)] != node) node = parent_[static_cast<size_t>(node)];
    return node;
  }

 private:
  void add(const EnergyTerm& film, const TermAccess& access) {
    const std::vector<int>& nodes = film.stencils().nodes;
    corners_.insert(corners_.end(), nodes.begin(), nodes.end());
    for (size_t k = 0; k < nodes.size(); ++k) {
      const int a = nodes[k], b = nodes[k % 3 == 2 ? k - 2 : k + 1];
      const double tension = access.film_tension(static_cast<int>(k / 3));
      double& known = tension_[static_cast<size_t>(a)];
      if (known != 0 && known != tension) is_apart_[static_cast<size_t>(a)] = true;
      known = tension;
      FilmEdge& edge = edges_[{std::min(a, b), std::max(a, b)}];
      ++edge.triangles;
      edge.sense += a < b ? 1 : -1;
      const int from = part(a), to = part(b);
      parent_[static_cast<size_t>(std::max(from, to))] = std::min(from, to);
    }
  }

  std::vector<int> corners_;
  std::vector<double> tension_;  // at each node
  std::vector<bool> is_apart_;
  std::vector<int> parent_;
  std::map<std::array<int, 2>, FilmEdge> edges_;
};

}  // namespace

NormalMotion::NormalMotion(const std::vector<std::unique_ptr<EnergyTerm>>& terms, const Points& start,
                           const std::vector<int>& block,
                           const Eigen::Array<bool, 3, Eigen::Dynamic>& fixed) {
  const auto is_film = [](const auto& term) { return kind_of(*term) == TermKind::Film; };
  const auto has_no_potential = [](const auto& term) { return term->has_circulatory_force(); };
  if (std::none_of(terms.begin(), terms.end(), is_film) ||
      std::any_of(terms.begin(), terms.end(), has_no_potential))
    return;
  const Films films(terms, block.size());
  std::vector<bool> is_rim(block.size(), false), is_loose(block.size(), false);  // the latter by part
  for (const auto& [ends, edge] : films.edges()) {
    if (!edge.is_rim()) continue;
    for (const int node : ends) {
      is_rim[static_cast<size_t>(node)] = true;
      if (!fixed.col(node).any() || (films.is_apart(node) && !fixed.col(node).all()))
        is_loose[static_cast<size_t>(films.part(node))] = true;
    }
  }
  place_.assign(block.size(), -1);
  place_of_block_.assign(block.size(), -1);
  for (int node = 0; node < static_cast<int>(block.size()); ++node) {
    const auto prescribed = fixed.col(node).count();
    if (!films.contains(node) || films.is_apart(node) || is_loose[static_cast<size_t>(films.part(node))] ||
        prescribed != (is_rim[static_cast<size_t>(node)] ? 1 : 0))
      continue;
    place_[static_cast<size_t>(node)] =
        place_of_block_[static_cast<size_t>(block[static_cast<size_t>(node)])] =
            static_cast<int>(places_.size());
    places_.push_back({block[static_cast<size_t>(node)], 1 - fixed.col(node).cast<double>(), Vec3::Zero()});
  }
  for (size_t k = 0; k < films.corners().size(); k += 3) {
    const int* corner = films.corners().data() + k;
    if (std::any_of(corner, corner + 3, [&](int node) { return place_[static_cast<size_t>(node)] >= 0; }))
      corners_.insert(corners_.end(), corner, corner + 3);
  }
  turn_where_needed(smooth_start(start));
}

std::vector<Vec3> NormalMotion::normals_at(const Points& x) const {
  std::vector<Vec3> normals(places_.size(), Vec3::Zero());
  for (size_t k = 0; k < corners_.size(); k += 3) {
    const Vec3 area = twice_area(x, corners_.data() + k);
    for (size_t c = k; c < k + 3; ++c)
      if (const int place = place_[static_cast<size_t>(corners_[c])]; place >= 0)
        normals[static_cast<size_t>(place)] += area;
  }
  for (size_t k = 0; k < places_.size(); ++k) {
    const Vec3 within = normals[k].array() * places_[k].is_free;
    const double length = within.norm();
    normals[k] = length > kLeastDirection * normals[k].norm() ? Vec3(within / length) : Vec3(Vec3::Zero());
  }
  return normals;
}

bool NormalMotion::turn_where_needed(const Points& x) {
  const std::vector<Vec3> normals = normals_at(x);
  bool is_needed = false;
  for (size_t k = 0; k < places_.size(); ++k)
    is_needed = is_needed || (!normals[k].isZero() && std::abs(normals[k].dot(places_[k].normal)) < kOblique);
  if (is_needed)
    for (size_t k = 0; k < places_.size(); ++k) places_[k].normal = normals[k];
  return is_needed;
}

double NormalMotion::restrict_gradient(Vector& g) const {
  double left_out = 0;
  for (const Place& place : places_) {
    if (place.normal.isZero()) continue;
    auto force = g.segment<3>(3 * place.block);
    const Vec3 along = place.normal.dot(force) * place.normal;
    left_out = std::max(left_out, (force - along).squaredNorm());
    force = along;
  }
  return std::sqrt(left_out);
}

void NormalMotion::restrict_hessian(Eigen::SparseMatrix<double>& h) {
  restriction_.clear();
  for (const Place& place : places_)
    restriction_.push_back(place.normal.isZero() ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                                 : Eigen::Matrix3d(place.normal * place.normal.transpose()));
  const int* outer = h.outerIndexPtr();
  for (int column = 0; column < static_cast<int>(h.cols()) / 3; ++column) {
    const int first = outer[3 * column], stride = outer[3 * column + 1] - first;
    const int across = place_of_block_[static_cast<size_t>(column)];
    for (int k = first; k < first + stride; k += 3) {
      const int down = place_of_block_[static_cast<size_t>(h.innerIndexPtr()[k] / 3)];
      if (across < 0 && down < 0) continue;
      Eigen::Map<Eigen::Matrix3d, 0, Eigen::OuterStride<>> block(h.valuePtr() + k,
                                                                 Eigen::OuterStride<>(stride));
      Eigen::Matrix3d part = block;
      if (down >= 0) part = restriction_[static_cast<size_t>(down)] * part.eval();
      if (across >= 0) part = part.eval() * restriction_[static_cast<size_t>(across)];
      if (h.innerIndexPtr()[k] == 3 * column) {
        const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - restriction_[static_cast<size_t>(across)];
        part += std::max(part.trace(), kLeastStiffness * block.cwiseAbs().maxCoeff()) * rest;
        for (int c = 0; c < 3; ++c)
          if (places_[static_cast<size_t>(across)].is_free[c] == 0) part(c, c) = 1;
      }
      block = part;
    }
  }
}

bool NormalMotion::is_rough(const Points& x, const std::vector<Vec3>& normals) const {
  for (size_t k = 0; k < corners_.size(); k += 3) {
    const Vec3 normal = twice_area(x, corners_.data() + k).normalized();
    for (size_t c = k; c < k + 3; ++c) {
      const int place = place_[static_cast<size_t>(corners_[c])];
      if (place < 0 || places_[static_cast<size_t>(place)].is_free.minCoeff() == 0) continue;
      if (!(normal.dot(normals[static_cast<size_t>(place)]) > kRough)) return true;
    }
  }
  return false;
}

Points NormalMotion::smooth_start(const Points& x) const {
  if (!is_rough(x, normals_at(x))) return x;
  FilmNet net{corners_, Eigen::Array<bool, 3, Eigen::Dynamic>::Constant(3, x.cols(), false)};
  for (size_t node = 0; node < place_.size(); ++node)
    if (place_[node] >= 0)
      net.is_free.col(static_cast<Eigen::Index>(node)) =
          places_[static_cast<size_t>(place_[node])].is_free != 0;
  Points smooth = x;
  for (int coordinate = 0; coordinate < 3; ++coordinate) relax_net(net, coordinate, smooth);
  lessen_area(net, smooth);
  return smooth;
}

}  // namespace coapt
