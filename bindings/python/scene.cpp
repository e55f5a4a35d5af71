// Scenes solved, and what comes out.
#include "adapters.hpp"
#include "cli/solvers.hpp"
#include "core/timing.hpp"
#include "exchange/import.hpp"
#include "input.hpp"
#include "run/branches.hpp"
#include "scene/file/schema.hpp"
#include "solution.hpp"
#include "tuning/first_order.hpp"
#include "valve/generators/mitral.hpp"

#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <vector>

namespace coapt::python {
namespace {

std::unique_ptr<Solution> run(const Input& input, const py::object& callback, const std::string& solver,
                              std::optional<double> tolerance, std::optional<double> max_seconds,
                              std::optional<int> modes, const std::optional<std::string>& folder,
                              std::optional<int> frames, std::optional<bool> page, int branches,
                              double branch_kick, std::uint64_t branch_seed,
                              std::optional<int> damped_steps) {
  RunOptions options;
  options.solver = solver;
  options.tolerance = tolerance;
  options.max_seconds = max_seconds;
  options.damped_steps = damped_steps;
  options.modes = modes;
  options.frame_interval = frames;
  options.writes_page = page;
  options.writes = folder.has_value();
  if (folder) options.folder = *folder;
  options.factorisations = factorisations();
  options.checker = checker();
  Failure failure;
  if (!input.vertices && input.terms.empty())  // the scene says all that its sliders are made of
    options.first_order = [options, &failure](const Scene& scene, const Model& model, const Report& report) {
      RunOptions interruptible = options;
      interruptible.observer = observer_of(py::handle(Py_None), failure, model);
      return first_order_of_runs(cli::all_solvers(), interruptible)(scene, model, report);
    };
  Given given = input.given(failure);
  const bool is_from_given_start = given.start.has_value();
  given.observer = [callback = py::handle(callback), &failure](const Model& model) {
    return observer_of(callback, failure, model);
  };
  return failure.guarding([&] {
    const double start = wall_seconds();
    const Scene scene = input.scene();
    RunReport report = coapt::run(scene, std::move(given), cli::all_solvers(), options);
    if (branches > 0 && !failure.is_set()) {
      options.observer = observer_of(callback, failure, report.model);
      report.report = with_branches(scene, cli::all_solvers(), options,
                                    {branches, branch_kick, branch_seed, !is_from_given_start}, report.model,
                                    std::move(report.report), report.folder);
    }
    return std::make_unique<Solution>(std::move(report), start);
  });
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& [name, factory] : cli::all_solvers()) names.push_back(name);
  return names;
}

void generate_mitral(const std::string& folder, int triangles, unsigned seed, const std::string& preset) {
  write_valve_scene(mitral_valve({.triangles = triangles, .seed = seed, .preset = mitral_preset(preset)}),
                    folder);
}

py::list import_to_folder(const std::string& file, const std::string& folder,
                          const std::string& annulus_closed, const std::string& papillary,
                          const std::string& papillary_closed, const std::string& pressure,
                          const std::string& young, const std::string& chord_young,
                          const std::string& contact, const std::string& model, bool repairs,
                          bool takes_any_size) {
  ImportOptions options;
  options.annulus_closed = annulus_closed;
  options.papillary = papillary;
  options.papillary_closed = papillary_closed;
  options.pressure = pressure;
  options.young = young;
  options.chord_young = chord_young;
  options.contact = contact;
  options.model = model;
  options.repairs = repairs;
  options.takes_any_size = takes_any_size;
  std::vector<std::string> warnings;
  {
    const py::gil_scoped_release unlocked;
    warnings = import_valve(file, folder, options);
  }
  py::list texts;
  for (const std::string& warning : warnings) texts.append(text_of(warning));
  return texts;
}

}  // namespace

void define_scene(py::module_& module) {
  define_input(module);
  define_solution(module);
  module.def("generate_mitral", &generate_mitral, py::kw_only(), py::arg("folder"), py::arg("triangles"),
             py::arg("seed"), py::arg("preset"),
             "Writes the generated mitral valve with a scene into a folder.");
  module.def("import_valve", &import_to_folder, py::kw_only(), py::arg("file"), py::arg("folder"),
             py::arg("annulus_closed"), py::arg("papillary"), py::arg("papillary_closed"),
             py::arg("pressure"), py::arg("young"), py::arg("chord_young"), py::arg("contact"),
             py::arg("model"), py::arg("repairs"), py::arg("takes_any_size"),
             "Writes a scene from a valve file into a folder; empty texts stand for the defaults.");
  module.def("methods", &method_names, "Names of the solvers of this build.");
  module.def("scene_schema", &json_schema, "JSON Schema of the scene file, as text.");
  module.def("run", &run, py::arg("input"), py::kw_only(), py::arg("callback"), py::arg("solver"),
             py::arg("tolerance"), py::arg("max_seconds"), py::arg("modes"), py::arg("folder"),
             py::arg("frames"), py::arg("page"), py::arg("branches"), py::arg("branch_kick"),
             py::arg("branch_seed"), py::arg("damped_steps"),
             "Solves what is handed over, without the interpreter lock.");
}

}  // namespace coapt::python
