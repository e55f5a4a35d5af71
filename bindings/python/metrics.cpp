// Figures of merit: those of the library, and the caller's own.
#include "equilibrium.hpp"
#include "sensitivity/metrics/metrics_contact.hpp"
#include "sensitivity/metrics/metrics_opening.hpp"
#include "sensitivity/metrics/metrics_state.hpp"
#include "sensitivity/metrics/metrics_surface.hpp"

#include <pybind11/stl.h>

namespace coapt::python {
namespace {

using Of = std::shared_ptr<Followed>;

Vec3 direction_in(const Numbers& array) { return Vec3(array.data()); }

FigureOfMerit figure(Of of, std::unique_ptr<Metric> metric, double offset = 0) {
  return {std::move(of), std::move(metric), offset};
}

// Where the model is; none: the scene's own closed reference.
TriangleMesh target_of(const Followed& followed, const std::string& name,
                       const std::optional<Numbers>& vertices, const std::optional<Corners>& triangles) {
  if (vertices && triangles)
    return {points_in(*vertices).colwise() - followed.origin(), triangles_in(*triangles), {}, {}};
  if (!followed.tracked.model.closed_reference)
    throw InputError(
        "metric \"" + name +
        "\": has no target, and the scene no closed surface as `reference`; give V and F of one");
  if (followed.tracked.model.registration)
    throw InputError(
        "metric \"" + name +
        "\": its target must stay where it is; leave `reference.register` out of the scene and give "
        "V and F as coapt.register() returns them");
  return *followed.tracked.model.closed_reference;
}

EnergyTerm& term_named(const Followed& followed, const std::string& metric, const std::string& name) {
  std::string known;
  for (const auto& term : followed.tracked.model.objective->terms()) {
    if (term->name() == name) return *term;
    known += (known.empty() ? "" : ", ") + term->name();
  }
  throw InputError("metric \"" + metric + "\": there is no term \"" + name + "\"; the scene has " + known);
}

FigureOfMerit surface_distance(Of of, const std::string& name, const std::optional<Numbers>& vertices,
                               const std::optional<Corners>& triangles, double rounding, double sharpness) {
  const Model& model = of->tracked.model;
  return figure(of, make_surface_distance(name, model.mesh.triangles, model.X,
                                          target_of(*of, name, vertices, triangles), {rounding, sharpness}));
}

std::vector<FigureOfMerit> distance_residuals(const Of& of, const std::string& name,
                                              const std::optional<Numbers>& vertices,
                                              const std::optional<Corners>& triangles, double rounding) {
  const Model& model = of->tracked.model;
  std::vector<FigureOfMerit> all;
  for (auto& metric : make_distance_residuals(name, model.mesh.triangles, model.X,
                                              target_of(*of, name, vertices, triangles), rounding))
    all.push_back(figure(of, std::move(metric)));
  return all;
}

FigureOfMerit orifice_area(Of of, const std::string& name, const std::vector<int>& annulus,
                           const Numbers& axis, double blur) {
  of->require_idle();
  auto metric = make_opening_area(name, of->tracked.model.mesh.triangles, annulus,
                                  of->equilibrium().positions(), {direction_in(axis), blur});
  return figure(std::move(of), std::move(metric));
}

// direction: of the height; none for the area.
FigureOfMerit coaptation(Of of, const std::string& name, const std::optional<Numbers>& direction,
                         double range, double sharpness) {
  const Model& model = of->tracked.model;
  const ContactZoneOptions options{range, sharpness};
  auto metric = direction ? make_contact_zone_height(name, model.mesh.triangles, model.X,
                                                     direction_in(*direction), options)
                          : make_contact_zone_area(name, model.mesh.triangles, model.X, options);
  return figure(std::move(of), std::move(metric));
}

FigureOfMerit line_force(Of of, const std::string& name, const std::string& term, int line) {
  auto metric = make_line_force(name, term_named(*of, name, term), line);
  return figure(std::move(of), std::move(metric));
}

// lines: none for all of the term.
FigureOfMerit line_force_norm(Of of, const std::string& name, const std::string& term,
                              std::optional<std::vector<int>> lines, double exponent) {
  EnergyTerm& found = term_named(*of, name, term);
  if (!lines) {
    lines.emplace();
    for (int line = 0; line < found.stencils().count(); ++line) lines->push_back(line);
  }
  auto metric = make_line_force_norm(name, found, std::move(*lines), exponent);
  return figure(std::move(of), std::move(metric));
}

FigureOfMerit strain_energy(Of of, const std::string& name) {
  auto metric = make_strain_energy(name, *of->tracked.model.objective);
  return figure(std::move(of), std::move(metric));
}

FigureOfMerit node_position(Of of, const std::string& name, std::vector<int> nodes, const Numbers& weights) {
  Points columns = points_in(weights);
  const double offset = columns.rowwise().sum().dot(of->origin());
  return figure(std::move(of), make_node_position(name, std::move(nodes), std::move(columns)), offset);
}

// function(x, wants_gradient) -> (value, gradient or None), with shapes made sure of.
FigureOfMerit user_metric(const Of& of, const std::string& name, const py::function& function) {
  Followed* followed = of.get();  // kept by the figure
  const auto call = [followed, function](const Points& x, Points* gradient) {
    const py::gil_scoped_acquire lock;
    try {
      const py::array_t<double> shown = array_of(x.colwise() + followed->origin());
      const py::tuple answer = function(shown, gradient != nullptr);
      if (gradient != nullptr) *gradient = points_in(answer[1].cast<Numbers>());
      return answer[0].cast<double>();
    } catch (...) {
      followed->failure.keep(std::current_exception());
    }
    throw InputError("metric: raised an exception");  // the caller gets that one
  };
  return figure(of, std::make_unique<UserMetric>(name, call));
}

}  // namespace

void define_metrics(py::module_& module) {
  py::class_<FigureOfMerit>(module, "Metric", "A figure of merit of one equilibrium, with exact derivatives.")
      .def_property_readonly("name", [](const FigureOfMerit& self) { return self.metric->name(); });
  const auto of = py::arg("of");
  const auto name = py::arg("name"), vertices = py::arg("vertices"), triangles = py::arg("triangles");
  module.def("surface_distance", &surface_distance, of, name, vertices, triangles, py::arg("rounding"),
             py::arg("sharpness"));
  module.def("distance_residuals", &distance_residuals, of, name, vertices, triangles, py::arg("rounding"));
  module.def("orifice_area", &orifice_area, of, name, py::arg("annulus"), py::arg("axis"), py::arg("blur"));
  module.def("coaptation", &coaptation, of, name, py::arg("direction"), py::arg("range"),
             py::arg("sharpness"));
  module.def("line_force", &line_force, of, name, py::arg("term"), py::arg("line"));
  module.def("line_force_norm", &line_force_norm, of, name, py::arg("term"), py::arg("lines"),
             py::arg("exponent"));
  module.def("strain_energy", &strain_energy, of, name);
  module.def("node_position", &node_position, of, name, py::arg("nodes"), py::arg("weights"));
  module.def("user_metric", &user_metric, of, name, py::arg("function"));
}

}  // namespace coapt::python
