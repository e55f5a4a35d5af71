#include "xpbd/separating_planes.hpp"

#include "mesh/triangle_mesh.hpp"
#include "xpbd/contact_features.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kLongestPlane = 0.2;  // mean edge lengths: neighbours on a flat sheet need no planes
constexpr double kSkin = 0.25;  // of the longest move: what nodes may go before pairs are looked for again
constexpr double kKept = 0.25;  // share of its distance that a pair keeps
constexpr double kLeast = 0.1;  // of the thickness: nothing comes nearer
constexpr double kShareOfRest = 0.5;  // of the distance at rest, which a pair has to keep
constexpr int kSlides = 8;            // sweeps over the planes of a node

double longest(const Points& d) {
  return d.cols() == 0 ? 0 : std::sqrt(d.colwise().squaredNorm().maxCoeff());
}

// The share of the room between two sides that the first gets, when they want to go so far into it.
double share_of_first(double first, double second, double room) {
  const double wanted = first + second;
  if (wanted > room) return first / wanted;
  return room > 0 ? (first + 0.5 * (room - wanted)) / room : 0.5;
}

}  // namespace

SeparatingPlanes::SeparatingPlanes(const XpbdBody& body, double thickness)
    : surface_(contact_surface(body)),
      thickness_(thickness),
      longest_(kLongestPlane * mean_edge_length(body.rest, body.triangles)) {}

void SeparatingPlanes::search(const Points& x) {
  // What is farther apart than the first of these keeps what it has to, however it moves.
  const double reach =
      std::max(2 * longest_ / (1 - kKept), 2 * longest_ + kLeast * thickness_) + 2 * kSkin * longest_;
  pairs_.clear();
  surface_.visit_near(x, reach, [&](const FeaturePair& pair) {
    if (closest_points(pair.kind, pair_corners(x, pair.nodes)).distance > reach) return;
    const double at_rest = closest_points(pair.kind, pair_corners(surface_.rest(), pair.nodes)).distance;
    pairs_.push_back({pair.kind, pair.nodes, kLeast * std::min(thickness_, kShareOfRest * at_rest)});
  });
  searched_at_ = x;
  ++searches_;
}

void SeparatingPlanes::place_planes(const Points& x, const Points& d) {
  planes_.clear();
  const Eigen::RowVectorXd lengths = d.colwise().norm();
  for (const Pair& pair : pairs_) {
    const int in_first = pair.kind == PairKind::PointTriangle ? 1 : 2;
    double approach[2] = {0, 0};
    for (int k = 0; k < 4; ++k)
      approach[k < in_first ? 0 : 1] =
          std::max(approach[k < in_first ? 0 : 1], lengths[pair.nodes[static_cast<size_t>(k)]]);
    if (approach[0] + approach[1] == 0) continue;
    const PairCorners c = pair_corners(x, pair.nodes);
    const ClosestPair closest = closest_points(pair.kind, c);
    if (closest.distance * (1 - kKept) > approach[0] + approach[1] &&
        closest.distance - pair.least > approach[0] + approach[1])
      continue;
    const Vec3 between = c * closest.weights;
    const Vec3 normal = closest.distance > 0 ? Vec3(between / closest.distance) : Vec3::UnitZ();
    const Eigen::RowVector4d now = normal.transpose() * c,
                             end = now + normal.transpose() * pair_corners(d, pair.nodes);
    const double low = now.head(in_first).minCoeff(), high = now.tail(4 - in_first).maxCoeff(),
                 gap = low - high;
    const double room = std::max(gap - std::max(kKept * gap, std::min(gap, pair.least)), 0.0);
    const double into_first = std::max(end.tail(4 - in_first).maxCoeff() - high, 0.0),
                 into_second = std::max(low - end.head(in_first).minCoeff(), 0.0);
    const double of_first = gap > 0 ? room * share_of_first(into_second, into_first, room) : 0;
    for (int k = 0; k < 4; ++k) {
      const bool is_first = k < in_first;
      const double beyond = is_first ? now[k] - low : high - now[k];
      planes_.push_back({pair.nodes[static_cast<size_t>(k)], is_first ? normal : Vec3(-normal),
                         gap > 0 ? beyond + (is_first ? of_first : room - of_first) : 0});
    }
  }
}

// By node, those of each in the order in which they were placed.
void SeparatingPlanes::sort_planes(Eigen::Index node_count) {
  first_.assign(static_cast<size_t>(node_count) + 1, 0);
  for (const Plane& plane : planes_) ++first_[static_cast<size_t>(plane.node) + 1];
  for (size_t k = 1; k < first_.size(); ++k) first_[k] += first_[k - 1];
  sorted_.resize(planes_.size());
  std::vector<size_t> next = first_;
  for (const Plane& plane : planes_) sorted_[next[static_cast<size_t>(plane.node)]++] = plane;
}

int SeparatingPlanes::admit(const Points& x, const InverseMasses& w, Points& d) {
  for (auto move : d.colwise())
    if (const double length = move.norm(); length > longest_) move *= longest_ / length;
  const double skin = kSkin * longest_;
  if (searches_ == 0 || longest(x - searched_at_) > skin) search(x);
  place_planes(x, d);
  sort_planes(x.cols());
  int changed = 0;
  for (Eigen::Index node = 0; node < x.cols(); ++node) {
    const size_t begin = first_[static_cast<size_t>(node)], end = first_[static_cast<size_t>(node) + 1];
    if (begin == end) continue;
    const Vec3 wanted = d.col(node);
    Vec3 move = wanted;
    for (int sweep = 0; sweep < kSlides; ++sweep)
      for (size_t k = begin; k < end; ++k) {
        const double over = -sorted_[k].room - sorted_[k].normal.dot(move);
        if (over <= 0) continue;
        const Vec3 along = (w.col(node).array() > 0).select(sorted_[k].normal, 0);
        if (const double squared = along.squaredNorm(); squared > 1e-12) move += over / squared * along;
      }
    if (const double length = move.norm(); length > wanted.norm()) move *= wanted.norm() / length;
    double share = 1;
    for (size_t k = begin; k < end; ++k) {
      const double towards = -sorted_[k].normal.dot(move);
      if (towards > sorted_[k].room) share = std::min(share, sorted_[k].room / towards);
    }
    d.col(node) = share * move;
    if (d.col(node) != wanted) ++changed;
  }
  return changed;
}

}  // namespace coapt
