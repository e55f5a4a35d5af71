// Factorisations and judges that are linked in, and those of another module.
#include "adapters.hpp"

#include "cli/solvers.hpp"
#include "core/components.hpp"
#include "module.hpp"

#include <algorithm>

namespace coapt::python {
namespace {

// Of the process, as the module itself is: set once, when coapt is imported.
Adapters& added() {
  static Adapters adapters;
  return adapters;
}

void add_adapters(const py::capsule& capsule) {
  const char* given = capsule.name();
  if (given == nullptr || adapters_name() != given)
    throw py::value_error("made for \"" + std::string(given == nullptr ? "" : given) + "\", and this is \"" +
                          adapters_name() + "\"");
  added() = *capsule.get_pointer<Adapters>();
}

std::string licence() { return added().licence.empty() ? combined_licence() : added().licence; }

py::list component_list() {
  const std::vector<std::string>& names = added().components;
  py::list list;
  for (const Component& part : components()) {
    const bool is_added = std::find(names.begin(), names.end(), part.name) != names.end();
    list.append(py::make_tuple(part.name, part.licence, part.gives, part.present || is_added));
  }
  return list;
}

}  // namespace

FactorisationTable factorisations() {
  FactorisationTable table = cli::all_factorisations();
  for (const auto& [name, factory] : added().factorisations) table[name] = factory;
  return table;
}

IntersectionChecker checker() {
  return added().licence.empty() ? cli::intersection_checker() : added().checker;
}

void define_adapters(py::module_& module) {
  module.def("licence", &licence, "SPDX expression of the module with all that it is linked to.");
  module.def("components", component_list, "(package, licence, what it gives, whether it is in), each.");
  module.def("add_adapters", &add_adapters, py::arg("capsule"),
             "Takes what another module adds; ValueError where that is of another build.");
}

}  // namespace coapt::python
