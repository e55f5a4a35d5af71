#include "valve/generators/rough_chords.hpp"

#include "valve/generators/rough_chord_plan.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace coapt {
namespace {

// Strands while they are built: their rest lengths are those of the closed valve.
class RoughChordBuilder {
 public:
  RoughChordBuilder(const RoughSurface& surface, const RoughMesh& mesh, RandomSource& random)
      : surface_(surface),
        mesh_(mesh),
        random_(random),
        tight_share_(random.between(0.3, 1)),
        short_share_(random.between(0.01, 0.06)),
        foresight_(random.chance(0.3) ? 0 : random.between(0.3, 1)) {
    network_.papillary = surface.tips;
    network_.papillary_closed = surface.tips_closed;
    const auto count = static_cast<size_t>(mesh.leaflets.vertex_count());
    strands_at_.resize(count, 0);
    is_rim_.resize(count, false);
    for (int v = 0; v < mesh.leaflets.vertex_count(); ++v)
      is_rim_[v] = mesh.coordinates(1, v) <= 0 || mesh.coordinates(1, v) >= 1;
  }

  // Leaves out each insertion with the probability 1 - kept.
  void add(const RoughTree& tree, double kept) {
    std::vector<std::vector<int>> fans;
    std::set<int> taken;
    Vec3 closed_sum = Vec3::Zero(), open_sum = Vec3::Zero();
    int count = 0;
    for (const RoughFan& fan : tree.fans) {
      fans.emplace_back();
      for (const RoughInsertion& insertion : fan) {
        if (!random_.chance(kept)) continue;
        const int v = near_vertex(insertion, taken);
        if (v < 0) continue;
        taken.insert(v);
        fans.back().push_back(v);
        closed_sum += closed(v), open_sum += open(v), ++count;
      }
      if (fans.back().empty()) fans.pop_back();
    }
    if (count == 0) return;
    for (const int v : taken) ++strands_at_[v];
    const int tip = chosen_tip(tree.group, open_sum / count);
    // Lengths take no account of how the tips move: on that way chords pull.
    const Vec3 at = surface_.tips.col(tip);
    const Place from{{ChordEnd::Kind::Papillary, tip}, at, at};
    if (fans.size() == 1) return add_fan(from, fans[0], tree, 1);
    const Place fork = add_junction(from, closed_sum / count, open_sum / count, random_.between(0.3, 0.45));
    add_strand(from, fork, tree, count, 1);
    for (const std::vector<int>& fan : fans) add_fan(fork, fan, tree, 2);
  }

