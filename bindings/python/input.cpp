#include "input.hpp"

#include <pybind11/stl.h>
#include <vector>

namespace coapt::python {
namespace {

Input input_of(std::optional<std::string> text, std::string file, std::optional<Numbers> vertices,
               std::optional<Corners> triangles, std::vector<int> regions,
               std::vector<std::string> region_names, std::optional<Numbers> start, py::list terms) {
  return {std::move(text),    std::move(file),         std::move(vertices), std::move(triangles),
          std::move(regions), std::move(region_names), std::move(start),    std::move(terms)};
}

}  // namespace

Scene Input::scene() const {
  if (!text) return load_scene(file);
  return vertices ? parse_scene_around_mesh(*text, file) : parse_scene(*text, file);
}

Given Input::given(Failure& failure) const {
  Given given;
  if (vertices) given.mesh = {points_in(*vertices), triangles_in(*triangles), regions, region_names};
  given.terms = terms_of(terms, failure);
  given.has_hessians = all_have_hessians(terms);
  if (start) given.start.emplace(points_in(*start));
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
