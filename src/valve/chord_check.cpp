#include "core/number_text.hpp"
#include "valve/detail/bare_leaflets.hpp"
#include "valve/valve_check.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <queue>
#include <set>

namespace coapt {
namespace {

constexpr double kNoLength = 1e-6;  // of the median rest length
constexpr size_t kNamed = 10;
constexpr size_t kFewFans = 2;      // with strands that end together: one alone is a slip
constexpr double kManyFans = 0.08;  // of all fans, that a coarse mesh makes end together
constexpr double kAllSlack = 0.5;   // strain, below zero, of the tautest way; of valves at hand at most 0.13

constexpr const char* kLengths = "`rest_length`, its unit and any `length_scale`";

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

// Strands of each fan: from a junction or a tip straight to leaflets.
std::map<int, std::vector<int>> fans(const Valve& valve, const ChordGraph& graph) {
  std::map<int, std::vector<int>> strands;
  for (size_t k = 0; k < valve.chords.chords.size(); ++k) {
    const Chord& chord = valve.chords.chords[k];
    const int from = graph.point(chord.from), to = graph.point(chord.to);
    if (graph.is_leaflet(from) != graph.is_leaflet(to))
      strands[graph.is_leaflet(to) ? from : to].push_back(static_cast<int>(k));
  }
  return strands;
}

// Strands of fans that end on a mesh coarser than themselves. There many fans have strands that end together:
// few are slips. A copied strand makes its fan larger than all others, and in a network that is copied as a
// whole half of all strands are repeated.
std::set<int> fanned_together(const Valve& valve, const ChordGraph& graph, const std::set<int>& repeated) {
  std::map<size_t, int> sizes;
  size_t strands = 0, many = 0, together = 0;
  const std::map<int, std::vector<int>> all = fans(valve, graph);
  const auto repeats = [&](const std::vector<int>& fan) {
    return std::count_if(fan.begin(), fan.end(), [&](int k) { return repeated.contains(k); });
  };
  for (const auto& [from, fan] : all) {
    ++sizes[fan.size()];
    strands += fan.size();
    together += static_cast<size_t>(repeats(fan));
    many += repeats(fan) > 0 ? 1 : 0;
  }
  std::set<int> meant;
  if (many < kFewFans || 2 * together >= strands ||
      static_cast<double>(many) < kManyFans * static_cast<double>(all.size()))
    return meant;
  for (const auto& [from, fan] : all)
    if (sizes[fan.size()] > 1) meant.insert(fan.begin(), fan.end());
  return meant;
}

void find_repeated(const Valve& valve, const ChordGraph& graph, std::vector<std::string>& doubts) {
  std::set<std::array<int, 2>> seen;
  std::set<int> repeated;
  for (size_t k = 0; k < valve.chords.chords.size(); ++k) {
    const Chord& chord = valve.chords.chords[k];
    std::array<int, 2> ends = {graph.point(chord.from), graph.point(chord.to)};
    std::sort(ends.begin(), ends.end());
    if (!seen.insert(ends).second) repeated.insert(static_cast<int>(k));
  }
  if (repeated.empty()) return;
  const std::set<int> meant = fanned_together(valve, graph, repeated);
  std::vector<int> doubtful;
  std::set_difference(repeated.begin(), repeated.end(), meant.begin(), meant.end(),
                      std::back_inserter(doubtful));
  if (!doubtful.empty())
    doubts.push_back(
        named("chord", "chords", doubtful) + ": " + (doubtful.size() == 1 ? "joins" : "each joins") +
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

// Along the least way from a tip: its length at rest, that at which some chord of it is beyond what it bears
// (infinite: none ever is), and the chord that arrives.
struct Way {
  double length = 0, bearable = 0;
  int chord = -1;
};

// From a tip to each point.
std::map<int, Way> reach(const ChordGraph& graph, const ChordLimits& limits, int tip) {
  std::map<int, Way> result;
  struct Arrival {
    int at = 0;
    Way way;
    bool operator>(const Arrival& other) const { return way.length > other.way.length; }
  };
  std::priority_queue<Arrival, std::vector<Arrival>, std::greater<>> open;
  open.push({tip, {}});
  while (!open.empty()) {
    const Arrival arrival = open.top();
    const auto& [here, way] = arrival;
    open.pop();
    if (!result.emplace(here, way).second || graph.is_leaflet(here)) continue;
    for (const int k : graph.chords_at(here)) {
      const Chord& chord = graph.chord(k);
      open.push({graph.other_end(k, here),
                 {way.length + chord.rest_length,
                  way.bearable + chord.rest_length * (1 + limits.strain(chord.material)), k}});
    }
  }
  return result;
}

// Of one insertion, by the least way from a tip to it.
struct Stretch {
  double open = 0, closed = 0;  // strain that no place of the junctions takes away
  double length = 0;
  double distance = 0, distance_closed = 0;
  double bearable = 0;  // strain at which some chord on the way is beyond what it bears
  int chord = 0;
  bool knows_closed = false;  // where the leaflets go; else they may yet come to the tip

  bool is_doubtful() const {
    const double both = std::min(open, closed);
    return both > std::min(kOverstretched, bearable) || closed > kOverstretchedClosed ||
           (knows_closed && closed > bearable);
  }
};

bool has_closed_leaflets(const Valve& valve) {
  return valve.closed_reference && valve.closed_reference->vertex_count() == valve.leaflets.vertex_count();
}

std::vector<Stretch> stretches(const Valve& valve, const ChordGraph& graph, const ChordLimits& limits) {
  const ChordNetwork& chords = valve.chords;
  const Points& open = valve.leaflets.vertices;
  const Points& closed = has_closed_leaflets(valve) ? valve.closed_reference->vertices : open;
  const Points& tips_closed = chords.papillary_closed.cols() > 0 ? chords.papillary_closed : chords.papillary;
  std::vector<Stretch> list;
  for (int tip = 0; tip < graph.tip_count(); ++tip)
    for (const auto& [point, way] : reach(graph, limits, tip)) {
      if (!graph.is_leaflet(point) || way.length <= 0) continue;
      const int v = graph.vertex(point);
      const double apart = (open.col(v) - chords.papillary.col(tip)).norm();
      const double apart_closed = (closed.col(v) - tips_closed.col(tip)).norm();
      list.push_back({apart / way.length - 1, apart_closed / way.length - 1, way.length, apart, apart_closed,
                      way.bearable / way.length - 1, way.chord, has_closed_leaflets(valve)});
    }
  return list;
}

void find_overstretched(const Valve& valve, const std::vector<Stretch>& all,
                        std::vector<std::string>& doubts) {
  std::map<int, Stretch> worst;  // by chord
  for (const Stretch& stretch : all) {
    if (!stretch.is_doubtful()) continue;
    const auto [known, is_new] = worst.emplace(stretch.chord, stretch);
    if (!is_new && stretch.closed > known->second.closed) known->second = stretch;
  }
  if (worst.empty()) return;
  std::vector<Stretch> list;
  for (const auto& [chord, stretch] : worst) list.push_back(stretch);
  std::stable_sort(list.begin(), list.end(),
                   [](const Stretch& l, const Stretch& r) { return l.closed > r.closed; });
  std::vector<int> numbers;
  for (const Stretch& stretch : list) numbers.push_back(stretch.chord);
  const Stretch& most = list.front();
  const bool is_moved = has_closed_leaflets(valve) || valve.chords.papillary_closed.cols() > 0;
  std::string text = named("chord", "chords", numbers) + ": " + std::to_string(list.size()) +
                     (list.size() == 1 ? " insertion lies" : " insertions lie") +
                     " farther from the papillary tip than the chords to it are long";
  if (is_moved)
    text += std::min(most.open, most.closed) > std::min(kOverstretched, most.bearable)
                ? ", in the open and the closed position"
                : ", in the closed position";
  text += "; worst: " + number_text(most.distance_closed) + " mm apart with " + number_text(most.length) +
          " mm of chord, a strain of " + number_text(100 * most.closed) + " %";
  if (is_moved) text += " (open: " + number_text(100 * most.open) + " %)";
  if (most.closed > most.bearable)
    text += ", where by their law some chord on the way pulls with more than " +
            number_text(kMostChordStress, 4) + " MPa (from " + number_text(100 * most.bearable) + " % on)";
  doubts.push_back(text + ". Check rest lengths, their unit and the place of the tips.");
}

// Chords much longer than the way bind nothing; where that holds of all of them a unit was misread, or a
// factor.
void find_all_slack(const std::vector<Stretch>& all, std::vector<std::string>& doubts) {
  const auto strain = [](const Stretch& stretch) { return std::max(stretch.open, stretch.closed); };
  const auto tautest = std::max_element(
      all.begin(), all.end(), [&](const Stretch& l, const Stretch& r) { return strain(l) < strain(r); });
  if (tautest == all.end() || strain(*tautest) >= -kAllSlack) return;
  doubts.push_back("all chords are slack: even the tautest way from a papillary tip to a leaflet, by chord " +
                   std::to_string(tautest->chord) + ", is " + number_text(tautest->length) +
                   " mm long for a distance of " +
                   number_text(std::max(tautest->distance, tautest->distance_closed)) +
                   " mm, in the open and the closed position. Check " + kLengths + ".");
}

}  // namespace

double ChordLimits::strain(const std::string& material) const {
  const auto own = by_material.find(material);
  return own == by_material.end() ? of_all : std::min(own->second, of_all);
}

std::vector<std::string> chord_doubts(const Valve& valve, const ChordLimits& limits, bool names_repeated,
                                      Numbering numbering) {
  std::vector<std::string> doubts;
  if (valve.chords.chords.empty()) {
    const auto tips = valve.chords.papillary.cols();
    if (tips == 0) return doubts;
    return {"has " + std::to_string(tips) + (tips == 1 ? " papillary tip" : " papillary tips") +
            " and no chords: nothing holds the free edge, and pressure will turn the leaflets over. Add the "
            "chords; `coapt chords` makes some from the tips."};
  }
  const ChordGraph graph(valve);
  if (names_repeated) find_repeated(valve, graph, doubts);
  find_without_length(valve, doubts);
  find_loose_ends(graph, doubts);
  find_unheld(valve, graph, doubts);
  for (const std::string& bare : detail::bare_leaflets(valve, numbering)) doubts.push_back(bare);
  const std::vector<Stretch> ways = stretches(valve, graph, limits);
  find_overstretched(valve, ways, doubts);
  find_all_slack(ways, doubts);
  return doubts;
}

}  // namespace coapt
