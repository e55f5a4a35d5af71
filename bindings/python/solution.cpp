#include "solution.hpp"

#include "core/timing.hpp"

#include <cstddef>
#include <type_traits>
#include <vector>

namespace coapt::python {
namespace {

Points free_gradient(Objective& objective, const Vector& q) {
  Vector g;
  objective.gradient(q, g);  // loads without a potential are held at q: exact there
  const Points none = Points::Zero(3, objective.node_count());
  return objective.fixed().select(none, objective.positions(g));
}

// What the body pulls with at prescribed coordinates. The potential of a pressure is that of the free nodes:
// its gradient at held ones is no force that a support feels.
Points support_forces(const Model& model, const Points& x) {
  const Points none = Points::Zero(3, x.cols());
  Points gradient = none;
  Sink sink(gradient.data());
  for (const auto& term : model.objective->terms())
    if (term->role() != TermRole::Load) term->evaluate(x, sink);
  return model.objective->fixed().select(gradient, none);
}

// Arrays that look into a solution and keep it alive.
template <typename T, typename Matrix>
py::array rows(const py::object& self, const Matrix& columns) {
  return py::array_t<T>({columns.cols(), columns.rows()}, columns.data(), self);
}

py::array numbers(const py::object& self, const Vector& values) {
  return py::array_t<double>({values.size()}, values.data(), self);
}

py::array flags(const py::object& self, const std::vector<char>& values) {
  return py::array(py::dtype("?"), {values.size()}, values.data(), self);
}

const Solution& in(const py::object& self) { return self.cast<const Solution&>(); }

// The first two members of each line.
py::array lines(const py::object& self) {
  static_assert(std::is_standard_layout_v<Line> && offsetof(Line, a) == 0 &&
                offsetof(Line, b) == sizeof(int));
  const std::vector<Line>& all = in(self).run.model.lines;
  const int* first = all.empty() ? nullptr : &all.front().a;
  return py::array_t<int>({all.size(), size_t{2}}, {sizeof(Line), sizeof(int)}, first, self);
}

py::array regimes(const py::object& self, const std::vector<MembraneRegime>& values) {
  static_assert(std::is_same_v<std::underlying_type_t<MembraneRegime>, int>);
  return py::array(py::dtype::of<int>(), {values.size()}, values.data(), self);
}

// Those that the scene has.
py::dict fields(const py::object& self) {
  const Fields& found = in(self).run.report.fields;
  py::dict all;
  all["displacement"] = rows<double>(self, found.displacement);
  if (found.principal_strain.cols() > 0) all["principal_strain"] = rows<double>(self, found.principal_strain);
  if (found.principal_stress.cols() > 0) all["principal_stress"] = rows<double>(self, found.principal_stress);
  if (found.cauchy_stress.cols() > 0) {
    all["cauchy_stress"] = rows<double>(self, found.cauchy_stress);
    all["von_mises_stress"] = numbers(self, found.von_mises_stress);
  }
  if (found.first_piola_stress.cols() > 0)
    all["first_piola_stress"] = rows<double>(self, found.first_piola_stress);
  if (!found.regime.empty()) all["regime"] = regimes(self, found.regime);
  if (found.gap.size() > 0) {
    all["gap"] = numbers(self, found.gap);
    all["is_contact"] = flags(self, found.is_contact);
  }
  if (found.reference_distance.size() > 0)
    all["reference_distance"] = numbers(self, found.reference_distance);
  if (found.line_force.size() > 0) {
    all["line_force"] = numbers(self, found.line_force);
    all["line_strain"] = numbers(self, found.line_strain);
    all["line_stress"] = numbers(self, found.line_stress);
  }
  return all;
}

py::array undetermined(const py::object& self) {
  const std::vector<char>& found = in(self).run.report.fields.undetermined;
  return py::array(py::dtype("b"), {found.size()}, found.data(), self);
}

py::array history(const py::object& self) {
  const std::vector<Iteration>& trace = in(self).run.report.result.trace;
  return py::array_t<Iteration>({static_cast<py::ssize_t>(trace.size())}, trace.data(), self);
}

py::tuple evaluations(const Solution& solution) {
  const EvaluationCounts& counts = solution.run.report.result.evaluations;
  return py::make_tuple(counts.value, counts.gradient, counts.hessian);
}

}  // namespace

Solution::Solution(RunReport report, double start) : run(std::move(report)) {
  Model& model = run.model;
  const Vector& q = run.report.result.q;
  x = run.report.fields.x.colwise() + model.origin;
  gradient = free_gradient(*model.objective, q);
  reactions = support_forces(model, run.report.fields.x);
  document = result_json(model, run.report);
  run.report.fields.undetermined = undetermined_flags(run.report.result.certificate.free_nodes,
                                                      run.report.branches, model.objective->node_count());
  seconds = wall_seconds() - start;
  model.objective.reset();
}

void define_solution(py::module_& module) {
  py::class_<Solution>(module, "Solution", "One solved scene; its arrays look into it and keep it alive.")
      .def_property_readonly("x", [](const py::object& self) { return rows<double>(self, in(self).x); })
      .def_property_readonly("gradient",
                             [](const py::object& self) { return rows<double>(self, in(self).gradient); })
      .def_property_readonly("reactions",
                             [](const py::object& self) { return rows<double>(self, in(self).reactions); })
      .def_property_readonly(
          "faces", [](const py::object& self) { return rows<int>(self, in(self).run.model.mesh.triangles); })
      .def_property_readonly("lines", &lines)
      .def_property_readonly("fields", &fields)
      .def_property_readonly("undetermined", &undetermined)
      .def_property_readonly(
          "branch_spread",
          [](const py::object& self) { return numbers(self, in(self).run.report.fields.branch_spread); })
      .def_property_readonly("history", &history)
      .def_property_readonly("evaluations", &evaluations)
      .def_readonly("document", &Solution::document)
      .def_readonly("seconds", &Solution::seconds);
}

}  // namespace coapt::python
