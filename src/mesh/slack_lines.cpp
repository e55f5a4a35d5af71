#include "mesh/slack_lines.hpp"

#include <algorithm>
#include <numeric>

namespace coapt {
namespace {

constexpr int kSweeps = 100;  // of projections; where there is room, few do

bool is_line_slack(const SlackLines& lines, int line, double share, const Points& x) {
  const auto [a, b] = lines.ends[static_cast<size_t>(line)];
  return (x.col(b) - x.col(a)).norm() <= (1 - share / 2) * lines.lengths[static_cast<size_t>(line)];
}

void shorten(const SlackLines& lines, int line, double share, Points& x) {
  const auto [a, b] = lines.ends[static_cast<size_t>(line)];
  const bool moves_a = lines.may_move[static_cast<size_t>(a)] != 0,
             moves_b = lines.may_move[static_cast<size_t>(b)] != 0;
  const Vec3 along = x.col(b) - x.col(a);
  const double target = (1 - share) * lines.lengths[static_cast<size_t>(line)];
  const Vec3 step = (1 - target / along.norm()) / (moves_a && moves_b ? 2 : 1) * along;
  if (moves_a) x.col(a) += step;
  if (moves_b) x.col(b) -= step;
}

}  // namespace

std::vector<LineTree> line_trees(const SlackLines& lines) {
  std::vector<int> next(lines.may_move.size());  // towards the node that stands for the tree
  std::iota(next.begin(), next.end(), 0);
  const auto root = [&](int node) {
    while (next[static_cast<size_t>(node)] != node) node = next[static_cast<size_t>(node)];
    return node;
  };
  const auto moves = [&](int node) { return lines.may_move[static_cast<size_t>(node)] != 0; };
  for (const auto& [a, b] : lines.ends)
    if (moves(a) && moves(b)) next[static_cast<size_t>(root(a))] = root(b);

  std::vector<LineTree> trees;
  std::vector<int> number(next.size(), -1);
  for (int node = 0; node < static_cast<int>(next.size()); ++node) {
    if (!moves(node)) continue;
    int& tree = number[static_cast<size_t>(root(node))];
    if (tree < 0) {
      tree = static_cast<int>(trees.size());
      trees.emplace_back();
    }
    trees[static_cast<size_t>(tree)].nodes.push_back(node);
  }
  for (size_t line = 0; line < lines.ends.size(); ++line)
    for (const int node : lines.ends[line])
      if (moves(node)) {
        trees[static_cast<size_t>(number[static_cast<size_t>(root(node))])].lines.push_back(
            static_cast<int>(line));
        break;
      }
  return trees;
}

bool is_slack(const SlackLines& lines, const LineTree& tree, double share, const Points& x) {
  return std::all_of(tree.lines.begin(), tree.lines.end(),
                     [&](int line) { return is_line_slack(lines, line, share, x); });
}

bool make_slack(const SlackLines& lines, const LineTree& tree, double share, Points& x) {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    if (is_slack(lines, tree, share, x)) return true;
    for (const int line : tree.lines)
      if (!is_line_slack(lines, line, share, x)) shorten(lines, line, share, x);
  }
  return is_slack(lines, tree, share, x);
}

}  // namespace coapt
