// One surface brought onto another.
#include "module.hpp"
#include "registration/wanted_registration.hpp"
#include "results/reference/coaptation_line.hpp"

#include <optional>
#include <pybind11/stl.h>
#include <string>

namespace coapt::python {
namespace {

py::dict figures_of(const RegistrationDistance& distance) {
  py::dict figures;
  figures["mean_mm"] = distance.mean;
  figures["p95_mm"] = distance.p95;
  figures["rms_mm"] = distance.rms;
  figures["max_mm"] = distance.max;
  return figures;
}

py::dict distances_of(const RegistrationDistances& distances) {
  py::dict both;
  both["to_target"] = figures_of(distances.to_target);
  both["from_target"] = figures_of(distances.from_target);
  return both;
}

py::object lines_of(const std::optional<LineDistance>& lines) {
  if (!lines) return py::none();
  py::dict both;
  for (const auto& [key, d] : {std::pair{"to_target", lines->there}, std::pair{"from_target", lines->back}}) {
    py::dict figures;
    figures["mean_mm"] = d.mean;
    figures["p95_mm"] = d.p95;
    figures["max_mm"] = d.max;
    both[key] = figures;
  }
  return both;
}

py::array_t<double> matrix_of(const RigidMotion& motion) {
  const Eigen::Matrix<double, 4, 4, Eigen::RowMajor> rows = motion.matrix();
  return py::array_t<double>({4, 4}, rows.data());
}

py::dict register_arrays(const Numbers& vertices, const Corners& triangles, const Numbers& target_vertices,
                         const Corners& target_triangles, const std::string& method, double trim,
                         bool with_scale, const std::optional<Numbers>& landmarks,
                         const std::optional<Numbers>& target_landmarks) {
  const TriangleMesh moving{points_in(vertices), triangles_in(triangles), {}, {}},
      target{points_in(target_vertices), triangles_in(target_triangles), {}, {}};
  WantedRegistration wanted{registration_method(method).value(), {trim, with_scale}};
  if (landmarks && target_landmarks) {
    wanted.moving_landmarks = points_in(*landmarks);
    wanted.target_landmarks = points_in(*target_landmarks);
  }
  TriangleMesh moved = moving;
  Registration found;
  RegistrationDistances before, after;
  std::optional<LineDistance> lines;
  {
    const py::gil_scoped_release unlocked;
    found = register_by(wanted, moving, target);
    moved.vertices = found.motion.apply(moved.vertices);
    before = registration_distances(moving, target);
    after = registration_distances(moved, target);
    lines = distance_of_lines(moved, target);
  }
  py::dict result;
  result["method"] = method;
  result["transform"] = matrix_of(found.motion);
  result["scale"] = found.motion.scale;
  result["angle_deg"] = found.motion.angle_deg();
  result["translation_mm"] = moved_by(found.motion, moving.vertices);
  result["rms_mm"] = found.rms;
  result["standard_error_mm"] = found.standard_error;
  result["overlap"] = found.overlap;
  result["pairs"] = found.pairs;
  result["iterations"] = found.iterations;
  result["free_directions"] = found.free_directions;
  result["distances_before"] = distances_of(before);
  result["distances_after"] = distances_of(after);
  result["coaptation_line"] = lines_of(lines);
  result["distance_to_target"] = vector_array(after.moving_vertices);
  result["distance_from_target"] = vector_array(after.target_vertices);
  result["warnings"] = registration_doubts(found);
  result["V"] = array_of(std::move(moved.vertices));
  return result;
}

}  // namespace

void define_registration(py::module_& module) {
  module.def("register_surface", register_arrays, py::arg("vertices"), py::arg("triangles"),
             py::arg("target_vertices"), py::arg("target_triangles"), py::arg("method"), py::arg("trim"),
             py::arg("with_scale"), py::arg("landmarks"), py::arg("target_landmarks"));
}

}  // namespace coapt::python