  ChordNetwork finished() {
    relax();
    tighten();
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

  // The nearest vertex (of the margin for t = 1, else of the inside) that is not in `taken`; -1: it is far.
  int near_vertex(const RoughInsertion& insertion, const std::set<int>& taken) const {
    constexpr double kFar = 3;  // [mm]
    constexpr int kMostStrands = 5;
    const Vec3 point = surface_.open(insertion.u, insertion.t);
    int best = -1;
    double least = kFar * kFar;
    for (int v = 0; v < mesh_.leaflets.vertex_count(); ++v) {
      const bool fits = insertion.t < 1 ? !is_rim_[v] : mesh_.coordinates(1, v) >= 1;
      if (!fits || strands_at_[v] >= kMostStrands || taken.contains(v)) continue;
      const double distance = (open(v) - point).squaredNorm();
      if (distance < least) best = v, least = distance;
    }
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
      fans_.push_back({network_.chords.size(), vertices.size(), from.closed});
      add_strand(from, root, tree, count, level++);
    } else if (!lone_.insert({from.end.kind, from.end.index, vertices[0]}).second) {
      return;
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
  void relax() {
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

  double open_length(const Chord& chord) const { return (position(chord.to) - position(chord.from)).norm(); }

  // Gives some fans what measured valves have: strands as long as they are in the open valve, to the last
  // digit, and all slack in the trunk, which is as long as the farthest insertion asks for.
  void tighten() {
    for (const Fan& fan : fans_) {
      if (!random_.chance(tight_share_)) continue;
      Chord& trunk = network_.chords[fan.trunk];
      trunk.rest_length = 0;
      for (size_t i = fan.trunk + 1; i <= fan.trunk + fan.strands; ++i) {
        Chord& strand = network_.chords[i];
        strand.rest_length = open_length(strand);
        const double needed = (closed(strand.to.index) - fan.root_closed).norm() - strand.rest_length;
        trunk.rest_length = std::max(trunk.rest_length, needed);
      }
    }
  }

  void cut_lengths() {
    for (Chord& chord : network_.chords) {
      const double length = open_length(chord);
      const double slack = std::clamp(chord.rest_length - length, 0.0, kMostSlack * length);
      chord.rest_length = length + foresight_ * slack;
      const bool is_short = random_.chance(short_share_);
      const double shortage = random_.between(0.01, kMostShortage);
      if (is_short) chord.rest_length = (1 - shortage) * length;
    }
  }

  // Lengthens strands between a tip and a vertex that could not reach it in the closed valve, not even with
  // the leaflet drawn straight from the annulus: first those at the tip.
  void reach_leaflets() {
    constexpr int kPlaces = 60;  // of the annulus
    Points rim_open(3, kPlaces), rim_closed(3, kPlaces);
    for (int i = 0; i < kPlaces; ++i) {
      rim_open.col(i) = surface_.open(double(i) / kPlaces, 0);
      rim_closed.col(i) = surface_.closed(double(i) / kPlaces, 0);
    }
    std::map<int, Chord*> to;  // each junction
    for (Chord& chord : network_.chords)
      if (chord.to.kind == ChordEnd::Kind::Junction) to[chord.to.index] = &chord;
    for (Chord& last : network_.chords) {
      if (last.to.kind != ChordEnd::Kind::Leaflet) continue;
      std::vector<Chord*> path = {&last};
      while (path.back()->from.kind == ChordEnd::Kind::Junction)
        path.push_back(to.at(path.back()->from.index));
      const Vec3 tip = network_.papillary_closed.col(path.back()->from.index), end = open(last.to.index);
      double missing =
          ((rim_closed.colwise() - tip).colwise().norm() - (rim_open.colwise() - end).colwise().norm())
              .maxCoeff();
      for (const Chord* chord : path) missing -= chord->rest_length;
      for (auto chord = path.rbegin(); chord != path.rend() && missing > 0; ++chord) {
        const double most = (1 + kMostSlack) * open_length(**chord);
        const double more = std::clamp(most - (*chord)->rest_length, 0.0, missing);
        (*chord)->rest_length += more;
        missing -= more;
      }
    }
  }

  // A trunk and the strands behind its branch point, which follow it in the list of chords.
  struct Fan {
    size_t trunk, strands;
    Vec3 root_closed;  // the trunk's other end
  };

  const RoughSurface& surface_;
  const RoughMesh& mesh_;
  RandomSource& random_;
  double tight_share_, short_share_;  // of fans; of strands
  double foresight_;                  // share of the slack that closing asks for
  ChordNetwork network_;
  std::vector<Fan> fans_;
  std::vector<Vec3> junctions_;
  std::vector<bool> is_rim_;
  std::vector<int> strands_at_;                          // each vertex
  std::set<std::tuple<ChordEnd::Kind, int, int>> lone_;  // strands without a branch point: from, vertex
};

}  // namespace

ChordNetwork rough_chords(const RoughSurface& surface, const RoughMesh& mesh, RandomSource& random) {
  constexpr double kMostPerVertex = 0.43;  // as in the coarse mesh of the human tricuspid valve
  const std::vector<RoughTree> plan = rough_chord_plan(surface, random);
  double planned = 0;
  for (const RoughTree& tree : plan)
    for (const RoughFan& fan : tree.fans) planned += static_cast<double>(fan.size());
  const double kept = std::min(1.0, kMostPerVertex * mesh.leaflets.vertex_count() / planned);
  RoughChordBuilder builder(surface, mesh, random);
  for (const RoughTree& tree : plan) builder.add(tree, kept);
  return builder.finished();
}

}  // namespace coapt
