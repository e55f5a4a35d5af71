#include "input.hpp"

#include <pybind11/stl.h>
#include <vector>

namespace coapt::python {
namespace {

Input input_of(std::optional<std::string> text, std::string file, const std::optional<Numbers>& vertices,
               const std::optional<Corners>& triangles, std::vector<int> regions,
               std::vector<std::string> region_names, const std::optional<Numbers>& start, py::list terms) {
  Input input{std::move(text), std::move(file), {}, {}, std::move(terms)};
  if (vertices && triangles)
    input.mesh = TriangleMesh{points_in(*vertices), triangles_in(*triangles), std::move(regions),
                              std::move(region_names)};
  if (start) input.start = points_in(*start);
  return input;
}

}  // namespace

Scene Input::scene() const {
  if (!text) return load_scene(file);
  return mesh ? parse_scene_around_mesh(*text, file) : parse_scene(*text, file);
}

Given Input::given(Failure& failure) const {
  Given given;
  given.mesh = mesh;
  given.terms = terms_of(terms, failure);
  given.has_hessians = all_have_hessians(terms);
  given.start = start;
  return given;
}

void define_input(py::module_& module) {
  py::class_<Input>(module, "Input",
                    "What is to be solved: a scene or a mesh in memory, with terms and a start.")
      .def(py::init(&input_of), py::kw_only(), py::arg("text"), py::arg("file"), py::arg("vertices"),
           py::arg("triangles"), py::arg("regions"), py::arg("region_names"), py::arg("start"),
           py::arg("terms"));
}

}  // namespace coapt::python
