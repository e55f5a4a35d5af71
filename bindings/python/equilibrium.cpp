// Equilibria that are followed: made from a scene, changed, solved again.
#include "equilibrium.hpp"

#include "adapters.hpp"
#include "cli/solvers.hpp"
#include "input.hpp"
#include "sensitivity/parameters/dead_load.hpp"

#include <pybind11/stl.h>

namespace coapt::python {
namespace {

// At every step of a solve: Ctrl-C, which arrives in the main thread alone, ends it.
Observer watch_for_signals(Failure& failure) {
  return [&failure](const Iteration&, const Vector&) {
    const py::gil_scoped_acquire lock;
    try {
      if (!failure.is_set() && PyErr_CheckSignals() != 0) throw py::error_already_set();
    } catch (...) {
      failure.keep(std::current_exception());
    }
    return !failure.is_set();
  };
}

std::shared_ptr<Followed> follow(const Input& input, const std::vector<std::string>& parameters,
                                 const std::string& solver, double tolerance,
                                 std::optional<double> max_seconds) {
  auto followed = std::make_shared<Followed>();
  RunOptions options;
  options.solver = solver;
  options.max_seconds = max_seconds;
  options.factorisations = factorisations();
  options.observer = watch_for_signals(followed->failure);
  TrackingOptions tracking;
  tracking.tolerance = tolerance;
  tracking.max_seconds = max_seconds.value_or(kInfinity);
  tracking.observer = options.observer;
  Given given = input.given(followed->failure);
  followed->at_work([&] {
    followed->scene = input.scene();
    followed->tracked = track(followed->scene, std::move(given), cli::all_solvers(), options, tracking);
    followed->keep_shape();
  });
  followed->add(parameters);
  return followed;
}

py::object lost_branch_of(const WarmSolve& warm) {
  if (!warm.lost_branch) return py::none();
  const LostBranch& lost = *warm.lost_branch;
  py::dict dict;
  dict["distance"] = lost.distance;
  dict["jump"] = lost.jump;
  dict["negative_before"] = lost.negative_before;
  dict["negative_after"] = lost.negative_after;
  return dict;
}

py::object anchor_check_of(const std::optional<AnchorCheck>& check) {
  if (!check) return py::none();
  py::dict dict;
  dict["status"] = py::str(std::string(status_name(check->status)));
  dict["is_same_branch"] = check->is_same_branch;
  dict["back"] = check->back;
  dict["here"] = check->here;
  dict["travel"] = check->travel;
  dict["message"] = check->message;
  return dict;
}

py::object check_anchor(Followed& followed) {
  const AnchorCheck check = followed.at_work([&] { return followed.equilibrium().check_anchor(); });
  return anchor_check_of(check);
}

void anchor_here(Followed& followed) {
  followed.at_work([&] { followed.equilibrium().anchor_here(); });
}

// What the reports of both kinds of solve have.
template <typename Report>
py::dict outcome_of(const Report& report, double seconds) {
  py::dict dict;
  dict["status"] = py::str(std::string(status_name(report.status)));
  dict["message"] = report.message;
  dict["residual"] = report.residual;
  dict["iterations"] = report.iterations;
  dict["seconds"] = seconds;
  return dict;
}

py::dict warm_solve(Followed& followed) {
  const WarmSolve warm = followed.at_work([&] {
    WarmSolve report = followed.equilibrium().solve();
    followed.keep_shape();
    return report;
  });
  py::dict dict = outcome_of(warm, warm.seconds);
  dict["is_quick"] = warm.is_quick;
  dict["predicted"] = warm.predicted;
  dict["travel"] = warm.travel;
  dict["jump"] = warm.jump;
  dict["lost_branch"] = lost_branch_of(warm);
  dict["anchor"] = anchor_check_of(warm.anchor);
  dict["switched"] = switch_list(warm.switched);
  return dict;
}

// Of the solve from the scene's own start.
py::dict first_solve(Followed& followed) {
  return outcome_of(followed.tracked.first, followed.tracked.first.wall_s);
}

// (name, how many numbers) of each parameter, in the order of the vector.
py::list parameters_of(Followed& followed) {
  py::list list;
  for (size_t k = 0; k < followed.equilibrium().parameter_count(); ++k) {
    const Parameter& parameter = followed.equilibrium().parameter(k);
    list.append(py::make_tuple(parameter.name(), parameter.value().size()));
  }
  return list;
}

py::dict lines_by_term(Followed& followed) {
  std::map<std::string, std::vector<std::array<int, 2>>> ends;
  for (const Line& line : followed.tracked.model.lines) {
    auto& all = ends[line.term];
    if (all.size() <= static_cast<size_t>(line.element)) all.resize(static_cast<size_t>(line.element) + 1);
    all[static_cast<size_t>(line.element)] = {line.a, line.b};
  }
  py::dict dict;
  for (const auto& [term, all] : ends)
    dict[py::str(term)] =
        py::array_t<int>({all.size(), size_t{2}}, all.front().data());  // copies; rows of two lie together
  return dict;
}

py::array_t<int> node_array(const std::vector<int>& nodes) {
  return py::array_t<int>(static_cast<py::ssize_t>(nodes.size()), nodes.data());
}

py::dict sets_of(Followed& followed) {
  py::dict dict;
  for (const auto& [name, nodes] : followed.tracked.model.sets) dict[py::str(name)] = node_array(nodes);
  return dict;
}

// Nodes that each dead load pulls at.
py::dict loads_of(Followed& followed) {
  py::dict dict;
  for (const auto& term : followed.tracked.model.objective->terms())
    if (is_dead_load(*term)) dict[py::str(term->name())] = node_array(term->stencils().nodes);
  return dict;
}

template <typename Array>
Array read_only(Array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array faces_of(const py::object& self) {
  const Triangles& triangles = self.cast<Followed&>().tracked.model.mesh.triangles;
  return read_only(py::array_t<int>({triangles.cols(), Eigen::Index{3}}, triangles.data(), self));
}

}  // namespace

py::list switch_list(const std::vector<Switch>& switches) {
  py::list list;
  for (const Switch& each : switches)
    list.append(py::make_tuple(each.term, each.element, each.before, each.after, each.is_kink));
  return list;
}

void Followed::add(const std::vector<std::string>& names) {
  require_idle();
  std::vector<std::string> defects;
  for (const std::string& name : names) try {
      add(make_named_parameter(name, scene, tracked));
    } catch (const InputError& error) {
      defects.insert(defects.end(), error.defects().begin(), error.defects().end());
    }
  if (!defects.empty()) throw InputError(defects);
}

void Followed::add(std::unique_ptr<Parameter> parameter) {
  const std::string& name = parameter->name();
  const bool is_place = name.ends_with(".positions") || name.ends_with(".rest");
  const Vector own = parameter->value();
  equilibrium().add(std::move(parameter));
  const Eigen::Index before = offset_.size(), count = own.size();
  offset_.conservativeResize(before + count);
  value_.conservativeResize(before + count);
  offset_.tail(count) = is_place ? Vector(origin().replicate(count / 3, 1)) : Vector(Vector::Zero(count));
  value_.tail(count) = own + offset_.tail(count);
}

// Numbers that stay are left to the bit, whatever the origin rounds.
Vector Followed::own(const Vector& value) {
  Vector own = equilibrium().value();
  if (value.size() != own.size()) return value;  // refused with both sizes
  own = (value.array() == value_.array()).select(own, value - offset_);
  return own;
}

void Followed::set(const Vector& value) {
  at_work([&] { equilibrium().set(own(value)); });
  value_ = value;
}

void Followed::resume(const Vector& value, const Points& x) {
  at_work([&] {
    if (x.cols() != tracked.model.X.cols())
      throw InputError("resume: " + std::to_string(x.cols()) + " nodes were given; the scene has " +
                       std::to_string(tracked.model.X.cols()));
    equilibrium().resume_at(own(value), tracked.model.objective->unknowns(x.colwise() - origin()));
    keep_shape();
  });
  value_ = value;
}

void Followed::keep_shape() {
  shape_ = std::make_shared<const Points>(equilibrium().positions().colwise() + origin());
}

py::array_t<double> Followed::shape() {
  const py::capsule owner(new std::shared_ptr<const Points>(shape_),
                          [](void* pointer) { delete static_cast<std::shared_ptr<const Points>*>(pointer); });
  return read_only(py::array_t<double>({shape_->cols(), Eigen::Index{3}}, shape_->data(), owner));
}

void define_equilibrium(py::module_& module) {
  py::class_<Followed, std::shared_ptr<Followed>> type(module, "Followed",
                                                       "A scene that is followed while parameters change.");
  const auto idle = [](auto function) {
    return [function](Followed& self) {
      self.require_idle();
      return function(self);
    };
  };
  type.def(
          "add", [](Followed& self, const std::string& name) { self.add({name}); }, py::arg("name"))
      .def("solve", &warm_solve)
      .def("check_anchor", &check_anchor)
      .def("anchor_here", &anchor_here)
      .def(
          "set", [](Followed& self, const Numbers& value) { self.set(vector_in(value)); }, py::arg("value"))
      .def(
          "resume",
          [](Followed& self, const Numbers& value, const Numbers& x) {
            self.resume(vector_in(value), points_in(x));
          },
          py::arg("value"), py::arg("x"))
      .def("value", idle([](Followed& self) { return vector_array(self.value()); }))
      .def("first_solve", &first_solve)
      .def("parameters", idle(&parameters_of))
      .def("available", idle([](Followed& self) { return parameter_names(self.tracked); }))
      .def("lines", &lines_by_term)
      .def("loads", &loads_of)
      .def("sets", &sets_of)
      .def_property_readonly("faces", &faces_of)
      .def_property_readonly("node_count", [](const Followed& self) { return self.tracked.model.X.cols(); })
      .def_property_readonly("vertex_count",
                             [](const Followed& self) { return self.tracked.model.mesh.vertex_count(); })
      .def_property_readonly("contact_range",
                             [](const Followed& self) { return self.tracked.model.contact_range; })
      .def_property_readonly("x", idle([](Followed& self) { return self.shape(); }));
  module.def("follow", &follow, py::arg("input"), py::kw_only(), py::arg("parameters"), py::arg("solver"),
             py::arg("tolerance"), py::arg("max_seconds"),
             "Solves what is handed over, without the interpreter lock, and takes its equilibrium up.");
  define_metrics(module);
  define_derivatives(type);
}

}  // namespace coapt::python
