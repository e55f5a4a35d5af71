#include "mesh/remesh/repair_slivers.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace coapt {
namespace {

constexpr double kMostCollapsed = 0.01;  // length of a collapsed edge over the longest edge of the sliver
constexpr double kBetter = 1.5;          // by which the worst triangle improves where no sliver goes
constexpr double kSameSide = 0.2;        // cosine between the normals of a triangle before and after
constexpr int kMostPasses = 100;
constexpr size_t kMostAround = 500;  // triangles of a vertex: the spokes of a larger fan are left

size_t pos(int i) { return static_cast<size_t>(i); }

// Of a triangle: the longest edge runs from corner `k` to the next; the apex is the one after that.
struct Shape {
  int k = 0;
  double longest = 0, height = 0;
  double aspect() const { return height > 0 ? longest / height : kInfinity; }
};

Shape shape_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  const std::array<double, 3> sides = {(b - a).norm(), (c - b).norm(), (a - c).norm()};
  Shape shape;
  shape.k = static_cast<int>(std::max_element(sides.begin(), sides.end()) - sides.begin());
  shape.longest = sides[pos(shape.k)];
  // Relative to the longest edge, so that neither tiny nor huge meshes leave the range of doubles.
  if (shape.longest > 0)
    shape.height = ((b - a) / shape.longest).cross((c - a) / shape.longest).norm() * shape.longest;
  return shape;
}

// A step that could be made: triangles that go and the corners of those that take their place.
struct Proposal {
  RepairStep step;
  std::vector<int> changed, dropped;
  std::vector<Eigen::Vector3i> corners;  // of `changed`
  std::vector<int> regions;              // likewise
  bool leaves_fewer = false;             // slivers
};

class SliverRepairer {
 public:
  SliverRepairer(const TriangleMesh& mesh, const RepairConstraints& constraints)
      : x_(mesh.vertices),
        constraints_(constraints),
        regions_(mesh.regions),
        around_(pos(mesh.vertex_count())),
        surface_moved_(Vector::Zero(mesh.vertex_count())),
        into_(pos(mesh.vertex_count()), -1) {
    for (int t = 0; t < mesh.triangle_count(); ++t) {
      triangles_.emplace_back(mesh.triangles.col(t));
      for (int k = 0; k < 3; ++k) around_[pos(mesh.triangles(k, t))].push_back(t);
    }
  }

  void drop_repeated();
  void repair(std::vector<int> wanting);
  MeshRepair result(const TriangleMesh& given) const;

 private:
  using Corners = Eigen::Vector3i;

  bool is_gone(int t) const { return triangles_[pos(t)][0] < 0; }
  static bool has(const Corners& c, int v) { return c[0] == v || c[1] == v || c[2] == v; }
  Vec3 normal(const Corners& c) const {
    return (x_.col(c[1]) - x_.col(c[0])).cross(x_.col(c[2]) - x_.col(c[0]));
  }
  Shape shape(const Corners& c) const { return shape_of(x_.col(c[0]), x_.col(c[1]), x_.col(c[2])); }
  bool is_sliver(const Corners& c) const { return shape(c).aspect() > constraints_.aspect; }
  std::vector<int> at_edge(int a, int b) const;
  bool is_on_rim(int v) const;
  std::set<int> neighbours(int v) const;
  std::set<int> regions_at(int v) const;
  bool may_merge(int v, int u) const;

  bool turns_over(int t, const Corners& after) const;
  bool improves(Proposal& proposal) const;
  std::optional<Proposal> flip(int t) const;
  std::optional<Proposal> cut(int t) const;
  std::optional<Proposal> collapse(int v, int u) const;
  bool take_best(int t);
  void carry_out(const Proposal& proposal);
  void remove(int t);

  const Points& x_;
  const RepairConstraints& constraints_;
  std::vector<int> regions_;
  std::vector<Corners> triangles_;        // -1 in the first place: gone
  std::vector<std::vector<int>> around_;  // triangles of each vertex
  Vector surface_moved_;                  // bound on what the steps at a vertex moved so far
  std::vector<int> into_;                 // that a vertex was merged into; -1: it is there
  std::vector<RepairStep> steps_;
};

