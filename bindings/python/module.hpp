// What the files of the module share: one function for each room, and what Python code of the caller did in a
// run.
#pragma once

#include "optim/solver.hpp"
#include "scene/given.hpp"

#include <exception>
#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

namespace coapt::python {

namespace py = pybind11;

void define_core(py::module_& module);
void define_energy(py::module_& module);
void define_optim(py::module_& module);
void define_scene(py::module_& module);

// The first exception that the caller's Python code raised in a run. Solvers take it for a state that cannot
// be evaluated; when the run is over it goes on to the caller. All under the interpreter lock.
class Failure {
 public:
  bool is_set() const { return first_ != nullptr; }
  void keep(std::exception_ptr error) {
    if (!first_) first_ = std::move(error);
  }
  void rethrow() const {
    if (first_) std::rethrow_exception(first_);
  }

 private:
  std::exception_ptr first_;
};

// Terms from the caller's objects (coapt.Term). The list and the failure must outlive the run.
GivenTerms terms_of(py::list terms, Failure& failure);
bool all_have_hessians(const py::list& terms);

// Looks for signals (Ctrl-C) at every iterate and shows it to the callback, None for nobody. Both must
// outlive the run.
Observer observer_of(py::handle callback, Failure& failure, const Model& model);

// (n, 3) float64 of the caller, C-contiguous and of that shape, as Python has made sure: seen in place.
inline Eigen::Map<const Points> points_in(const py::array_t<double, py::array::c_style>& array) {
  return {array.data(), 3, array.shape(0)};
}

// An array that owns the points, (n, 3).
py::array_t<double> array_of(Points points);

}  // namespace coapt::python
