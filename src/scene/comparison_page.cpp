// The numbers behind compare.html.
#include "mesh/top_view.hpp"
#include "scene/detail/comparison_json.hpp"
#include "scene/detail/comparison_template.hpp"
#include "scene/detail/json_text.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kGrains = 20000;  // positions that the page tells apart along the extent
constexpr int kShades = 255;       // distances that it does

const RunReport* first_run(const Comparison& comparison) {
  for (const ComparedMethod& method : comparison.methods)
    if (method.run) return &*method.run;
  return nullptr;
}

// As seen from the atrium; without an annulus from where most of the surface faces, else from above.
ViewFrame frame_of(const RunReport& run) {
  const Model& model = run.model;
  const Fields& fields = run.report.fields;
  if (const std::vector<int>* annulus = annulus_of(model)) return annulus_frame(model, fields, *annulus);
  Vec3 facing = Vec3::Zero();
  for (int t = 0; t < model.mesh.triangle_count(); ++t)
    facing += area_vector(fields.x, model.mesh.triangles.col(t));
  const double area = surface_area(fields.x, model.mesh.triangles);
  const Vec3 centre = 0.5 * (fields.x.rowwise().minCoeff() + fields.x.rowwise().maxCoeff());
  return view_frame(centre, facing.norm() > 0.01 * area ? facing : Vec3::UnitZ());
}

// The nodes that are drawn: obstacles, which come last, are not.
Eigen::Index drawn_nodes(const Model& model) {
  int last = model.mesh.vertex_count() - 1;
  for (const Line& line : model.lines) last = std::max({last, line.a, line.b});
  return last + 1;
}

Json whole_numbers(const Points& points, double unit) {
  Json numbers = Json::array();
  for (const double value : points.reshaped()) numbers.push_back(std::lround(value / unit));
  return numbers;
}

Json shades(const Vector& distance, double map_max) {
  Json numbers = Json::array();
  for (const double value : distance)
    numbers.push_back(std::lround(kShades * std::min(1.0, value / map_max)));
  return numbers;
}

// The greatest distance but for the outermost twentieth of some surface, and no less than what counts as
// none.
double map_end(const Comparison& comparison) {
  double end = kSameShape * comparison.extent_mm;
  for (const ComparedMethod& method : comparison.methods)
    if (method.gap && method.gap->surfaces) end = std::max(end, method.gap->surfaces->to_reference.p95);
  return end;
}

void add_shapes(const Comparison& comparison, const RunReport& first, Json& page) {
  const ViewFrame frame = frame_of(first);
  const double extent = comparison.extent_mm > 0 ? comparison.extent_mm : 1, unit = extent / kGrains,
               map_max = map_end(comparison);
  const Model& model = first.model;
  page["unit_mm"] = unit;
  page["map_max"] = map_max;
  for (const int corner : model.mesh.triangles.reshaped()) page["triangles"].push_back(corner);
  for (const Line& line : model.lines) page["lines"].insert(page["lines"].end(), {line.a, line.b});
  for (const ComparedMethod& method : comparison.methods) {
    if (!method.run) continue;
    const Points x = method.run->report.fields.x.leftCols(drawn_nodes(model)).colwise() +
                     (method.run->model.origin - model.origin);
    page["shapes"].push_back({{"name", method.name},
                              {"points", whole_numbers(in_frame(x, frame), unit)},
                              {"shades", shades(method.run->report.fields.method_distance, map_max)}});
  }
}

// A page's script ends at the first `</script`, wherever it stands: no `<` is left in the data.
std::string without_tags(const std::string& json) {
  std::string text;
  for (const char c : json)
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  return text;
}

}  // namespace

std::string comparison_page(const Comparison& comparison) {
  Json page = {{"study", comparison_as_json(comparison)},
               {"unit_mm", 1.0},
               {"map_max", 1.0},
               {"triangles", Json::array()},
               {"lines", Json::array()},
               {"shapes", Json::array()}};
  if (const RunReport* first = first_run(comparison)) add_shapes(comparison, *first, page);
  return std::string(kPageBegin) + without_tags(json_text(page)) + std::string(kPageEnd);
}

}  // namespace coapt
