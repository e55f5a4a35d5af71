// Counts what a factorisation allocates once its pattern is known, and what a whole iteration of newton does.
// An executable of its own: it puts itself in front of the C library's allocator, which serves Eigen and
// CHOLMOD alike.
#include "optim/factorisation.hpp"

#ifdef COAPT_HAS_CHOLMOD
#include "optim/cholmod/cholmod_factorisation.hpp"
#endif

#include "support/valve_scene.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>

namespace {
std::atomic<long> allocations = 0;
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
extern "C" {
void* __libc_malloc(size_t size);
void* __libc_calloc(size_t count, size_t size);
void* __libc_realloc(void* block, size_t size);

void* malloc(size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* block, size_t size) {
  ++allocations;
  return __libc_realloc(block, size);
}
}
#endif

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
  long before = allocations;
  factor.factorise(matrix);
  count.factorise = allocations - before;
  before = allocations;
  factor.solve(b, x);
  count.solve = allocations - before;
  return count;
}

class Allocation : public testing::Test {
 protected:
  void SetUp() override {
    const long before = allocations;
    void* volatile block = std::malloc(1000);  // volatile: a pair that nobody looks at may be removed
    std::free(block);
    if (allocations == before) GTEST_SKIP() << "the allocator cannot be replaced here (sanitizers)";
  }
};

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

// From the second iterate on, whatever the iteration does: Hessian, factor, GMRES, line search, trace.
TEST_F(Allocation, NewtonIteratesWithoutAny) {
  const ValveScene scene{{}};
  Objective objective(scene.X, scene.fixed, scene.terms());
  const auto newton = built_in_solvers().at("newton")({});
  std::vector<long> counts;
  counts.reserve(1000);
  const Result result = solve(*newton, {objective, objective.unknowns(scene.X), scene.method().motion},
                              {.tolerance = 1e-8}, [&](const Iteration&, const Vector&) {
                                counts.push_back(allocations);
                                return true;
                              });
  ASSERT_EQ(result.status, Status::Converged);
  ASSERT_GT(counts.size(), 5u);
  EXPECT_GT(counts[1], counts[0]);  // the first iteration makes room
  for (size_t k = 2; k < counts.size(); ++k) EXPECT_EQ(counts[k], counts[k - 1]) << "iteration " << k;
}

}  // namespace
