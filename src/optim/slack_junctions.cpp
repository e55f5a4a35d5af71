#include "optim/slack_junctions.hpp"

#include "energy/term_access.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace coapt {
namespace {

constexpr double kSlack = 1e-4;  // of its length, by which a line is to be slack
constexpr int kSweeps = 100;     // of projections; where there is room, few do

const TermAccess* lines_of(const EnergyTerm& term) {
  const TermAccess* access = access_of(term);
  return access != nullptr && access->kind() == TermKind::Line && access->has_lines() ? access : nullptr;
}

bool can_be_slack(const TermAccess& lines, int element) {
  const double length = lines.line(element).length;
  return length > 0 && lines.line_law(element)(length / 2).force == 0;
}

template <class Visit>
void visit_elements(const Objective& objective, const Visit& visit) {
  for (const auto& term : objective.terms()) {
    const Stencils& stencils = term->stencils();
    for (int e = 0; e < stencils.count(); ++e)
      visit(*term, e, stencils.nodes.data() + e * stencils.width, stencils.width);
  }
}

// By node: that lines which can be slack end there and nothing else holds it.
std::vector<char> find_junctions(const Objective& objective) {
  const auto count = static_cast<size_t>(objective.node_count());
  std::vector<char> has_line(count, 0), is_held(count, 0);
  for (size_t node = 0; node < count; ++node)
    is_held[node] = objective.fixed().col(static_cast<Eigen::Index>(node)).any();
  visit_elements(objective, [&](const EnergyTerm& term, int element, const int* nodes, int width) {
    const TermAccess* access = lines_of(term);
    const bool is_line = access != nullptr && can_be_slack(*access, element);
    for (int k = 0; k < width; ++k) (is_line ? has_line : is_held)[static_cast<size_t>(nodes[k])] = 1;
  });
  for (size_t node = 0; node < count; ++node) has_line[node] = has_line[node] && !is_held[node];
  return has_line;
}

}  // namespace

SlackJunctions::SlackJunctions(const Objective& objective) {
  const std::vector<char> is_junction = find_junctions(objective);
  if (std::none_of(is_junction.begin(), is_junction.end(), [](char is) { return is; })) return;

  std::vector<int> root(is_junction.size());  // of the tree that a node belongs to, by union of its lines
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int node) {
    while (root[static_cast<size_t>(node)] != node) node = root[static_cast<size_t>(node)];
    return node;
  };
  std::vector<Line> lines;
  visit_elements(objective, [&](const EnergyTerm& term, int element, const int* nodes, int width) {
    if (width != 2) return;
    const std::array<bool, 2> ends{is_junction[static_cast<size_t>(nodes[0])] != 0,
                                   is_junction[static_cast<size_t>(nodes[1])] != 0};
    if (!ends[0] && !ends[1]) return;
    lines.push_back({lines_of(term), element, {nodes[0], nodes[1]}, ends});
    if (ends[0] && ends[1]) root[static_cast<size_t>(find(nodes[0]))] = find(nodes[1]);
  });

  std::vector<int> tree(root.size(), -1);
  for (size_t node = 0; node < root.size(); ++node) {
    if (!is_junction[node]) continue;
    int& index = tree[static_cast<size_t>(find(static_cast<int>(node)))];
    if (index < 0) {
      index = static_cast<int>(trees_.size());
      trees_.emplace_back();
    }
    trees_[static_cast<size_t>(index)].junctions.push_back(static_cast<int>(node));
  }
  for (const Line& line : lines) {
    const int junction = line.nodes[line.is_junction[0] ? 0 : 1];
    trees_[static_cast<size_t>(tree[static_cast<size_t>(find(junction))])].lines.push_back(line);
  }

  x_ = objective.positions(objective.unknowns());
  int blocks = 0;
  for (int node = 0; node < objective.node_count(); ++node)
    block_.push_back(objective.fixed().col(node).all() ? -1 : blocks++);
}

void SlackJunctions::place_lines(const Vector& q) {
  for (const Tree& tree : trees_)
    for (const Line& line : tree.lines)
      for (const int node : line.nodes)
        if (const int block = block_[static_cast<size_t>(node)]; block >= 0)
          x_.col(node) = q.segment<3>(3 * block);
}

double SlackJunctions::force(const Line& line) const {
  Eigen::Vector<double, 6> x, g;
  x << x_.col(line.nodes[0]), x_.col(line.nodes[1]);
  line.term->evaluate_element(line.element, x.data(), g.data(), nullptr);
  return g.head<3>().norm();
}

bool SlackJunctions::is_slack(const Line& line) const {
  return length(line) <= (1 - kSlack / 2) * line.term->line(line.element).length;
}

// By projections onto the balls around the other ends (Bregman 1967), whose lines are shorter by kSlack.
bool SlackJunctions::settle(const Tree& tree, double most) {
  const auto& lines = tree.lines;
  const auto all_slack = [&] {
    return std::all_of(lines.begin(), lines.end(), [this](const Line& line) { return is_slack(line); });
  };
  if (all_slack()) return false;
  if (!std::all_of(lines.begin(), lines.end(), [&](const Line& line) { return force(line) < most; }))
    return false;
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (const Line& line : lines) {
      if (is_slack(line)) continue;
      const Vec3 along = x_.col(line.nodes[1]) - x_.col(line.nodes[0]);
      const double target = (1 - kSlack) * line.term->line(line.element).length;
      const int movable = line.is_junction[0] && line.is_junction[1] ? 2 : 1;
      const Vec3 step = (1 - target / along.norm()) / movable * along;
      if (line.is_junction[0]) x_.col(line.nodes[0]) += step;
      if (line.is_junction[1]) x_.col(line.nodes[1]) -= step;
    }
    if (all_slack()) return true;
  }
  return false;
}

bool SlackJunctions::settle(double most, Vector& q) {
  place_lines(q);
  bool has_moved = false;
  for (const Tree& tree : trees_) {
    if (!settle(tree, most)) continue;
    has_moved = true;
    for (const int node : tree.junctions) q.segment<3>(3 * block_[static_cast<size_t>(node)]) = x_.col(node);
  }
  return has_moved;
}

}  // namespace coapt