std::vector<int> SliverRepairer::at_edge(int a, int b) const {
  std::vector<int> result;
  for (const int t : around_[pos(a)])
    if (has(triangles_[pos(t)], b)) result.push_back(t);
  return result;
}

bool SliverRepairer::is_on_rim(int v) const {
  const std::set<int> all = neighbours(v);
  return std::any_of(all.begin(), all.end(), [&](int w) { return at_edge(v, w).size() == 1; });
}

std::set<int> SliverRepairer::neighbours(int v) const {
  std::set<int> result;
  for (const int t : around_[pos(v)])
    for (int k = 0; k < 3; ++k) result.insert(triangles_[pos(t)][k]);
  result.erase(v);
  return result;
}

std::set<int> SliverRepairer::regions_at(int v) const {
  std::set<int> result;
  if (!regions_.empty())
    for (const int t : around_[pos(v)]) result.insert(regions_[pos(t)]);
  return result;
}

bool SliverRepairer::may_merge(int v, int u) const {
  if (!constraints_.stays.empty() && constraints_.stays[pos(v)]) return false;
  if (!constraints_.roles.empty() && (constraints_.roles[pos(v)] & ~constraints_.roles[pos(u)]) != 0)
    return false;
  const std::set<int> mine = regions_at(v), others = regions_at(u);
  return std::includes(others.begin(), others.end(), mine.begin(), mine.end());
}

// The normal of a sliver says nothing.
bool SliverRepairer::turns_over(int t, const Corners& after) const {
  const Corners& before = triangles_[pos(t)];
  if (is_sliver(before) || is_sliver(after)) return false;
  const Vec3 n = normal(before), m = normal(after);
  return n.dot(m) < kSameSide * n.norm() * m.norm();
}

// Notes whether slivers go.
bool SliverRepairer::improves(Proposal& proposal) const {
  int before = 0, after = 0;
  double worst_before = 0, worst_after = 0;
  for (const std::vector<int>* list : {&proposal.changed, &proposal.dropped})
    for (const int t : *list) {
      const double aspect = shape(triangles_[pos(t)]).aspect();
      worst_before = std::max(worst_before, aspect);
      before += aspect > constraints_.aspect ? 1 : 0;
    }
  for (const Corners& corners : proposal.corners) {
    const double aspect = shape(corners).aspect();
    worst_after = std::max(worst_after, aspect);
    after += aspect > constraints_.aspect ? 1 : 0;
  }
  proposal.leaves_fewer = after < before;
  return after < before || (after == before && kBetter * worst_after < worst_before);
}

std::optional<Proposal> SliverRepairer::flip(int t) const {
  const Corners& c = triangles_[pos(t)];
  const Shape flat = shape(c);
  const int a = c[flat.k], b = c[(flat.k + 1) % 3], apex = c[(flat.k + 2) % 3];
  const std::vector<int> sides = at_edge(a, b);
  if (sides.size() != 2) return std::nullopt;
  const int s = sides[0] == t ? sides[1] : sides[0];
  const Corners& other = triangles_[pos(s)];
  const int opposite = other.sum() - a - b;
  if (opposite == apex || !at_edge(apex, opposite).empty()) return std::nullopt;
  // As the neighbour runs around: a flat triangle may be turned over.
  int k = 0;
  while (other[k] != opposite) ++k;
  const int p = other[(k + 1) % 3], q = other[(k + 2) % 3];
  Proposal proposal;
  proposal.step = {RepairKind::Flip, {t, s}, {a, b}, apex, flat.height};
  proposal.changed = {t, s};
  proposal.corners = {Corners(opposite, p, apex), Corners(opposite, apex, q)};
  if (!regions_.empty()) proposal.regions = {regions_[pos(s)], regions_[pos(s)]};
  for (const Corners& corners : proposal.corners)
    if (turns_over(s, corners)) return std::nullopt;
  return proposal;
}

