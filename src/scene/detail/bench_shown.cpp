#include "scene/detail/mesh_error_view.hpp"

#include "scene/benchmark_summary.hpp"
#include "scene/solve_view.hpp"

namespace coapt {

namespace {

std::string size_text(int triangles) { return mesh_text({.triangles = triangles}); }

}  // namespace

ShapeView mesh_error_view(const Model& model, const Points& x, const TriangleMesh& finer) {
  const Fields fields = compute_fields(model, x);
  Vector distance;
  reference_distance(surface_at(model, x), finer, distance);
  ShapeView view = bare_view(model, fields);
  view.name = "mesh-error";
  if (view.is_valve) view.slider = "Open ↔ closed";
  view.states = {{"at rest", x - fields.displacement},
                 {"equilibrium on " + size_text(model.mesh.triangle_count()), x}};
  view.fields = view_fields(model, fields);
  view.fields.insert(view.fields.begin(),
                     {.title = "Distance to the equilibrium on " + size_text(finer.triangle_count()),
                      .unit = "mm",
                      .values = {distance}});
  if (!model.lines.empty())
    view.line_force = {.title = "Force in chords and cables",
                       .unit = "N",
                       .place = ViewPlace::Line,
                       .values = {fields.line_force}};
  add_outlines(measure(model, model.objective->unknowns(x), fields), view);
  return view;
}

}  // namespace coapt
