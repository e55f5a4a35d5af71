#include "core/number_text.hpp"
#include "valve/valve_check.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <queue>
#include <set>

namespace coapt {
namespace {

constexpr double kNoLength = 1e-6;  // of the median rest length
constexpr size_t kNamed = 10;

using Kind = ChordEnd::Kind;

std::string named(const std::string& one, const std::string& many, const std::vector<int>& numbers) {
  std::string text = numbers.size() == 1 ? one : many;
  for (size_t k = 0; k < std::min(kNamed, numbers.size()); ++k)
    text.append(k == 0 ? " " : ", ").append(std::to_string(numbers[k]));
  if (numbers.size() > kNamed) text += " and " + std::to_string(numbers.size() - kNamed) + " more";
  return text;
}

// Tips, then junctions, then leaflet vertices.
class ChordGraph {
 public:
  explicit ChordGraph(const Valve& valve)
      : valve_(valve),
        tips_(static_cast<int>(valve.chords.papillary.cols())),
        junctions_(static_cast<int>(valve.chords.junctions.cols())),
        at_(static_cast<size_t>(tips_ + junctions_ + valve.leaflets.vertex_count())) {
    const std::vector<Chord>& chords = valve.chords.chords;
    for (size_t k = 0; k < chords.size(); ++k) {
      at_[static_cast<size_t>(point(chords[k].from))].push_back(static_cast<int>(k));
      at_[static_cast<size_t>(point(chords[k].to))].push_back(static_cast<int>(k));
    }
  }

  int tip_count() const { return tips_; }
  int junction_count() const { return junctions_; }
  bool is_leaflet(int point) const { return point >= tips_ + junctions_; }
  int vertex(int point) const { return point - tips_ - junctions_; }
  const std::vector<int>& chords_at(int point) const { return at_[static_cast<size_t>(point)]; }
  const std::vector<int>& chords_at_junction(int junction) const { return chords_at(tips_ + junction); }

  int point(const ChordEnd& end) const {
    return end.kind == Kind::Papillary  ? end.index
           : end.kind == Kind::Junction ? tips_ + end.index
                                        : tips_ + junctions_ + end.index;
  }
  const Chord& chord(int k) const { return valve_.chords.chords[static_cast<size_t>(k)]; }
  int other_end(int k, int here) const {
    const int from = point(chord(k).from), to = point(chord(k).to);
    return from == here ? to : from;
  }

