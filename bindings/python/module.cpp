// The module: errors, arrays, what this build holds, and the rooms.
#include "module.hpp"

#include "core/components.hpp"
#include "core/error.hpp"

#include <utility>

namespace coapt::python {
namespace {

void translate(std::exception_ptr pointer) {
  try {
    if (pointer) std::rethrow_exception(pointer);
  } catch (const InputError& error) {
    py::tuple defects(error.defects().size());
    for (size_t k = 0; k < error.defects().size(); ++k) defects[k] = text_of(error.defects()[k]);
    const py::object type = py::module_::import("coapt._errors").attr("InputError");
    PyErr_SetObject(type.ptr(), type(*defects).ptr());
  }
}

}  // namespace

py::str text_of(const std::string& text) {
  return py::reinterpret_steal<py::str>(
      PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
}

py::array_t<double> array_of(Points points) {
  const auto count = points.cols();
  auto* kept = new Points(std::move(points));
  const py::capsule owner(kept, [](void* pointer) { delete static_cast<Points*>(pointer); });
  return py::array_t<double>({count, Eigen::Index{3}}, kept->data(), owner);
}

void define_core(py::module_& module) {
  py::register_exception_translator(translate);
  module.def("version", &version, "Version of the library, \"major.minor.patch\".");
}

}  // namespace coapt::python

PYBIND11_MODULE(_core, module) {
  module.doc() = "What the package coapt is made of: the library behind its functions.";
  coapt::python::define_core(module);
  coapt::python::define_adapters(module);
  coapt::python::define_energy(module);
  coapt::python::define_optim(module);
  coapt::python::define_scene(module);
  coapt::python::define_equilibrium(module);
  coapt::python::define_registration(module);
}
