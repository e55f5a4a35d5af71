// The compiled part of coapt_gpl: CHOLMOD and CGAL, linked in here and not in the module coapt.
#include "adapters.hpp"
#include "mesh/cgal/intersections_cgal.hpp"
#include "optim/cholmod/cholmod_factorisation.hpp"

#include <pybind11/pybind11.h>

namespace {

namespace py = pybind11;
using coapt::python::Adapters;

py::capsule adapters() {
  static const std::string name = coapt::python::adapters_name();  // a capsule keeps no copy
  auto* made = new Adapters{{"CHOLMOD", "OpenBLAS", "CGAL"}, COAPT_GPL_LICENCE, {}, {}};
  made->factorisations["cholmod"] = [] { return coapt::make_cholmod_factorisation(); };
  made->checker = {"cgal", coapt::intersecting_pairs_cgal};
  return py::capsule(made, name.c_str(), [](PyObject* owner) {
    delete static_cast<Adapters*>(PyCapsule_GetPointer(owner, PyCapsule_GetName(owner)));
  });
}

}  // namespace

PYBIND11_MODULE(_adapters, module) {
  module.doc() = "What coapt_gpl adds to coapt.";
  module.def("adapters", &adapters, "For coapt.");
}
