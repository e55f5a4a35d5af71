#include "mesh/generators/rough_chords.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace coapt {
namespace {

struct RoughInsertion {
  double u = 0, t = 1;
};

// Insertions that one branch point serves; one alone has none.
using RoughFan = std::vector<RoughInsertion>;

// Fans that hang on one tip: one, or two behind a common branch point.
struct RoughTree {
  int group = 0;
  std::string material;
  double area = 0;  // of a strand that ends at a leaflet; others bear several [mm^2]
  std::vector<RoughFan> fans;
};

// Half of a leaflet, beside one of its commissures.
struct LeafletHalf {
  int group;
  double from, to;  // u, from the commissure to mid-leaflet
  double length;    // of its margin [mm]
};

std::vector<LeafletHalf> halves(const RoughSurface& surface) {
  std::vector<LeafletHalf> all;
  const int leaflets = static_cast<int>(surface.begins.size());
  for (int k = 0; k < leaflets; ++k) {
    const double begin = surface.begins[k], end = surface.end(k), middle = 0.5 * (begin + end);
    all.push_back({k, begin, middle, 0});
    all.push_back({(k + 1) % leaflets, end, middle, 0});
  }
  for (LeafletHalf& half : all)
    for (int i = 0; i < 40; ++i) {
      auto at = [&](int step) { return surface.open(half.from + (half.to - half.from) * step / 40, 1); };
      half.length += (at(i + 1) - at(i)).norm();
    }
  return all;
}

// Fans of `least` to `most` neighbours.
std::vector<RoughFan> in_fans(const std::vector<RoughInsertion>& insertions, int least, int most,
                              RandomSource& random) {
  std::vector<RoughFan> fans;
  for (size_t i = 0; i < insertions.size();) {
    const size_t left = insertions.size() - i;
    const size_t count = std::min(left, static_cast<size_t>(least + random.below(most - least + 1)));
    fans.emplace_back(insertions.begin() + static_cast<long>(i),
                      insertions.begin() + static_cast<long>(i + count));
    i += count;
  }
  return fans;
}

std::vector<RoughTree> planned_trees(const RoughSurface& surface, RandomSource& random) {
  const double spacing = random.log_between(0.8, 4.5), belly_share = random.between(0.25, 0.5);
  const double scale = random.between(0.8, 1.3);
  const int widest = 3 + random.below(8);  // fan
  std::vector<RoughTree> trees;
  for (const LeafletHalf& half : halves(surface)) {
    const int count = std::max(3, static_cast<int>(std::lround(half.length / spacing)));
    const int belly_count = std::max(1, static_cast<int>(std::lround(belly_share * count)));
    auto placed = [&](int i, int of) {
      return half.from + (half.to - half.from) * (i + random.between(0.2, 0.8)) / of;
    };
    std::vector<RoughInsertion> margin, belly;
    for (int i = 0; i < count; ++i) margin.push_back({placed(i, count), 1});
    for (int i = 0; i < belly_count; ++i) {
      const double u = placed(i, belly_count);
      belly.push_back({u, random.between(0.5, 0.8)});
    }
    const std::vector<RoughFan> fans = in_fans(margin, 1, widest, random);
    for (size_t i = 0; i < fans.size(); ++i) {
      RoughTree tree{half.group, "primary", scale * random.between(0.08, 0.16), {fans[i]}};
      const bool is_joined = i + 1 < fans.size() && random.chance(0.4);
      if (is_joined) tree.fans.push_back(fans[++i]);
      trees.push_back(tree);
    }
    for (const RoughFan& fan : in_fans(belly, 1, 3, random))
      trees.push_back({half.group, "secondary", scale * random.between(0.2, 0.4), {fan}});
  }
  return trees;
}

// A strand while it is built: its rest length is that of the closed valve.
class RoughChordBuilder {
 public:
  RoughChordBuilder(const RoughSurface& surface, const RoughMesh& mesh, RandomSource& random)
      : surface_(surface), mesh_(mesh), random_(random) {
    network_.papillary = surface.tips;
    network_.papillary_closed = surface.tips_closed;
    // Lengths that take no account of how the tips move leave chords pulling.
    foreseen_tips_ = surface.tips + random.unit() * (surface.tips_closed - surface.tips);
    is_rim_.resize(static_cast<size_t>(mesh.leaflets.vertex_count()), false);
    for (int v = 0; v < mesh.leaflets.vertex_count(); ++v)
      is_rim_[v] = mesh.coordinates(1, v) <= 0 || mesh.coordinates(1, v) >= 1;
  }

