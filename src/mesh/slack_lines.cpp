#include "mesh/slack_lines.hpp"

#include <algorithm>
#include <numeric>

namespace coapt {
namespace {

constexpr int kSweeps = 100;  // of projections; where there is room, few do

}  // namespace

LineTrees::LineTrees(SlackLines lines)
    : lines_(std::move(lines)), moved_(3, static_cast<Eigen::Index>(lines_.may_move.size())) {
  std::vector<int> next(lines_.may_move.size());  // towards the node that stands for the tree
  std::iota(next.begin(), next.end(), 0);
  const auto root = [&](int node) {
    while (next[static_cast<size_t>(node)] != node) node = next[static_cast<size_t>(node)];
    return node;
  };
  const auto moves = [&](int node) { return lines_.may_move[static_cast<size_t>(node)] != 0; };
  for (const auto& [a, b] : lines_.ends)
    if (moves(a) && moves(b)) next[static_cast<size_t>(root(a))] = root(b);

  std::vector<int> number(next.size(), -1);
  for (int node = 0; node < static_cast<int>(next.size()); ++node) {
    if (!moves(node)) continue;
    int& tree = number[static_cast<size_t>(root(node))];
    if (tree < 0) {
      tree = static_cast<int>(trees_.size());
      trees_.emplace_back();
    }
    trees_[static_cast<size_t>(tree)].nodes.push_back(node);
  }
  for (size_t line = 0; line < lines_.ends.size(); ++line)
    for (const int node : lines_.ends[line])
      if (moves(node)) {
        trees_[static_cast<size_t>(number[static_cast<size_t>(root(node))])].lines.push_back(
            static_cast<int>(line));
        break;
      }
  std::erase_if(trees_, [](const Tree& tree) { return tree.lines.empty(); });
}

bool LineTrees::slacken(double share, Points& x) {
  moved_ = x;
  bool has_moved = false;
  for (const Tree& tree : trees_) {
    if (is_slack(tree, share, x)) continue;
    const bool has_room = make_slack(tree, share, moved_);
    for (const int node : tree.nodes) (has_room ? x : moved_).col(node) = (has_room ? moved_ : x).col(node);
    has_moved = has_moved || has_room;
  }
  return has_moved;
}

bool LineTrees::is_line_slack(int line, double share, const Points& x) const {
  const auto [a, b] = lines_.ends[static_cast<size_t>(line)];
  return (x.col(b) - x.col(a)).norm() <= (1 - share / 2) * lines_.lengths[static_cast<size_t>(line)];
}

bool LineTrees::is_slack(const Tree& tree, double share, const Points& x) const {
  return std::all_of(tree.lines.begin(), tree.lines.end(),
                     [&](int line) { return is_line_slack(line, share, x); });
}

void LineTrees::shorten(int line, double share, Points& x) const {
  const auto [a, b] = lines_.ends[static_cast<size_t>(line)];
  const bool moves_a = lines_.may_move[static_cast<size_t>(a)] != 0,
             moves_b = lines_.may_move[static_cast<size_t>(b)] != 0;
  const Vec3 along = x.col(b) - x.col(a);
  const double target = (1 - share) * lines_.lengths[static_cast<size_t>(line)];
  const Vec3 step = (1 - target / along.norm()) / (moves_a && moves_b ? 2 : 1) * along;
  if (moves_a) x.col(a) += step;
  if (moves_b) x.col(b) -= step;
}

bool LineTrees::make_slack(const Tree& tree, double share, Points& x) const {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    if (is_slack(tree, share, x)) return true;
    for (const int line : tree.lines)
      if (!is_line_slack(line, share, x)) shorten(line, share, x);
  }
  return is_slack(tree, share, x);
}

}  // namespace coapt
