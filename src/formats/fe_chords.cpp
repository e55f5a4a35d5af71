// From lines between nodes to a network of chords.
#include "formats/fe_model.hpp"

#include <algorithm>
#include <deque>
#include <limits>

namespace coapt::formats {
namespace {

constexpr int kFar = std::numeric_limits<int>::max();

// An unbranched chain of lines between two nodes that stay.
struct Strand {
  int from = 0, to = 0;
  double rest_length = 0;
  const FeLine* first = nullptr;
};

class Network {
 public:
  Network(FeModel& model, const std::vector<int>& vertex) : model_(model), vertex_(vertex) {
    is_left_.assign(model.lines.size(), true);
    for (size_t k = 0; k < model.lines.size(); ++k) {
      at_[model.lines[k].a].push_back(k);
      at_[model.lines[k].b].push_back(k);
    }
  }

  bool is_tip(int node) const {
    const auto found = model_.holds.find(node);
    return !is_vertex(node) && found != model_.holds.end() &&
           found->second.axes == std::array{true, true, true};
  }
  bool is_vertex(int node) const { return vertex_[static_cast<size_t>(node)] >= 0; }

  // Nodes of lines that are held in some coordinates only: a scene cannot say so.
  void refuse_partial_holds(Defects& defects) const {
    for (const auto& [node, lines] : at_) {
      const auto found = model_.holds.find(node);
      if (is_vertex(node) || found == model_.holds.end() || is_tip(node)) continue;
      if (found->second.axes != std::array{false, false, false})
        defects.add("node", model_.labels[static_cast<size_t>(node)],
                    "a node of chords is held in some coordinates only; hold it in all, or in none");
    }
  }

  // A line with an end that nothing holds carries nothing.
  void cut_free_ends() {
    std::deque<int> loose;
    for (const auto& [node, lines] : at_) loose.push_back(node);
    size_t cut = 0;
    while (!loose.empty()) {
      const int node = loose.front();
      loose.pop_front();
      const std::vector<size_t> lines = left_at(node);
      if (lines.size() != 1 || is_vertex(node) || is_tip(node)) continue;
      is_left_[lines[0]] = false;
      ++cut;
      loose.push_back(other_end(lines[0], node));
    }
    if (cut > 0)
      model_.warnings.push_back(model_.file + ": " + std::to_string(cut) +
                                " lines of chords that end at nothing were left out.");
  }

  std::vector<Strand> strands() {
    std::vector<Strand> result;
    size_t rings = 0;
    for (size_t k = 0; k < model_.lines.size(); ++k) {
      if (!is_left_[k]) continue;
      for (const int end : {model_.lines[k].a, model_.lines[k].b}) {
        if (!is_left_[k] || !stays(end)) continue;
        Strand strand = walk(k, end);
        if (strand.from == strand.to)
          ++rings;
        else
          result.push_back(strand);
      }
    }
    // What is left are rings without a branch: no end, nothing to hold.
    rings += static_cast<size_t>(std::count(is_left_.begin(), is_left_.end(), true));
    if (rings > 0)
      model_.warnings.push_back(model_.file + ": chords that run back to where they begin were left out (" +
                                std::to_string(rings) + " lines or strands).");
    return result;
  }

 private:
  std::vector<size_t> left_at(int node) const {
    std::vector<size_t> lines;
    for (const size_t k : at_.at(node))
      if (is_left_[k]) lines.push_back(k);
    return lines;
  }

  int other_end(size_t line, int node) const {
    return model_.lines[line].a == node ? model_.lines[line].b : model_.lines[line].a;
  }

  // Whether the node is an end of chords: of the whole network, whatever has been walked.
  bool stays(int node) {
    if (ends_.empty())
      for (const auto& [other, lines] : at_) {
        const std::vector<size_t> left = left_at(other);
        const bool passes = model_.merges_chains && left.size() == 2 && !is_vertex(other) && !is_tip(other) &&
                            model_.lines[left[0]].material == model_.lines[left[1]].material &&
                            model_.lines[left[0]].area == model_.lines[left[1]].area;
        ends_[other] = !passes;
      }
    return ends_.at(node);
  }