  void add(const RoughTree& tree) {
    std::vector<std::vector<int>> fans;
    Vec3 closed_sum = Vec3::Zero(), open_sum = Vec3::Zero();
    int count = 0;
    for (const RoughFan& fan : tree.fans) {
      fans.emplace_back();
      for (const RoughInsertion& insertion : fan) {
        const int v = free_vertex(insertion);
        if (v < 0) continue;
        fans.back().push_back(v);
        closed_sum += closed(v), open_sum += open(v), ++count;
      }
      if (fans.back().empty()) fans.pop_back();
    }
    if (count == 0) return;
    const int tip = chosen_tip(tree.group, open_sum / count);
    const Place from{{ChordEnd::Kind::Papillary, tip}, surface_.tips.col(tip), foreseen_tips_.col(tip)};
    if (fans.size() == 1) return add_fan(from, fans[0], tree, 1);
    const Place fork = add_junction(from, closed_sum / count, open_sum / count, random_.between(0.3, 0.45));
    add_strand(from, fork, tree, count, 1);
    for (const std::vector<int>& fan : fans) add_fan(fork, fan, tree, 2);
  }

  ChordNetwork finished() {
    settle();
    cut_lengths();
    reach_leaflets();
    network_.junctions.resize(3, static_cast<int>(junctions_.size()));
    for (size_t i = 0; i < junctions_.size(); ++i)
      network_.junctions.col(static_cast<int>(i)) = junctions_[i];
    return std::move(network_);
  }

 private:
  struct Place {
    ChordEnd end;
    Vec3 open, closed;
  };

  Vec3 open(int v) const { return mesh_.leaflets.vertices.col(v); }
  Vec3 closed(int v) const { return surface_.closed(mesh_.coordinates(0, v), mesh_.coordinates(1, v)); }

  // The nearest vertex (of the margin for t = 1, else of the inside) that no chord has yet; -1: it is far.
  int free_vertex(const RoughInsertion& insertion) {
    constexpr double kFar = 3;  // [mm]
    const Vec3 point = surface_.open(insertion.u, insertion.t);
    int best = -1;
    for (int v = 0; v < mesh_.leaflets.vertex_count(); ++v) {
      const bool fits = insertion.t < 1 ? !is_rim_[v] : mesh_.coordinates(1, v) >= 1;
      if (!fits || taken_.contains(v)) continue;
      if (best < 0 || (open(v) - point).squaredNorm() < (open(best) - point).squaredNorm()) best = v;
    }
    if (best < 0 || (open(best) - point).norm() > kFar) return -1;
    taken_.insert(best);
    return best;
  }

  // The nearest tip of the group, but now and then another.
  int chosen_tip(int group, const Vec3& point) {
    std::vector<int> tips;
    for (int i = 0; i < static_cast<int>(surface_.tip_group.size()); ++i)
      if (surface_.tip_group[i] == group) tips.push_back(i);
    const bool is_any = random_.chance(0.25);
    const int any = random_.below(static_cast<int>(tips.size()));
    if (is_any) return tips[any];
    return *std::min_element(tips.begin(), tips.end(), [&](int a, int b) {
      return (surface_.tips.col(a) - point).squaredNorm() < (surface_.tips.col(b) - point).squaredNorm();
    });
  }

  Place add_junction(const Place& from, const Vec3& closed_middle, const Vec3& open_middle, double share) {
    const ChordEnd end{ChordEnd::Kind::Junction, static_cast<int>(junctions_.size())};
    junctions_.push_back(from.open + share * (open_middle - from.open));
    return {end, junctions_.back(), from.closed + share * (closed_middle - from.closed)};
  }

  void add_strand(const Place& from, const Place& to, const RoughTree& tree, int borne, int level) {
    const double length = (to.closed - from.closed).norm() * (1 + random_.between(0.01, 0.06));
    network_.chords.push_back({from.end, to.end, length, borne * tree.area, tree.material, level});
  }