std::optional<Proposal> SliverRepairer::cut(int t) const {
  const Corners& c = triangles_[pos(t)];
  const Shape flat = shape(c);
  const int a = c[flat.k], b = c[(flat.k + 1) % 3], apex = c[(flat.k + 2) % 3];
  if (at_edge(a, b).size() != 1 || is_on_rim(apex)) return std::nullopt;
  if (!constraints_.roles.empty() &&
      (constraints_.roles[pos(a)] & constraints_.roles[pos(b)] & constraints_.uncut_roles) != 0)
    return std::nullopt;
  Proposal proposal;
  proposal.step = {RepairKind::Cut, {t}, {a, b}, apex, flat.height};
  proposal.dropped = {t};
  return proposal;
}

std::optional<Proposal> SliverRepairer::collapse(int v, int u) const {
  if (!may_merge(v, u)) return std::nullopt;
  const std::vector<int> shared = at_edge(v, u);
  if (shared.empty() || shared.size() > 2 || (shared.size() == 2 && is_on_rim(v))) return std::nullopt;
  const std::set<int> mine = neighbours(v), others = neighbours(u);
  const auto common = std::count_if(mine.begin(), mine.end(), [&](int w) { return others.contains(w); });
  if (static_cast<size_t>(common) != shared.size()) return std::nullopt;
  // Something is left of both, and of what lies between.
  if (around_[pos(v)].size() == shared.size() && around_[pos(u)].size() == shared.size()) return std::nullopt;
  for (const int t : shared)
    if (around_[pos(triangles_[pos(t)].sum() - u - v)].size() < 2) return std::nullopt;
  Proposal proposal;
  proposal.step = {RepairKind::Collapse, around_[pos(v)], {v, u}, -1, (x_.col(v) - x_.col(u)).norm()};
  proposal.dropped = shared;
  for (const int t : around_[pos(v)]) {
    Corners corners = triangles_[pos(t)];
    if (has(corners, u)) continue;
    for (int k = 0; k < 3; ++k)
      if (corners[k] == v) corners[k] = u;
    if (turns_over(t, corners)) return std::nullopt;
    proposal.changed.push_back(t);
    proposal.corners.push_back(corners);
    if (!regions_.empty()) proposal.regions.push_back(regions_[pos(t)]);
  }
  return proposal;
}

bool SliverRepairer::take_best(int t) {
  for (const int v : triangles_[pos(t)])
    if (around_[pos(v)].size() > kMostAround) return false;
  std::vector<Proposal> proposals;
  const auto consider = [&](std::optional<Proposal> proposal) {
    if (proposal && improves(*proposal)) proposals.push_back(std::move(*proposal));
  };
  consider(flip(t));
  consider(cut(t));
  const Corners c = triangles_[pos(t)];
  const double longest = shape(c).longest;
  for (int k = 0; k < 3; ++k) {
    const int a = c[k], b = c[(k + 1) % 3];
    if ((x_.col(a) - x_.col(b)).norm() > kMostCollapsed * longest) continue;
    consider(collapse(a, b));
    consider(collapse(b, a));
  }
  if (proposals.empty()) return false;
  carry_out(*std::min_element(proposals.begin(), proposals.end(), [](const Proposal& l, const Proposal& r) {
    return l.leaves_fewer != r.leaves_fewer ? l.leaves_fewer : l.step.moved < r.step.moved;
  }));
  return true;
}

void SliverRepairer::remove(int t) {
  Corners& corners = triangles_[pos(t)];
  for (int k = 0; k < 3; ++k) std::erase(around_[pos(corners[k])], t);
  corners[0] = -1;
}

void SliverRepairer::carry_out(const Proposal& proposal) {
  std::set<int> touched;
  for (const std::vector<int>* list : {&proposal.changed, &proposal.dropped})
    for (const int t : *list) {
      for (int k = 0; k < 3; ++k) touched.insert(triangles_[pos(t)][k]);
      remove(t);
    }
  for (size_t i = 0; i < proposal.changed.size(); ++i) {
    const int t = proposal.changed[i];
    triangles_[pos(t)] = proposal.corners[i];
    if (!regions_.empty()) regions_[pos(t)] = proposal.regions[i];
    for (int k = 0; k < 3; ++k) around_[pos(proposal.corners[i][k])].push_back(t);
  }
  double most = 0;
  for (const int v : touched) most = std::max(most, surface_moved_[v]);
  for (const int v : touched) surface_moved_[v] = most + proposal.step.moved;
  if (proposal.step.kind == RepairKind::Collapse) into_[pos(proposal.step.edge[0])] = proposal.step.edge[1];
  steps_.push_back(proposal.step);
}

