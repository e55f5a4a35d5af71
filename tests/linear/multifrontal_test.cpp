// The multifrontal factor, and that with a border.
#include "linear/bordered_factor.hpp"
#include "linear/factorisation.hpp"
#include "linear/last_factor.hpp"
#include "linear/node_ordering.hpp"
#include "linear/sheet_graph.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace coapt {
namespace {

// Positive definite, with the pattern of the graph.
SparseMatrix matrix_of(const NodeGraph& graph, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < graph.size(); ++j)
    for (int k = graph.start[j]; k < graph.start[j + 1]; ++k)
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
          entries.emplace_back(3 * graph.row[k] + r, 3 * j + c,
                               graph.row[k] == j && r == c ? 40 : normal(random));
  SparseMatrix matrix(3 * graph.size(), 3 * graph.size());
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(Multifrontal, MemoryGoesFromOneToTheNextAndLeavesTheBitsOfNew) {
  const auto last = std::make_shared<LastFactor>();
  const auto solved = [](const SparseMatrix& lower, const std::shared_ptr<LastFactor>& shared) {
    const auto factor = make_multifrontal_factorisation();
    if (shared) factor->share(shared);
    factor->analyse(lower);
    EXPECT_TRUE(!shared || !shared->factor) << "not in use";
    Vector x;
    EXPECT_TRUE(factor->factorise(lower));
    factor->solve(Vector::LinSpaced(lower.cols(), -1, 2), x);
    return x;
  };
  const MultifrontalFactor* memory = nullptr;
  for (const int side : {40, 41, 40, 12}) {
    const SparseMatrix lower = matrix_of(sheet_graph(side, 9), 15);
    EXPECT_EQ(solved(lower, last), solved(lower, nullptr)) << "side " << side;
    ASSERT_NE(last->factor, nullptr);
    EXPECT_TRUE(!memory || last->factor.get() == memory);
    memory = last->factor.get();
  }
}

TEST(Multifrontal, ThoseThatShareUpdateOneOrderWhichAPartLeavesAlone) {
  const NodeGraph graph = sheet_graph(40, 9), part = sheet_graph(20, 9);
  const auto last = std::make_shared<LastFactor>();
  const auto order_of = [&](const NodeGraph& of, bool is_shared = true) {
    const auto factor = make_multifrontal_factorisation();
    if (is_shared) factor->share(last);
    factor->analyse(matrix_of(of, 15));
    return last->order.found().order;
  };
  EXPECT_TRUE(order_of(graph, false).empty());
  const std::vector<int> found = order_of(graph);
  EXPECT_EQ(found, supernodes_of(graph, node_order(graph)).order);
  EXPECT_EQ(order_of(part), found);
  NodeGraph touching = graph;  // two nodes that were apart
  for (int& start : touching.start) start += &start > touching.start.data();
  touching.row.insert(touching.row.begin() + graph.start[1], graph.size() - 1);
  EXPECT_EQ(order_of(touching), found) << "updated, not found anew";
  EXPECT_EQ(order_of(sheet_graph(41, 9)).size(), 1681u);
}

TEST(Multifrontal, ThreadsLeaveTheBitsOfOne) {
  const NodeGraph graph = sheet_graph(70, 14);
  const SparseMatrix lower = matrix_of(graph, 15);
  SparseMatrix indefinite = lower;
  for (int k = 0; k < 3 * graph.size(); k += 50) indefinite.coeffRef(k, k) = -40;
  const Vector b = Vector::LinSpaced(lower.cols(), -1, 2);
  Vector expected;
  Inertia signs;
  for (const int threads : {1, 2, 3, 8}) {
    const auto factor = make_multifrontal_factorisation();
    factor->use_threads(std::make_shared<ThreadTeam>(threads));
    factor->analyse(lower);
    Vector x;
    for (int again = 0; again < 5; ++again) {
      ASSERT_TRUE(factor->factorise(lower));
      factor->solve(b, x);
      if (expected.size() == 0) expected = x;
      EXPECT_EQ(x, expected) << threads << " threads";
      EXPECT_FALSE(factor->factorise(indefinite));
    }
    const Inertia counted = factor->inertia(indefinite);
    if (threads == 1) signs = counted;
    EXPECT_EQ(counted.negative, signs.negative);
    EXPECT_EQ(counted.positive, signs.positive);
  }
  EXPECT_LT((lower.selfadjointView<Eigen::Lower>() * expected - b).norm(), 1e-12 * b.norm());
  EXPECT_GT(signs.negative, 100);
}

TEST(BorderedFactor, SolvesWithASkewPartOfItsBorder) {
  const NodeGraph graph = sheet_graph(20, 10);
  const SparseMatrix lower = matrix_of(graph, 11);
  // Apart from each other, in pieces, and one that nothing else couples to them.
  for (const std::vector<int>& border :
       {std::vector<int>{3}, {0, 7, 8, 9, 100, 250, 399}, std::vector<int>{}}) {
    const auto count = static_cast<int>(border.size());
    std::srand(1);
    Eigen::MatrixXd skew = Eigen::MatrixXd::Random(3 * count, 3 * count) * 30;
    skew = (skew - skew.transpose()).eval();
    Eigen::MatrixXd whole = Eigen::MatrixXd(lower).selfadjointView<Eigen::Lower>();
    for (int a = 0; a < count; ++a)
      for (int b = 0; b < count; ++b)
        whole.block<3, 3>(3 * border[a], 3 * border[b]) += skew.block<3, 3>(3 * a, 3 * b);
    BorderedFactor factor;
    factor.analyse(lower, border);
    ASSERT_TRUE(factor.factorise(lower, skew));
    const Vector b = Vector::Random(lower.cols());
    Vector x;
    factor.solve(b, x);
    EXPECT_LT((whole * x - b).norm(), 1e-12 * b.norm());
    EXPECT_EQ(factor.negative_eigenvalues(), 0);
    Vector transposed;
    factor.solve_transposed(b, transposed);
    EXPECT_LT((whole.transpose() * transposed - b).norm(), 1e-12 * b.norm());
    if (count > 0) {
      EXPECT_GT((lower.selfadjointView<Eigen::Lower>() * x - b).norm(), 0.01 * b.norm());
    }
  }
}

TEST(BorderedFactor, RefusesWhatIsNotPositiveDefiniteOutsideItsBorder) {
  const NodeGraph graph = sheet_graph(6, 12);
  SparseMatrix lower = matrix_of(graph, 13);
  lower.coeffRef(15, 15) = -40;  // of node 5
  BorderedFactor factor;
  factor.analyse(lower, {1});
  EXPECT_FALSE(factor.factorise(lower, Eigen::MatrixXd::Zero(3, 3)));
  factor.analyse(lower, {5});
  EXPECT_TRUE(factor.factorise(lower, Eigen::MatrixXd::Zero(3, 3)));
  EXPECT_EQ(factor.negative_eigenvalues(), 1);
}

}  // namespace
}  // namespace coapt