  void add_fan(const Place& from, const std::vector<int>& vertices, const RoughTree& tree, int level) {
    Vec3 closed_sum = Vec3::Zero(), open_sum = Vec3::Zero();
    for (const int v : vertices) closed_sum += closed(v), open_sum += open(v);
    const int count = static_cast<int>(vertices.size());
    Place root = from;
    if (count > 1) {
      root = add_junction(from, closed_sum / count, open_sum / count, random_.between(0.45, 0.65));
      add_strand(from, root, tree, count, level++);
    }
    for (const int v : vertices)
      add_strand(root, {{ChordEnd::Kind::Leaflet, v}, open(v), closed(v)}, tree, 1, level);
  }

  Vec3 position(const ChordEnd& end) const {
    if (end.kind == ChordEnd::Kind::Papillary) return network_.papillary.col(end.index);
    if (end.kind == ChordEnd::Kind::Junction) return junctions_[end.index];
    return open(end.index);
  }

  // Moves branch points strand by strand to where lengths lie within the limits.
  void settle() {
    constexpr int kSweeps = 400;
    constexpr double kWithin = 0.97 * kMostSlack;
    for (int sweep = 0; sweep < kSweeps; ++sweep)
      for (const Chord& chord : network_.chords) {
        const Vec3 along = position(chord.to) - position(chord.from);
        const double length = along.norm();
        const double wanted = std::clamp(length, chord.rest_length / (1 + kWithin), chord.rest_length);
        if (length == wanted || length == 0) continue;
        const bool moves_from = chord.from.kind == ChordEnd::Kind::Junction,
                   moves_to = chord.to.kind == ChordEnd::Kind::Junction;
        const Vec3 step = (wanted / length - 1) * along / (moves_from && moves_to ? 2 : 1);
        if (moves_from) junctions_[chord.from.index] -= step;
        if (moves_to) junctions_[chord.to.index] += step;
      }
  }

  void cut_lengths() {
    for (Chord& chord : network_.chords) {
      const double length = (position(chord.to) - position(chord.from)).norm();
      chord.rest_length = std::clamp(chord.rest_length, length, (1 + kMostSlack) * length);
      const bool is_short = random_.chance(0.04);
      const double shortage = random_.between(0.01, kMostShortage);
      if (is_short) chord.rest_length = (1 - shortage) * length;
    }
  }

  // Lengthens strands between a tip and a vertex that could not reach it in the closed valve, not even with
  // the leaflet drawn straight from the annulus.
  void reach_leaflets() {
    constexpr int kPlaces = 60;  // of the annulus
    std::map<std::pair<ChordEnd::Kind, int>, Chord*> to;
    for (Chord& chord : network_.chords) to[{chord.to.kind, chord.to.index}] = &chord;
    for (const Chord& last : network_.chords) {
      if (last.to.kind != ChordEnd::Kind::Leaflet) continue;
      std::vector<Chord*> path = {to.at({last.to.kind, last.to.index})};
      while (path.back()->from.kind == ChordEnd::Kind::Junction)
        path.push_back(to.at({path.back()->from.kind, path.back()->from.index}));
      const Vec3 tip = network_.papillary_closed.col(path.back()->from.index);
      double needed = 0, length = 0;
      for (int i = 0; i < kPlaces; ++i) {
        const double u = double(i) / kPlaces, leaflet = (surface_.open(u, 0) - open(last.to.index)).norm();
        needed = std::max(needed, (surface_.closed(u, 0) - tip).norm() - leaflet);
      }
      for (const Chord* chord : path) length += chord->rest_length;
      if (length >= needed) continue;
      for (Chord* chord : path) {
        const double most = (1 + kMostSlack) * (position(chord->to) - position(chord->from)).norm();
        chord->rest_length =
            std::max(chord->rest_length, std::min(most, chord->rest_length * needed / length));
      }
    }
  }

  const RoughSurface& surface_;
  const RoughMesh& mesh_;
  RandomSource& random_;
  ChordNetwork network_;
  Points foreseen_tips_;  // closed, as lengths take them
  std::vector<Vec3> junctions_;
  std::vector<bool> is_rim_;
  std::set<int> taken_;
};

}  // namespace

ChordNetwork rough_chords(const RoughSurface& surface, const RoughMesh& mesh, RandomSource& random) {
  RoughChordBuilder builder(surface, mesh, random);
  for (const RoughTree& tree : planned_trees(surface, random)) builder.add(tree);
  return builder.finished();
}

}  // namespace coapt
