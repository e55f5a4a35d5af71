#include "optim/slack_junctions.hpp"

#include "energy/term_access.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kSlack = 1e-4;  // of its length, by which a line is to be slack
const TermAccess* lines_of(const EnergyTerm& term) {
  const TermAccess* access = access_of(term);
  return access != nullptr && access->kind() == TermKind::Line && access->has_lines() ? access : nullptr;
}

bool can_be_slack(const TermAccess& lines, int element) {
  const double length = lines.line(element).length;
  return length > 0 && lines.line_law(element)(length / 2).force == 0;
}

// By node: that lines which can be slack end there and nothing else holds it.
std::vector<char> find_junctions(const Objective& objective) {
  const auto count = static_cast<size_t>(objective.node_count());
  std::vector<char> has_line(count, 0), is_held(count, 0);
  for (const auto& term : objective.terms()) {
    const TermAccess* lines = lines_of(*term);
    const Stencils& stencils = term->stencils();
    for (size_t k = 0; k < stencils.nodes.size(); ++k) {
      const bool is_line = lines != nullptr && can_be_slack(*lines, static_cast<int>(k) / stencils.width);
      (is_line ? has_line : is_held)[static_cast<size_t>(stencils.nodes[k])] = 1;
    }
  }
  for (size_t node = 0; node < count; ++node)
    has_line[node] = has_line[node] && !is_held[node] && !objective.fixed().col(static_cast<int>(node)).any();
  return has_line;
}

}  // namespace

SlackJunctions::SlackJunctions(const Objective& objective) {
  lines_.may_move = find_junctions(objective);
  const auto moves = [this](int node) { return lines_.may_move[static_cast<size_t>(node)] != 0; };
  for (const auto& term : objective.terms()) {
    const TermAccess* lines = lines_of(*term);
    for (int e = 0; lines != nullptr && e < term->stencils().count(); ++e) {
      const int* nodes = term->stencils().nodes.data() + 2 * e;
      if (!moves(nodes[0]) && !moves(nodes[1])) continue;
      lines_.ends.push_back({nodes[0], nodes[1]});
      lines_.lengths.push_back(lines->line(e).length);
      elements_.push_back({lines, e});
    }
  }
  if (elements_.empty()) return;
  trees_ = line_trees(lines_);
  x_ = objective.positions(objective.unknowns());
  int blocks = 0;
  for (int node = 0; node < objective.node_count(); ++node)
    block_.push_back(objective.fixed().col(node).all() ? -1 : blocks++);
}

double SlackJunctions::force(int line) const {
  const auto& [term, index] = elements_[static_cast<size_t>(line)];
  const auto& [a, b] = lines_.ends[static_cast<size_t>(line)];
  Eigen::Vector<double, 6> x, g;
  x << x_.col(a), x_.col(b);
  term->evaluate_element(index, x.data(), g.data(), nullptr);
  return g.head<3>().norm();
}

bool SlackJunctions::settle(double most, Vector& q) {
  for (const auto& ends : lines_.ends)
    for (const int node : ends)
      if (const int block = block_[static_cast<size_t>(node)]; block >= 0)
        x_.col(node) = q.segment<3>(3 * block);
  bool has_moved = false;
  for (const LineTree& tree : trees_) {
    const auto pulls_little = [&](int line) { return force(line) < most; };
    if (is_slack(lines_, tree, kSlack, x_) ||
        !std::all_of(tree.lines.begin(), tree.lines.end(), pulls_little) ||
        !make_slack(lines_, tree, kSlack, x_))
      continue;
    has_moved = true;
    for (const int node : tree.nodes) q.segment<3>(3 * block_[static_cast<size_t>(node)]) = x_.col(node);
  }
  return has_moved;
}

}  // namespace coapt
