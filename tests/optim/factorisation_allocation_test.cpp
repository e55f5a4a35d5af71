// Counts what a factorisation allocates once its pattern is known, and what a whole iteration of newton does.
#include "linear/factorisation.hpp"

#ifdef COAPT_HAS_CHOLMOD
#include "optim/cholmod/cholmod_factorisation.hpp"
#endif

#include "support/counted_allocations.hpp"
#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

namespace {

using namespace coapt;

// Nodes on a square grid, each coupled to its neighbours.
SparseMatrix grid(int side) {
  const int nodes = side * side;
  std::vector<Eigen::Triplet<double>> entries;
  for (int node = 0; node < nodes; ++node)
    for (int other : {node, node + 1, node + side}) {
      if (other >= nodes || (other == node + 1 && other % side == 0)) continue;
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
          entries.emplace_back(3 * other + r, 3 * node + c, r == c ? (other == node ? 5 : -1) : 0);
    }
  SparseMatrix lower(3 * nodes, 3 * nodes);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

struct Count {
  long factorise = 0, solve = 0;
};

Count second_round(Factorisation& factor, const SparseMatrix& matrix) {
  const Vector b = Vector::Ones(matrix.cols());
  Vector x;
  factor.analyse(matrix);
  EXPECT_TRUE(factor.factorise(matrix));
  factor.solve(b, x);
  Count count;
  long before = allocations().count;
  factor.factorise(matrix);
  count.factorise = allocations().count - before;
  before = allocations().count;
  factor.solve(b, x);
  count.solve = allocations().count - before;
  return count;
}

using Allocation = CountedAllocations;

TEST_F(Allocation, OfEigenIsNoneBelow128KilobytesOfWorkSpace) {
  const auto factor = make_eigen_factorisation();
  const Count count = second_round(*factor, grid(60));
  EXPECT_EQ(count.factorise, 0);
  EXPECT_EQ(count.solve, 0);
}

TEST_F(Allocation, OfEigenIsThreeWorkArraysAbove) {
  const auto factor = make_eigen_factorisation();
  const Count count = second_round(*factor, grid(120));
  EXPECT_EQ(count.factorise, 3);
  EXPECT_EQ(count.solve, 0);
}

#ifdef COAPT_HAS_CHOLMOD
TEST_F(Allocation, OfCholmodIsItsUpdateMatrixAtAnySize) {
  for (int side : {10, 60, 120}) {
    const auto factor = make_cholmod_factorisation();
    const Count count = second_round(*factor, grid(side));
    EXPECT_EQ(count.factorise, 2);  // the update matrix and its header
    EXPECT_EQ(count.solve, 0);
  }
}
#endif

// Passes everything on to another factorisation and counts.
class Counted final : public Factorisation {
 public:
  Counted(std::unique_ptr<Factorisation> factor, long& count) : factor_(std::move(factor)), count_(count) {}
  std::string_view name() const override { return factor_->name(); }
  void analyse(const SparseMatrix& lower) override { factor_->analyse(lower); }
  bool factorise(const SparseMatrix& lower) override {
    ++count_;
    return factor_->factorise(lower);
  }
  void solve(const Vector& b, Vector& x) override { factor_->solve(b, x); }
  double pivot_ratio() const override { return factor_->pivot_ratio(); }
  Inertia inertia(const SparseMatrix& lower) override { return factor_->inertia(lower); }

 private:
  std::unique_ptr<Factorisation> factor_;
  long& count_;
};

// From the second iterate on, whatever the iteration does (Hessian, factor, GMRES, line search, trace),
// newton allocates the blocks that the library takes for each factorisation and nothing else; save where it
// brings a few nodes into balance by themselves, which is another, small problem with its own factorisation.
void expect_nothing_allocated_but(long blocks, const FactorisationFactory& make) {
  const ValveScene scene{{}};
  Objective objective(scene.X, scene.fixed, scene.terms());
  long made = 0, factorised = 0;
  SolverOptions options;
  options.factorisation = [&] {
    ++made;
    return std::make_unique<Counted>(make(), factorised);
  };
  const auto newton = built_in_solvers().at("newton")(options);
  struct Seen {
    long allocations, made, factorised;
  };
  std::vector<Seen> seen;
  seen.reserve(1000);
  const Result result = solve(*newton, {objective, objective.unknowns(scene.X), scene.method().motion},
                              {.tolerance = 1e-8}, [&](const Iteration&, const Vector&) {
                                seen.push_back({allocations().count, made, factorised});
                                return true;
                              });
  ASSERT_EQ(result.status, Status::Converged);
  ASSERT_GT(seen.size(), 5u);
  EXPECT_GT(seen[1].allocations, seen[0].allocations);  // the first iteration makes room
  int whole = 0;
  for (size_t k = 2; k < seen.size(); ++k) {
    if (seen[k].made > seen[k - 1].made) continue;
    ++whole;
    EXPECT_GE(seen[k].factorised, seen[k - 1].factorised + 1) << "iteration " << k;
    EXPECT_EQ(seen[k].allocations - seen[k - 1].allocations,
              blocks * (seen[k].factorised - seen[k - 1].factorised))
        << "iteration " << k;
  }
  EXPECT_GE(whole, 4);
}

TEST_F(Allocation, NewtonIteratesWithoutAny) { expect_nothing_allocated_but(0, make_eigen_factorisation); }

#ifdef COAPT_HAS_CHOLMOD
TEST_F(Allocation, NewtonIteratesOnCholmodWithItsUpdateMatrixAlone) {
  expect_nothing_allocated_but(2, [] { return make_cholmod_factorisation(); });
}
#endif

}  // namespace
