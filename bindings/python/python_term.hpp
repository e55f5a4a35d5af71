// A term whose mathematics is an object of the caller (coapt.Term in coapt/_terms.py).
#pragma once

#include "energy/term.hpp"
#include "module.hpp"

#include <utility>
#include <vector>

namespace coapt::python {

class PythonTerm final : public EnergyTerm {
 public:
  // Where the nodes are: reference positions, 3 x node_count, relative to origin [mm]. Python sees positions
  // in the coordinates of the input.
  struct Place {
    Points X;
    Vec3 origin;
  };

  // What a method gets that asks for a Hessian that the term does not have.
  enum class WithoutHessian { Refused, Zero };

  // Under the interpreter lock; the other functions take it themselves. Throws InputError where `elements` or
  // the Hessian at the reference positions do not fit, py::error_already_set where that raises.
  PythonTerm(py::object term, const Place& place, Failure& failure, WithoutHessian without);
  ~PythonTerm() override;

  static bool has_hessian(py::handle term);

  std::string_view type() const override { return "python"; }
  TermRole role() const override { return role_; }
  const Stencils& stencils() const override { return stencils_; }
  double evaluate(const Points& x, Sink& sink) const override;

 private:
  using Pair = std::pair<int, int>;  // nodes, the first is not the smaller
  py::array_t<double> shown(const Points& x) const;
  double evaluated(const Points& x, Sink& sink) const;
  void add_gradient(const py::array_t<double>& x, Sink& sink) const;
  void add_hessian(const py::array_t<double>& x, Sink& sink) const;
  void add_blocks(const py::object& blocks, Sink& sink) const;
  void add_sparse(const py::object& matrix, Sink& sink) const;
  py::object csr_of(const py::object& matrix) const;
  std::vector<Pair> pairs_in(const py::object& matrix) const;
  void read_elements();
  void couple_pairs(std::vector<Pair> pairs);
  [[noreturn]] void refuse(const std::string& what) const;

  py::object term_;
  TermRole role_;
  Vec3 origin_;
  Eigen::Index node_count_;
  Failure& failure_;
  WithoutHessian without_;
  bool has_hessian_, is_sparse_ = false;
  Stencils stencils_{2, {}};
  std::vector<Pair> pairs_;             // of a sparse Hessian, ascending: one stencil each
  mutable py::array_t<double> buffer_;  // what Python sees of x, used again unless someone kept it
};

}  // namespace coapt::python