void SliverRepairer::drop_repeated() {
  std::set<std::array<int, 3>> seen;
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    std::array<int, 3> corners = {triangles_[pos(t)][0], triangles_[pos(t)][1], triangles_[pos(t)][2]};
    std::sort(corners.begin(), corners.end());
    const bool names_twice = corners[0] == corners[1] || corners[1] == corners[2];
    if (!names_twice && seen.insert(corners).second) continue;
    steps_.push_back({RepairKind::Drop, {t}, {corners[0], corners[2]}, -1, 0});
    remove(t);
  }
}

void SliverRepairer::repair(std::vector<int> wanting) {
  for (int pass = 0; pass < kMostPasses && !wanting.empty(); ++pass) {
    std::sort(wanting.begin(), wanting.end(), [this](int s, int t) {
      const double l = shape(triangles_[pos(s)]).aspect(), r = shape(triangles_[pos(t)]).aspect();
      return l != r ? l > r : s < t;
    });
    const size_t before = steps_.size();
    for (const int t : wanting)
      if (!is_gone(t) && is_sliver(triangles_[pos(t)])) take_best(t);
    if (steps_.size() == before) return;
    std::set<int> next;  // a step may leave a milder sliver in a neighbour
    for (const int t : wanting) next.insert(t);
    for (size_t i = before; i < steps_.size(); ++i)
      next.insert(steps_[i].triangles.begin(), steps_[i].triangles.end());
    wanting.clear();
    for (const int t : next)
      if (!is_gone(t) && is_sliver(triangles_[pos(t)])) wanting.push_back(t);
  }
}

MeshRepair SliverRepairer::result(const TriangleMesh& given) const {
  MeshRepair result;
  result.steps = steps_;
  result.number.assign(around_.size(), -1);
  std::vector<int> kept;
  for (int v = 0; v < given.vertex_count(); ++v)
    if (into_[pos(v)] < 0) {
      result.number[pos(v)] = static_cast<int>(kept.size());
      kept.push_back(v);
    }
  for (int v = 0; v < given.vertex_count(); ++v) {
    int end = v;
    while (into_[pos(end)] >= 0) end = into_[pos(end)];
    result.number[pos(v)] = result.number[pos(end)];
    result.largest_move = std::max(result.largest_move, (x_.col(v) - x_.col(end)).norm());
  }
  if (given.vertex_count() > 0) result.surface_move = surface_moved_.maxCoeff();
  result.mesh.vertices = x_(Eigen::all, kept);
  result.mesh.region_names = given.region_names;
  result.triangle.assign(triangles_.size(), -1);
  std::vector<int> left;
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t)
    if (!is_gone(t)) {
      result.triangle[pos(t)] = static_cast<int>(left.size());
      left.push_back(t);
      if (is_sliver(triangles_[pos(t)])) result.left.push_back(t);
    }
  result.mesh.triangles.resize(3, static_cast<Eigen::Index>(left.size()));
  for (size_t i = 0; i < left.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      result.mesh.triangles(k, static_cast<Eigen::Index>(i)) =
          result.number[pos(triangles_[pos(left[i])][k])];
    if (!regions_.empty()) result.mesh.regions.push_back(regions_[pos(left[i])]);
  }
  return result;
}

}  // namespace

std::vector<int> slivers(const TriangleMesh& mesh, double aspect) {
  std::vector<int> result;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = [&](int k) -> Vec3 { return mesh.vertices.col(mesh.triangles(k, t)); };
    if (shape_of(corner(0), corner(1), corner(2)).aspect() > aspect) result.push_back(t);
  }
  return result;
}

MeshRepair repair_slivers(const TriangleMesh& mesh, const RepairConstraints& constraints) {
  SliverRepairer repairer(mesh, constraints);
  const std::vector<int> found = slivers(mesh, constraints.aspect);
  repairer.drop_repeated();
  repairer.repair(found);
  MeshRepair result = repairer.result(mesh);
  result.slivers = found;
  return result;
}

}  // namespace coapt
