// The numbers of a multifrontal Cholesky factor: dense fronts along an elimination tree.
// Duff and Reid, The multifrontal solution of indefinite sparse symmetric linear equations, ACM Trans. Math.
// Softw. 9 (1983); Liu, The multifrontal method for sparse matrix solution, SIAM Review 34 (1992).
#pragma once

#include "core/scratch.hpp"
#include "core/thread_team.hpp"
#include "linear/dense_front.hpp"
#include "linear/supernodes.hpp"

#include <memory>
#include <vector>

namespace coapt {

class MultifrontalFactor {
 public:
  using Panel = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

  // Threads share subtrees of the elimination tree and the greatest fronts; no number depends on how many
  // there are. Before analyse().
  void use_threads(std::shared_ptr<ThreadTeam> team) { team_ = std::move(team); }

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

  // Where a supernode's matrix of updates lies from when its front is done until its parent takes it. Fronts
  // of even and of odd depth have a stack each, as those of the children lie on top of theirs while the
  // parent's is laid on the other; each thread has its own two. What a subtree leaves has a place of its own.
  enum class Home : unsigned char { EvenStack, OddStack, Kept };
  struct UpdatePlan {
    std::vector<size_t> place;  // of each supernode, where it is at home
    std::vector<Home> home;
    size_t size[3] = {0, 0, 0};  // of each home
  };

  // What a thread works with.
  struct Workspace {
    Scratch stack[2], column;
    std::vector<double> scaled;
  };

  enum class Part { Columns, Below };  // of a front

  void part_tree();
  void plan_updates();
  void plan_update(int s, size_t (&top)[2]);
  template <class Eliminate>
  bool for_each_front(const Eliminate& eliminate);
  template <class Visit>
  void in_subtrees(const Visit& visit);
  bool is_shared() const { return team_->size() > 1 && work_ > kWorthThreads; }
  ThreadTeam* shared_team() const { return is_shared() ? team_.get() : nullptr; }
  int height(int s) const { return 3 * (nodes_.columns(s) + nodes_.rows_below(s)); }
  int stride(int s) const { return DenseFront::stride(height(s)); }
  Panel panel(int s) const {
    return {values_.data() + panel_[s], height(s), 3 * nodes_.columns(s), Eigen::OuterStride<>(stride(s))};
  }
  double* update_of(int s, Workspace& own) {
    const Home home = plan_.home[s];
    return (home == Home::Kept ? kept_.data() : own.stack[home == Home::OddStack ? 1 : 0].data()) +
           plan_.place[s];
  }
  DenseFront front_of(int s, double* update) {
    return {3 * nodes_.columns(s), 3 * nodes_.rows_below(s), values_.data() + panel_[s], update};
  }
  void place_blocks(const NodeGraph& graph);
  DenseFront assembled_front(int s, const double* source, Workspace& own, ThreadTeam* team);
  void add_updates(int s, const DenseFront& front, Part part, Workspace& own, ThreadTeam* team);
  void add_columns(const double* update, int child, int first, int last, int begin, double* target,
                   int stride);
  void solve_front_forward(int s, Vector& x, Scratch& column);
  void solve_front_backward(int s, Vector& x, Scratch& column);
  bool measure_pivots();

  static constexpr double kWorthThreads = 5e7;  // multiplications of a factor: more than at 2,500 triangles

  Supernodes nodes_;
  int eliminated_ = 0;         // supernodes, all but the border
  std::vector<size_t> panel_;  // where each supernode's columns begin in the values
  Scratch values_;
  double work_ = 0;                            // multiplications of a factor
  std::vector<std::pair<int, int>> subtrees_;  // first and last supernode of those that threads share
  std::vector<int> top_;                       // the supernodes above them, ascending
  UpdatePlan plan_;
  Scratch kept_;                       // what subtrees leave
  std::vector<Workspace> workspaces_;  // of each thread
  std::vector<BlockMove> moves_;
  std::vector<int> first_move_;  // of each supernode
  Scratch passed_;               // from each front to its parent's, in a forward solve
  double pivot_ratio_ = 1;
  std::shared_ptr<ThreadTeam> team_ = std::make_shared<ThreadTeam>();
};

}  // namespace coapt
