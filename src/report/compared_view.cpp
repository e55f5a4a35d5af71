#include "report/compared_view.hpp"

#include "report/solve_page.hpp"

#include <algorithm>

namespace coapt {
namespace {

// The nodes of sheet and lines; those of obstacles come last.
Eigen::Index own_nodes(const Model& model) {
  int last = model.mesh.vertex_count() - 1;
  for (const Line& line : model.lines) last = std::max({last, line.a, line.b});
  return last + 1;
}

// To one of `count` shapes that share the page.
std::vector<RecordedShape> short_history(const ComparedShape& shape, size_t count) {
  const Model& model = *shape.model;
  const Report& report = *shape.report;
  if (report.shape_history.empty()) return {{{}, model.X}};
  return subsampled(report.shape_history, report.fields.x, std::max<size_t>(1, page_shapes(model) / count));
}

// Puts the fields of a state, the last so far, to those of the same title; others have no values in it.
void add_fields(const std::vector<ViewField>& fields, size_t state_count, std::vector<ViewField>& all) {
  for (const ViewField& field : fields) {
    auto same =
        std::find_if(all.begin(), all.end(), [&](const ViewField& f) { return f.title == field.title; });
    if (same == all.end()) {
      same = all.insert(all.end(), field);
      same->values.clear();
    }
    same->values.resize(state_count - 1);
    same->values.push_back(field.values.front());
  }
  for (ViewField& field : all) field.values.resize(state_count);
}

bool has_same_obstacles(const Model& a, const Model& b) {
  return a.X.cols() == b.X.cols() && a.obstacles.cols() == b.obstacles.cols() && a.obstacles == b.obstacles;
}

bool has_same_lines(const Model& a, const Model& b) {
  return std::equal(a.lines.begin(), a.lines.end(), b.lines.begin(), b.lines.end(),
                    [](const Line& x, const Line& y) { return x.a == y.a && x.b == y.b; });
}

}  // namespace

std::optional<ShapeView> compared_view(const std::vector<ComparedShape>& shapes, size_t base,
                                       const std::string& name, const std::string& slider) {
  if (shapes.empty()) return std::nullopt;
  const Model& surface = *shapes.at(base).model;
  Eigen::Index nodes = own_nodes(surface);
  const auto is_like_base = [&, own = nodes](const Model& model) {
    return own_nodes(model) == own && model.mesh.triangles.cols() == surface.mesh.triangles.cols() &&
           model.mesh.triangles == surface.mesh.triangles;
  };
  const bool has_obstacles =
      surface.obstacles.cols() > 0 &&
      std::all_of(shapes.begin(), shapes.end(), [&](const ComparedShape& shape) {
        return !is_like_base(*shape.model) || has_same_obstacles(*shape.model, surface);
      });
  if (has_obstacles) nodes = surface.X.cols();
  ShapeView view = bare_view(surface, shapes[base].report->fields);
  view.name = name;
  view.slider = slider;
  if (!has_obstacles) view.obstacles.resize(3, 0);
  if (!surface.lines.empty())
    view.line_force = {.title = "Force in chords and cables", .unit = "N", .place = ViewPlace::Line};
  for (const ComparedShape& shape : shapes)
    if (is_like_base(*shape.model) && !has_same_lines(*shape.model, surface)) view.line_force.reset();
  for (const ComparedShape& shape : shapes) {
    const Model& model = *shape.model;
    if (!is_like_base(model)) continue;
    std::vector<ViewState> states = {result_state(shape.label, *shape.report, view.frame.up)};
    if (shape.has_history) {
      states = view_states(*shape.report, short_history(shape, shapes.size()), view.frame.up);
      states.back().label = shape.label + ", residual " + page_number(shape.report->result.residual, 2);
      view.sequences.push_back({shape.label, states.size()});
    }
    const Vec3 shift = model.origin - surface.origin;
    for (ViewState& state : states) {
      state.x = state.x.leftCols(nodes).colwise() + shift;
      for (ViewOutline& outline : state.outlines) outline.points.colwise() += shift;
      view.states.push_back(std::move(state));
    }
    add_fields(view_fields(model, shape.report->fields), view.states.size(), view.fields);
    if (!view.line_force) continue;
    view.line_force->values.resize(view.states.size() - 1);
    view.line_force->values.push_back(shape.report->fields.line_force);
  }
  view.is_pair = view.states.size() == 2 && view.sequences.empty();
  return view;
}

}  // namespace coapt