  Strand walk(size_t line, int from) {
    Strand strand{from, from, 0, &model_.lines[line]};
    while (true) {
      is_left_[line] = false;
      strand.rest_length += model_.lines[line].rest_length;
      strand.to = other_end(line, strand.to);
      if (stays(strand.to)) return strand;
      const std::vector<size_t> next = left_at(strand.to);
      if (next.empty()) return strand;
      line = next[0];
    }
  }

  FeModel& model_;
  const std::vector<int>& vertex_;
  std::map<int, std::vector<size_t>> at_;  // lines at each node
  std::vector<bool> is_left_;
  std::map<int, bool> ends_;
};

// Number of strands between each node and the nearest tip.
std::map<int, int> depths(const std::vector<Strand>& strands, const Network& network) {
  std::map<int, std::vector<int>> neighbours;
  for (const Strand& strand : strands) {
    neighbours[strand.from].push_back(strand.to);
    neighbours[strand.to].push_back(strand.from);
  }
  std::map<int, int> depth;
  std::deque<int> front;
  for (const auto& [node, others] : neighbours) {
    depth[node] = network.is_tip(node) ? 0 : kFar;
    if (network.is_tip(node)) front.push_back(node);
  }
  while (!front.empty()) {
    const int node = front.front();
    front.pop_front();
    for (const int other : neighbours[node])
      if (depth[other] == kFar) {
        depth[other] = depth[node] + 1;
        front.push_back(other);
      }
  }
  return depth;
}

// Numbers tips and junctions in the order of their nodes.
std::map<int, ChordEnd> number_ends(const std::map<int, int>& depth, const Network& network,
                                    const FeModel& model, const std::vector<int>& vertex,
                                    ChordNetwork& chords) {
  std::map<int, ChordEnd> ends;
  std::vector<int> tips, junctions;
  for (const auto& [node, steps] : depth) {
    if (network.is_vertex(node)) {
      ends[node] = {ChordEnd::Kind::Leaflet, vertex[static_cast<size_t>(node)]};
      continue;
    }
    const bool is_tip = network.is_tip(node);
    std::vector<int>& list = is_tip ? tips : junctions;
    ends[node] = {is_tip ? ChordEnd::Kind::Papillary : ChordEnd::Kind::Junction,
                  static_cast<int>(list.size())};
    list.push_back(node);
  }
  chords.papillary = model.nodes(Eigen::all, tips);
  chords.junctions = model.nodes(Eigen::all, junctions);
  Points closed = chords.papillary;
  for (size_t k = 0; k < tips.size(); ++k)
    closed.col(static_cast<Eigen::Index>(k)) += model.holds.at(tips[k]).displacement;
  if (closed != chords.papillary) chords.papillary_closed = closed;
  return ends;
}

}  // namespace

void fill_chords(FeModel& model, const std::vector<int>& vertex, Valve& valve, Defects& defects) {
  Network network(model, vertex);
  network.refuse_partial_holds(defects);
  if (defects.any()) return;
  network.cut_free_ends();
  const std::vector<Strand> strands = network.strands();
  const std::map<int, int> depth = depths(strands, network);
  const std::map<int, ChordEnd> ends = number_ends(depth, network, model, vertex, valve.chords);
  for (const Strand& strand : strands) {
    const bool is_turned = depth.at(strand.to) < depth.at(strand.from);
    const int from = is_turned ? strand.to : strand.from, to = is_turned ? strand.from : strand.to;
    const int level = depth.at(from) == kFar ? 0 : depth.at(from) + 1;
    valve.chords.chords.push_back(
        {ends.at(from), ends.at(to), strand.rest_length, strand.first->area, strand.first->material, level});
    if (const auto found = model.cables.find(strand.first->material); found != model.cables.end())
      valve.cables.insert(*found);
  }
}

}  // namespace coapt::formats
