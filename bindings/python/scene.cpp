// Scenes solved, and what comes out.
#include "cli/solvers.hpp"
#include "core/error.hpp"
#include "core/timing.hpp"
#include "module.hpp"
#include "scene/run.hpp"
#include "scene/schema.hpp"
#include "solution.hpp"

#include <optional>
#include <pybind11/stl.h>
#include <string>
#include <vector>

namespace coapt::python {
namespace {

using PointArray = py::array_t<double, py::array::c_style>;
using TriangleArray = py::array_t<int, py::array::c_style>;

// As Python hands it over: arrays of the right type and shape, paths as bytes of the file system.
struct Request {
  std::optional<std::string> text;  // of the scene; none: `file` is read
  std::string file;                 // or what messages call the text
  std::optional<TriangleMesh> mesh;
  std::optional<Points> start;
  RunOptions options;
};

std::optional<TriangleMesh> mesh_of(const std::optional<PointArray>& vertices,
                                    const std::optional<TriangleArray>& triangles, std::vector<int> regions,
                                    std::vector<std::string> region_names) {
  if (!vertices || !triangles) return std::nullopt;
  return TriangleMesh{points_in(*vertices),
                      Eigen::Map<const Triangles>(triangles->data(), 3, triangles->shape(0)),
                      std::move(regions), std::move(region_names)};
}

Scene scene_of(const Request& request) {
  if (!request.text) return load_scene(request.file);
  return request.mesh ? parse_scene_around_mesh(*request.text, request.file)
                      : parse_scene(*request.text, request.file);
}

// Without the interpreter lock.
std::unique_ptr<Solution> solved(Request request, Given given) {
  const double start = wall_seconds();
  const Scene scene = scene_of(request);
  given.mesh = std::move(request.mesh);
  given.start = std::move(request.start);
  RunReport run = coapt::run(scene, std::move(given), cli::all_solvers(), request.options);
  return std::make_unique<Solution>(std::move(run), start);
}

std::unique_ptr<Solution> run_request(Request request, const py::list& terms, py::handle callback) {
  Failure failure;
  Given given;
  given.terms = terms_of(terms, failure);
  given.has_hessians = all_have_hessians(terms);
  given.observer = [callback, &failure](const Model& model) { return observer_of(callback, failure, model); };
  request.options.factorisations = cli::all_factorisations();
  request.options.judge = cli::intersection_judge();
  std::unique_ptr<Solution> solution;
  try {
    const py::gil_scoped_release unlocked;
    solution = solved(std::move(request), std::move(given));
  } catch (...) {
    failure.rethrow();  // what the caller's code raised says more than what followed from it
    throw;
  }
  failure.rethrow();
  return solution;
}

std::unique_ptr<Solution> run(const std::optional<std::string>& text, const std::string& file,
                              const std::optional<PointArray>& vertices,
                              const std::optional<TriangleArray>& triangles, std::vector<int> regions,
                              std::vector<std::string> region_names, const std::optional<PointArray>& start,
                              const py::list& terms, const py::object& callback, const std::string& solver,
                              std::optional<double> tolerance, std::optional<double> max_seconds,
                              std::optional<int> modes, const std::optional<std::string>& folder,
                              std::optional<int> frames, std::optional<bool> page) {
  Request request{
      text, file, mesh_of(vertices, triangles, std::move(regions), std::move(region_names)), {}, {}};
  if (start) request.start = points_in(*start);
  RunOptions& options = request.options;
  options.solver = solver;
  options.tolerance = tolerance;
  options.max_seconds = max_seconds;
  options.modes = modes;
  options.frame_interval = frames;
  options.writes_page = page;
  options.writes = folder.has_value();
  if (folder) options.folder = *folder;
  return run_request(std::move(request), terms, callback);
}

std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& [name, factory] : cli::all_solvers()) names.push_back(name);
  return names;
}

}  // namespace

void define_scene(py::module_& module) {
  define_solution(module);
  module.def("methods", &method_names, "Names of the solvers of this build.");
  module.def("scene_schema", &json_schema, "JSON Schema of the scene file, as text.");
  module.def("run", &run, py::kw_only(), py::arg("text"), py::arg("file"), py::arg("vertices"),
             py::arg("triangles"), py::arg("regions"), py::arg("region_names"), py::arg("start"),
             py::arg("terms"), py::arg("callback"), py::arg("solver"), py::arg("tolerance"),
             py::arg("max_seconds"), py::arg("modes"), py::arg("folder"), py::arg("frames"), py::arg("page"),
             "Solves one scene, without the interpreter lock.");
}

}  // namespace coapt::python
