#include "linear/factorisation.hpp"
#include "linear/last_factor.hpp"
#include "linear/node_ordering.hpp"
#include "linear/updated_order.hpp"

#include <memory>
#include <string_view>

namespace coapt {
namespace {

class Multifrontal final : public Factorisation {
 public:
  Multifrontal() = default;
  Multifrontal(const Multifrontal&) = delete;
  Multifrontal& operator=(const Multifrontal&) = delete;
  ~Multifrontal() override {
    if (last() && factor_) last()->factor = std::move(factor_);
  }

  std::string_view name() const override { return "multifrontal"; }

  void analyse(const SparseMatrix& lower) override {
    if (!factor_ && last()) factor_ = std::move(last()->factor);
    if (!factor_) factor_ = std::make_unique<MultifrontalFactor>();
    const NodeGraph graph = node_graph(lower);
    factor_->use_threads(team());
    KeptOrder& kept = last() && !is_part(graph) ? last()->order : kept_;
    factor_->analyse(graph, kept.supernodes(graph, [&graph] { return node_order(graph); }));
  }

  bool factorise(const SparseMatrix& lower) override { return factor_->factorise(lower.valuePtr()); }

  void solve(const Vector& b, Vector& x) override {
    factor_->permute(b, work_);
    factor_->solve_forward(work_);
    factor_->solve_backward(work_);
    factor_->restore(work_, x);
  }

  double pivot_ratio() const override { return factor_->pivot_ratio(); }

  Inertia inertia(const SparseMatrix& lower) override {
    const auto size = static_cast<int>(lower.cols());
    if (factorise(lower)) return {0, 0, size};
    Inertia inertia;
    factor_->count_signs(lower.valuePtr(), inertia.negative, inertia.positive);
    inertia.zero = size - inertia.negative - inertia.positive;
    return inertia;
  }

 private:
  // A part of the nodes that is brought into balance by itself does not take the place of all. Where it has
  // half of them or more, both are small, and found anew in a moment.
  bool is_part(const NodeGraph& graph) const {
    return 2 * static_cast<size_t>(graph.size()) < last()->order.found().order.size();
  }

  std::unique_ptr<MultifrontalFactor> factor_;
  KeptOrder kept_;  // where it is not shared
  Vector work_;
};

}  // namespace

std::unique_ptr<Factorisation> make_multifrontal_factorisation() { return std::make_unique<Multifrontal>(); }

FactorisationTable built_in_factorisations() {
  return {{"eigen", make_eigen_factorisation}, {"multifrontal", make_multifrontal_factorisation}};
}

}  // namespace coapt
