// What is seen of a run while it goes on.
#include "module.hpp"

#include <optional>

namespace coapt::python {
namespace {

// One accepted iterate as the callback gets it.
struct Iterate {
  Iteration at;
  std::optional<Points> x;  // in the coordinates of the input [mm]; none on the coarser meshes of a cascade
};

bool goes_on(const py::object& answer) { return answer.ptr() != Py_False; }

bool shown(py::handle callback, const Model& model, const Iteration& at, const Vector& q) {
  std::optional<Points> x;
  if (q.size() == model.objective->unknown_count())
    x = model.objective->positions(q).colwise() + model.origin;
  return goes_on(callback(Iterate{at, std::move(x)}));
}

}  // namespace

Observer observer_of(py::handle callback, Failure& failure, const Model& model) {
  return [callback, &failure, &model](const Iteration& at, const Vector& q) {
    const py::gil_scoped_acquire lock;
    if (failure.is_set()) return false;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      return callback.is_none() || shown(callback, model, at, q);
    } catch (const py::error_already_set& error) {
      if (!error.matches(PyExc_StopIteration)) failure.keep(std::current_exception());
    } catch (...) {
      failure.keep(std::current_exception());
    }
    return false;
  };
}

void define_optim(py::module_& module) {
  PYBIND11_NUMPY_DTYPE_EX(Iteration, iteration, "iteration", outer_iteration, "round", energy, "energy",
                          residual, "residual", step, "step", seconds, "seconds", time, "time", evaluations,
                          "evaluations");
  const auto field = [](auto member) { return [member](const Iterate& it) { return it.at.*member; }; };
  py::class_<Iterate>(module, "Iterate", "One accepted iterate of a run, as a callback sees it.")
      .def_property_readonly("iteration", field(&Iteration::iteration), "Number of the iterate, from 0.")
      .def_property_readonly("round", field(&Iteration::outer_iteration),
                             "Renewal of a load, or step of a path.")
      .def_property_readonly("energy", field(&Iteration::energy), "Of the potential that is minimised [mJ].")
      .def_property_readonly("residual", field(&Iteration::residual),
                             "Greatest out-of-balance force over the greatest load or reaction.")
      .def_property_readonly("step", field(&Iteration::step), "Greatest change of a coordinate [mm].")
      .def_property_readonly("seconds", field(&Iteration::seconds), "Wall time since the start [s].")
      .def_property_readonly("time", field(&Iteration::time), "Simulated since the start [s], 0 without.")
      .def_property_readonly("evaluations", field(&Iteration::evaluations), "Gradients so far.")
      .def_property_readonly(
          "x",
          [](const Iterate& it) -> py::object {
            if (!it.x) return py::none();
            return array_of(*it.x);
          },
          "Positions of all nodes, (n, 3) [mm]; None on the coarser meshes of a cascade.");
}

}  // namespace coapt::python
