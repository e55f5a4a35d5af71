#include "optim/linear/factorisation.hpp"
#include "optim/linear/multifrontal_factor.hpp"
#include "optim/linear/node_ordering.hpp"

#include <string_view>

namespace coapt {
namespace {

double entries_of(const Supernodes& nodes) {
  double entries = 0;
  for (int s = 0; s < nodes.size(); ++s)
    entries += static_cast<double>(nodes.columns(s)) * (nodes.columns(s) + nodes.rows_below(s));
  return entries;
}

class Multifrontal final : public Factorisation {
 public:
  std::string_view name() const override { return "multifrontal"; }

  void analyse(const SparseMatrix& lower) override {
    const NodeGraph graph = node_graph(lower);
    factor_.use_threads(team());
    factor_.analyse(graph, ordered(graph));
  }

  bool factorise(const SparseMatrix& lower) override { return factor_.factorise(lower.valuePtr()); }

  void solve(const Vector& b, Vector& x) override {
    factor_.permute(b, work_);
    factor_.solve_forward(work_);
    factor_.solve_backward(work_);
    factor_.restore(work_, x);
  }

  double pivot_ratio() const override { return factor_.pivot_ratio(); }

  Inertia inertia(const SparseMatrix& lower) override {
    const auto size = static_cast<int>(lower.cols());
    if (factorise(lower)) return {0, 0, size};
    Inertia inertia;
    factor_.count_signs(lower.valuePtr(), inertia.negative, inertia.positive);
    inertia.zero = size - inertia.negative - inertia.positive;
    return inertia;
  }

 private:
  // By the order of the last pattern, as most differ by a few pairs in contact: an ordering takes longer than
  // the rest of an analysis; anew where that order is none of this graph or fills more.
  Supernodes ordered(const NodeGraph& graph) {
    constexpr double kMostFill = 1.1;  // of an order that is kept, over that of the pattern it was made for
    const std::vector<int>& last = factor_.nodes().order;
    if (last.size() == static_cast<size_t>(graph.size())) {
      Supernodes nodes = supernodes_of(graph, last);
      if (entries_of(nodes) <= kMostFill * fill_) return nodes;
    }
    Supernodes nodes = supernodes_of(graph, order() ? order()->of(graph) : node_order(graph));
    fill_ = entries_of(nodes);
    return nodes;
  }

  MultifrontalFactor factor_;
  double fill_ = 0;  // entries of the pattern that was ordered last
  Vector work_;
};

}  // namespace

std::unique_ptr<Factorisation> make_multifrontal_factorisation() { return std::make_unique<Multifrontal>(); }

FactorisationTable built_in_factorisations() {
  return {{"eigen", make_eigen_factorisation}, {"multifrontal", make_multifrontal_factorisation}};
}

}  // namespace coapt
