// A sparse direct factorisation behind one interface, so that solvers do not know whose it is.
#pragma once

#include "core/thread_team.hpp"
#include "core/types.hpp"

#include <Eigen/SparseCore>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace coapt {

using SparseMatrix = Eigen::SparseMatrix<double>;

struct LastFactor;

// Numbers of negative and of positive pivots of A = L D L^T: by Sylvester's law those of the eigenvalues.
struct Inertia {
  int negative = 0;
  int zero = 0;  // pivots that are exactly zero or not finite: the factorisation says nothing about these
  int positive = 0;
};

// Matrices are symmetric and given by their lower triangle, whole 3x3 blocks of nodes (see HessianPattern):
// the ordering works on the graph of nodes, a ninth of the entries.
class Factorisation {
 public:
  virtual ~Factorisation() = default;
  virtual std::string_view name() const = 0;  // "cholmod", "eigen", "multifrontal"

  // Threads that may share the work, before analyse(); factor and solutions are the same whatever their
  // number.
  void use_threads(std::shared_ptr<ThreadTeam> team) { team_ = std::move(team); }
  const std::shared_ptr<ThreadTeam>& team() const { return team_; }

  // What those that share it leave to each other: the order that was found last, and memory. They must work
  // one after the other. Before analyse().
  void share(std::shared_ptr<LastFactor> last) { last_ = std::move(last); }

  // Orders and analyses the pattern of `lower`; its values are not looked at. Pre for all that follows.
  virtual void analyse(const SparseMatrix& lower) = 0;

  // Cholesky factorisation. Returns false, leaving no factor, when the matrix is not positive definite.
  // Pre: the pattern of the last analyse(). After the first call for a pattern nothing is allocated but a
  // library's own work space: two blocks in CHOLMOD, three in Eigen above some 16,000 unknowns.
  virtual bool factorise(const SparseMatrix& lower) = 0;

  // x = A^-1 b with the last factor. Pre: factorise() returned true. Allocates nothing after the first call.
  virtual void solve(const Vector& b, Vector& x) = 0;

  // Square of the smallest over that of the largest diagonal entry of the last factor: an upper bound of the
  // inverse condition number, zero for a singular matrix. Pre: factorise() returned true.
  virtual double pivot_ratio() const = 0;

  // Inertia by L D L^T without pivoting for size; discards the Cholesky factor. Works for an indefinite
  // matrix unless a leading minor vanishes, which a small shift of the diagonal avoids.
  virtual Inertia inertia(const SparseMatrix& lower) = 0;

 protected:
  const std::shared_ptr<LastFactor>& last() const { return last_; }  // null: shared with no other

 private:
  std::shared_ptr<ThreadTeam> team_ = std::make_shared<ThreadTeam>();
  std::shared_ptr<LastFactor> last_;
};

using FactorisationFactory = std::function<std::unique_ptr<Factorisation>()>;
using FactorisationTable = std::map<std::string, FactorisationFactory>;

// Eigen's simplicial factorisation: always there.
std::unique_ptr<Factorisation> make_eigen_factorisation();

// Dense fronts along the elimination tree: always there, and the fastest.
std::unique_ptr<Factorisation> make_multifrontal_factorisation();

// Those that are always there, by name.
FactorisationTable built_in_factorisations();

}  // namespace coapt
