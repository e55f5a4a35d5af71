#include "optim/slack_junctions.hpp"

#include "energy/term_access.hpp"

namespace coapt {
namespace {

constexpr double kSlack = 1e-4;  // of its length, by which a line is to be slack

}  // namespace

// What other elements hold, and lines that cannot be slack, is none.
SlackJunctions::SlackJunctions(const Objective& objective)
    : objective_(objective), x_(3, objective.node_count()) {
  SlackLines lines;
  std::vector<char>& moves = lines.may_move;
  for (Eigen::Index k = 0; k < objective.fixed().cols(); ++k)
    moves.push_back(!objective.fixed().col(k).any());
  for (const auto& term : objective.terms()) {
    const TermAccess* access = access_of(*term);
    const bool is_line = access != nullptr && access->kind() == TermKind::Line && access->has_lines();
    const Stencils& stencils = term->stencils();
    for (int e = 0; e < stencils.count(); ++e) {
      const int* nodes = stencils.nodes.data() + e * stencils.width;
      const double length = is_line ? access->line(e).length : 0;
      if (length > 0 && access->line_law(e)(length / 2).force == 0) {
        lines.ends.push_back({nodes[0], nodes[1]});
        lines.lengths.push_back(length);
      } else {
        for (int k = 0; k < stencils.width; ++k) moves[static_cast<size_t>(nodes[k])] = 0;
      }
    }
  }
  trees_ = LineTrees(std::move(lines));
}

bool SlackJunctions::slacken(Vector& q) {
  if (is_empty()) return false;
  objective_.positions(q, x_);
  if (!trees_.slacken(kSlack, x_)) return false;
  objective_.unknowns(x_, q);
  return true;
}

}  // namespace coapt