 private:
  const Valve& valve_;
  int tips_, junctions_;
  std::vector<std::vector<int>> at_;
};

void find_repeated(const Valve& valve, const ChordGraph& graph, std::vector<std::string>& doubts) {
  std::map<std::array<int, 2>, int> first;
  std::vector<int> repeated;
  for (size_t k = 0; k < valve.chords.chords.size(); ++k) {
    const Chord& chord = valve.chords.chords[k];
    std::array<int, 2> ends = {graph.point(chord.from), graph.point(chord.to)};
    std::sort(ends.begin(), ends.end());
    if (!first.emplace(ends, static_cast<int>(k)).second) repeated.push_back(static_cast<int>(k));
  }
  if (!repeated.empty())
    doubts.push_back(
        named("chord", "chords", repeated) + ": " + (repeated.size() == 1 ? "joins" : "each joins") +
        " the same two points as an earlier one, and their stiffness adds up; right where a fan of "
        "chords ends at one vertex of a coarse mesh, else leave it out.");
}

void find_without_length(const Valve& valve, std::vector<std::string>& doubts) {
  std::vector<double> lengths;
  for (const Chord& chord : valve.chords.chords) lengths.push_back(chord.rest_length);
  if (lengths.empty()) return;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  std::vector<int> without;
  for (size_t k = 0; k < valve.chords.chords.size(); ++k)
    if (valve.chords.chords[k].rest_length <= kNoLength * *middle) without.push_back(static_cast<int>(k));
  if (!without.empty())
    doubts.push_back(named("chord", "chords", without) +
                     ": of no rest length, so that strain is not defined; give it a length, or join its two "
                     "ends to one point.");
}

void find_loose_ends(const ChordGraph& graph, std::vector<std::string>& doubts) {
  std::vector<int> dead;
  for (int j = 0; j < graph.junction_count(); ++j)
    if (graph.chords_at_junction(j).size() < 2) dead.push_back(j);
  if (!dead.empty())
    doubts.push_back(
        named("junction", "junctions", dead) + ": " + (dead.size() == 1 ? "ends" : "each ends") +
        " a single chord, which then carries nothing; give it the missing chord, or remove both.");
}

// From the tips along the chords, through junctions but not through leaflets.
void find_unheld(const Valve& valve, const ChordGraph& graph, std::vector<std::string>& doubts) {
  if (graph.tip_count() == 0) return;
  std::vector<bool> is_reached(valve.chords.chords.size(), false);
  std::vector<int> open;
  std::set<int> seen;
  for (int tip = 0; tip < graph.tip_count(); ++tip) open.push_back(tip);
  while (!open.empty()) {
    const int here = open.back();
    open.pop_back();
    if (!seen.insert(here).second || graph.is_leaflet(here)) continue;
    for (const int k : graph.chords_at(here)) {
      is_reached[static_cast<size_t>(k)] = true;
      open.push_back(graph.other_end(k, here));
    }
  }
  std::vector<int> unheld;
  for (size_t k = 0; k < is_reached.size(); ++k)
    if (!is_reached[k]) unheld.push_back(static_cast<int>(k));
  if (!unheld.empty())
    doubts.push_back(named("chord", "chords", unheld) +
                     ": no way along chords leads from a papillary tip here; correct `from` and `to`, or "
                     "leave it out.");
}

void find_bare_regions(const Valve& valve, std::vector<std::string>& doubts) {
  const TriangleMesh& mesh = valve.leaflets;
  if (valve.chords.chords.empty() || mesh.region_names.empty()) return;
  std::vector<bool> is_held(static_cast<size_t>(mesh.vertex_count()), false);
  for (const Chord& chord : valve.chords.chords)
    for (const ChordEnd& end : {chord.from, chord.to})
      if (end.kind == Kind::Leaflet) is_held[static_cast<size_t>(end.index)] = true;
  std::vector<int> triangles(mesh.region_names.size(), 0), ends = triangles;
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto region = static_cast<size_t>(mesh.regions[static_cast<size_t>(t)]);
    ++triangles[region];
    for (const int v : mesh.triangles.col(t)) ends[region] += is_held[static_cast<size_t>(v)] ? 1 : 0;
  }
  std::string bare;
  for (size_t r = 0; r < ends.size(); ++r)
    if (triangles[r] > 0 && ends[r] == 0)
      bare += (bare.empty() ? "\"" : ", \"") + mesh.region_names[r] + "\"";
  if (!bare.empty())
    doubts.push_back("region " + bare +
                     ": no chord inserts there while others have chords; pressure will turn it over unless "
                     "something else holds its free edge. Add the missing chords.");
}

// The least length of chords from a tip to each point, and the chord that arrives there.
std::map<int, std::pair<double, int>> reach(const ChordGraph& graph, int tip) {
  std::map<int, std::pair<double, int>> result;
  using Entry = std::pair<double, std::pair<int, int>>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  open.push({0, {tip, -1}});
  while (!open.empty()) {
    const auto [length, arrival] = open.top();
    const auto [here, by] = arrival;
    open.pop();
    if (!result.emplace(here, std::pair(length, by)).second || graph.is_leaflet(here)) continue;
    for (const int k : graph.chords_at(here))
      open.push({length + graph.chord(k).rest_length, {graph.other_end(k, here), k}});
  }
  return result;
}

struct Stretch {
  double open = 0, closed = 0;  // strain that no place of the junctions takes away
  double length = 0, distance = 0;
  int chord = 0;
};

void find_overstretched(const Valve& valve, const ChordGraph& graph, std::vector<std::string>& doubts) {
  const ChordNetwork& chords = valve.chords;
  const Points& open = valve.leaflets.vertices;
  const bool has_closed =
      valve.closed_reference && valve.closed_reference->vertex_count() == valve.leaflets.vertex_count();
  const Points& closed = has_closed ? valve.closed_reference->vertices : open;
  const Points& tips_closed = chords.papillary_closed.cols() > 0 ? chords.papillary_closed : chords.papillary;
  std::map<int, Stretch> worst;  // by chord
  for (int tip = 0; tip < graph.tip_count(); ++tip)
    for (const auto& [point, arrival] : reach(graph, tip)) {
      const auto& [length, chord] = arrival;
      if (!graph.is_leaflet(point) || length <= 0) continue;
      const int v = graph.vertex(point);
      const double apart = (open.col(v) - chords.papillary.col(tip)).norm();
      const double apart_closed = (closed.col(v) - tips_closed.col(tip)).norm();
      const Stretch stretch{apart / length - 1, apart_closed / length - 1, length, apart, chord};
      if (std::min(stretch.open, stretch.closed) <= kOverstretched) continue;
      Stretch& known = worst[chord];
      if (stretch.open > known.open) known = stretch;
    }
  if (worst.empty()) return;
  std::vector<Stretch> list;
  for (const auto& [chord, stretch] : worst) list.push_back(stretch);
  std::stable_sort(list.begin(), list.end(),
                   [](const Stretch& l, const Stretch& r) { return l.open > r.open; });
  std::vector<int> numbers;
  for (const Stretch& stretch : list) numbers.push_back(stretch.chord);
  const Stretch& most = list.front();
  const bool is_moved = has_closed || chords.papillary_closed.cols() > 0;
  std::string text = named("chord", "chords", numbers) + ": " + std::to_string(list.size()) +
                     (list.size() == 1 ? " insertion lies" : " insertions lie") +
                     " farther from the papillary tip than the chords to it are long";
  if (is_moved) text += ", in the open and the closed position";
  text += "; worst: " + number_text(most.distance) + " mm apart with " + number_text(most.length) +
          " mm of chord, a strain of " + number_text(100 * most.open) + " %";
  if (is_moved) text += " (closed: " + number_text(100 * most.closed) + " %)";
  doubts.push_back(text + ". Check rest lengths, their unit and the place of the tips.");
}

}  // namespace

std::vector<std::string> chord_doubts(const Valve& valve) {
  std::vector<std::string> doubts;
  if (valve.chords.chords.empty()) return doubts;
  const ChordGraph graph(valve);
  find_repeated(valve, graph, doubts);
  find_without_length(valve, doubts);
  find_loose_ends(graph, doubts);
  find_unheld(valve, graph, doubts);
  find_bare_regions(valve, doubts);
  find_overstretched(valve, graph, doubts);
  return doubts;
}

}  // namespace coapt
