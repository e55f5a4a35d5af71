// The numbers of a multifrontal Cholesky factor: dense fronts along an elimination tree.
// Duff and Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM Trans. Math.
// Softw. 9 (1983); Liu, The multifrontal method for sparse matrix solution, SIAM Review 34 (1992).
#pragma once

#include "optim/linear/dense_front.hpp"
#include "optim/linear/supernodes.hpp"

#include <vector>

namespace coapt {

class MultifrontalFactor {
 public:
  using Panel = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  // Lays out the factor of matrices with this graph. border: as in supernodes_of().
  void analyse(const NodeGraph& graph, Supernodes nodes, int border = 0);

  // values: of a lower triangle of whole 3x3 blocks with the graph that was analysed. Eliminates all columns
  // but those of the border. False at a pivot that is not positive, or where one is not finite in the end.
  bool factorise(const double* values);

  // Counts the signs of the pivots of L D L^T without pivoting and leaves no factor; ends at one that is zero
  // or not finite. Pre: no border.
  void count_signs(const double* values, int& negative, int& positive);

  // What is left of the border's columns, a lower triangle. Pre: a border; factorise() returned true.
  Panel schur_complement() const { return panel(nodes_.size() - 1); }

  // x, in the order of nodes(): x = L^-1 x, which leaves in the border the right-hand side of its Schur
  // complement; and, once that is solved for, x = L^-T x.
  void solve_forward(Vector& x);
  void solve_backward(Vector& x);

  // Square of the smallest over that of the largest diagonal entry, the border's left out; 1 where there is
  // none.
  double pivot_ratio() const { return pivot_ratio_; }

  const Supernodes& nodes() const { return nodes_; }

  // y = P x and x = P^T y, P from the matrix's order to that of nodes().
  void permute(const Vector& x, Vector& y) const;
  void restore(const Vector& y, Vector& x) const;

 private:
  // Where the values of a 3x3 block of the lower triangle go in the panel of its supernode.
  struct BlockMove {
    int from, row_step, column_step;  // in the values of the matrix
    int to;
  };

  // A matrix of updates from when its front is done until its parent takes it. Fronts of even and of odd
  // depth have a stack each, as those of the children lie on top of theirs while the parent's is laid on the
  // other.
  struct UpdatePlan {
    std::vector<size_t> place;  // of each supernode in its stack
    std::vector<int> parity;    // which stack
    size_t size[2] = {0, 0};
  };

  enum class Part { Columns, Below };  // of a front

  static UpdatePlan plan_updates(const Supernodes& nodes);
  int height(int s) const { return 3 * (nodes_.columns(s) + nodes_.rows_below(s)); }
  int stride(int s) const { return DenseFront::stride(height(s)); }
  Panel panel(int s) const {
    return {values_.data() + panel_[s], height(s), 3 * nodes_.columns(s), Eigen::OuterStride<>(stride(s))};
  }
  double* update_of(int s) { return stack_[plan_.parity[s]].data() + plan_.place[s]; }
  DenseFront front_of(int s) {
    return {3 * nodes_.columns(s), 3 * nodes_.rows_below(s), values_.data() + panel_[s], update_of(s)};
  }
  void place_blocks(const NodeGraph& graph);
  DenseFront assembled_front(int s, const double* source);
  void add_updates(int s, const DenseFront& front, Part part);
  void add_columns(int child, int first, int last, int begin, double* target, int stride);
  bool measure_pivots();

  Supernodes nodes_;
  int eliminated_ = 0;         // supernodes, all but the border
  std::vector<size_t> panel_;  // where each supernode's columns begin in the values
  std::vector<double> values_;
  UpdatePlan plan_;
  std::vector<double> stack_[2], scaled_;
  std::vector<BlockMove> moves_;
  std::vector<int> first_move_;  // of each supernode
  std::vector<double> column_;   // of a front, in a solve
  double pivot_ratio_ = 1;
};

}  // namespace coapt
