// What the files of the module share: one function for each room, and what Python code of the caller did in a
// run.
#pragma once

#include "optim/solver.hpp"
#include "run/run.hpp"

#include <exception>
#include <memory>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>
#include <type_traits>

namespace coapt::python {

namespace py = pybind11;

void define_core(py::module_& module);
void define_adapters(py::module_& module);
void define_energy(py::module_& module);
void define_optim(py::module_& module);
void define_scene(py::module_& module);
void define_equilibrium(py::module_& module);
void define_registration(py::module_& module);

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

  // Runs work() without the lock. What the caller's code raised in it is raised when it is over: it says more
  // than what followed from it.
  template <typename Work>
  std::invoke_result_t<Work> guarding(const Work& work) {
    first_ = nullptr;
    try {
      if constexpr (std::is_void_v<std::invoke_result_t<Work>>) {
        released(work);
        rethrow();
      } else {
        auto result = released(work);
        rethrow();
        return result;
      }
    } catch (...) {
      rethrow();
      throw;
    }
  }

 private:
  template <typename Work>
  static std::invoke_result_t<Work> released(const Work& work) {
    const py::gil_scoped_release unlocked;
    return work();
  }

  std::exception_ptr first_;
};

// Terms from the caller's objects (coapt.Term). The list and the failure must outlive the run.
GivenTerms terms_of(py::list terms, Failure& failure);
bool all_have_hessians(const py::list& terms);

// Looks for signals (Ctrl-C) at every iterate and shows it to the callback, None for nobody. Both must
// outlive the run.
Observer observer_of(py::handle callback, Failure& failure, const Model& model);

// Arrays of the caller, C-contiguous and of the shape that is wanted, as Python has made sure: seen in place.
using Numbers = py::array_t<double, py::array::c_style>;
using Corners = py::array_t<int, py::array::c_style>;
inline Eigen::Map<const Vector> vector_in(const Numbers& array) { return {array.data(), array.size()}; }
inline Eigen::Map<const Points> points_in(const Numbers& array) { return {array.data(), 3, array.shape(0)}; }
inline Eigen::Map<const Triangles> triangles_in(const Corners& array) {
  return {array.data(), 3, array.shape(0)};
}

// A message or warning. Names in it come from files and may hold bytes that are not UTF-8.
py::str text_of(const std::string& text);

// Arrays that own what they hold; points as (n, 3).
py::array_t<double> array_of(Points points);
inline py::array_t<double> vector_array(const Vector& values) {
  return py::array_t<double>(values.size(), values.data());
}

}  // namespace coapt::python
