#include "results/reference/reference_results.hpp"

#include "results/study_files.hpp"

namespace coapt {
OrderedJson registration_json(const Registration& found, double translation_mm) {
  const Eigen::Matrix4d m = found.motion.matrix();
  OrderedJson rows = OrderedJson::array();
  for (int r = 0; r < 4; ++r) rows.push_back({m(r, 0), m(r, 1), m(r, 2), m(r, 3)});
  return {{"method", registration_method_name(found.method)},
          {"transform", rows},
          {"scale", found.motion.scale},
          {"angle_deg", found.motion.angle_deg()},
          {"translation_mm", translation_mm},
          {"rms_mm", found.rms},
          {"standard_error_mm", found.standard_error ? number_json(*found.standard_error) : OrderedJson()},
          {"overlap", found.overlap},
          {"pairs", found.pairs},
          {"iterations", found.iterations},
          {"free_directions", found.free_directions}};
}

OrderedJson reference_json(const ReferenceDistance& distance) {
  OrderedJson json = distances_json(both_directions(distance));
  json["to_reference"] = distances_json(distance.to_reference);
  json["from_reference"] = distances_json(distance.from_reference);
  json["left_out_nodes"] = distance.left_out;
  if (const auto& same = distance.same_vertex)
    json["same_vertex"] = {{"mean_mm", number_json(same->mean)}, {"max_mm", number_json(same->max)}};
  if (distance.lines)
    json["coaptation_line"] = {{"to_reference", distances_json(distance.lines->there)},
                               {"from_reference", distances_json(distance.lines->back)}};
  if (const auto& registration = distance.registration) {
    OrderedJson& applied = json["registration"] =
        registration_json(registration->found, registration->translation_mm);
    applied["to_reference_before"] = distances_json(registration->to_reference_before);
    applied["from_reference_before"] = distances_json(registration->from_reference_before);
  }
  return json;
}

VtpSurface registered_surface(const Model& model, const Fields& fields) {
  VtpSurface surface;
  surface.vertices = fields.registered_reference->vertices.colwise() + model.origin;
  surface.triangles = fields.registered_reference->triangles;
  surface.point_arrays = {{"distance_to_result", fields.registered_distance.transpose(), false}};
  surface.texts.push_back({"units", {"mm"}});
  return surface;
}

}  // namespace coapt
