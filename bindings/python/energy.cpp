// The caller's own energies.
#include "core/error.hpp"
#include "energy/derivative_check.hpp"
#include "module.hpp"
#include "python_term.hpp"

namespace coapt::python {
namespace {

PythonTerm::Place place_of(const Model& model) { return {model.X, model.origin}; }

py::dict report_of(const DerivativeReport& report, bool has_hessian) {
  py::dict dict;
  const auto number = [](double value) -> py::object { return py::float_(value); };
  dict["name"] = report.name;
  dict["energy"] = number(report.energy);
  dict["gradient_norm"] = number(report.gradient_norm);
  dict["gradient_slope"] = number(report.gradient_slope);
  dict["gradient_error"] = number(report.gradient_error);
  dict["hessian_slope"] = has_hessian ? number(report.hessian_slope) : py::none();
  dict["hessian_error"] = has_hessian ? number(report.hessian_error) : py::none();
  const bool is_gradient_right = report.gradient_slope >= 1.95 && report.gradient_error <= 1e-7;
  dict["passed"] = report.is_active() && (has_hessian ? report.has_passed() : is_gradient_right);
  return dict;
}

py::dict check_term(const py::object& term, const Numbers& x, double step, unsigned seed) {
  Failure failure;
  const Points positions = points_in(x);
  const bool has_hessian = PythonTerm::has_hessian(term);
  PythonTerm checked(term, {positions, Vec3::Zero()}, failure, PythonTerm::WithoutHessian::Zero);
  const FixedMask fixed = FixedMask::Constant(3, positions.cols(), false);
  try {
    const DerivativeReport report =
        check_derivatives(checked, positions, random_directions(fixed, 4, step, seed));
    failure.rethrow();
    return report_of(report, has_hessian);
  } catch (...) {
    failure.rethrow();
    throw;
  }
}

}  // namespace

GivenTerms terms_of(py::list terms, Failure& failure) {
  if (terms.empty()) return {};
  const py::handle list = terms;  // the caller keeps it
  return [list, &failure](const Model& model) {
    const py::gil_scoped_acquire lock;
    std::vector<std::unique_ptr<EnergyTerm>> made;
    for (const py::handle term : list)
      made.push_back(std::make_unique<PythonTerm>(py::reinterpret_borrow<py::object>(term), place_of(model),
                                                  failure, PythonTerm::WithoutHessian::Refused));
    return made;
  };
}

bool all_have_hessians(const py::list& terms) {
  for (const py::handle term : terms)
    if (!PythonTerm::has_hessian(term)) return false;
  return true;
}

void define_energy(py::module_& module) {
  module.def(
      "check_term", &check_term, py::arg("term"), py::arg("x"), py::arg("step"), py::arg("seed"),
      "Derivatives of a term at x, (n, 3) [mm], against its values, in directions whose largest nodal\n"
      "movement is step [mm].");
}

}  // namespace coapt::python
