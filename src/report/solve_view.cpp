#include "report/solve_view.hpp"

#include "core/number_text.hpp"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>

namespace coapt {
namespace {

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kOutlineWidth = 1.0 / 30;  // of the perimeter, over which heights of an outline are averaged

Vector of_flags(const std::vector<char>& flags) {
  Vector values(std::ssize(flags));
  for (Eigen::Index k = 0; k < values.size(); ++k) values[k] = flags[static_cast<size_t>(k)];
  return values;
}

std::string millimetres(double value) { return page_number(value, 3) + " mm"; }

void add_contact(const Fields& fields, std::vector<ViewField>& all) {
  if (fields.gap.size() == 0) return;
  // Infinite where nothing was found.
  const Vector gap = fields.gap.unaryExpr(
      [](double value) { return std::isfinite(value) && value >= 0 ? value : kNothing; });
  all.push_back({.title = "Gap to the nearest other facet",
                 .unit = "mm",
                 .values = {gap},
                 .is_reversed = true,
                 .none = "none within " + millimetres(fields.gap_reach)});
  all.push_back({.title = "Contact",
                 .place = ViewPlace::Triangle,
                 .values = {of_flags(fields.is_contact_facet)},
                 .categories = {"apart", "within " + millimetres(fields.contact_distance)}});
}

void add_distances(const Fields& fields, std::vector<ViewField>& all) {
  if (fields.reference_distance.size() > 0)
    all.push_back({.title = "Distance to the given closed surface",
                   .unit = "mm",
                   .values = {fields.reference_distance}});
  if (fields.method_distance.size() > 0)
    all.push_back({.title = kMethodDistance, .unit = "mm", .values = {fields.method_distance}});
  if (fields.branch_spread.size() > 0 && fields.branch_spread.maxCoeff() > 0)
    all.push_back({.title = "Distance to other equilibria", .unit = "mm", .values = {fields.branch_spread}});
}

void add_of_triangles(const std::string& title, const char* unit, const Vector& values,
                      std::vector<ViewField>& all) {
  all.push_back({.title = title, .unit = unit, .place = ViewPlace::Triangle, .values = {values}});
}

void add_principal(const std::string& title, const char* unit, const Eigen::Matrix2Xd& values,
                   std::vector<ViewField>& all) {
  if (values.cols() == 0) return;
  add_of_triangles("Greater " + title, unit, values.row(0), all);
  add_of_triangles("Lesser " + title, unit, values.row(1), all);
}

// What a reader of papers looks for first.
void add_stress_and_strain(const Fields& fields, std::vector<ViewField>& all) {
  add_principal("principal Cauchy stress", "kPa", kKilopascals * fields.cauchy_stress, all);
  if (fields.von_mises_stress.size() > 0)
    add_of_triangles("Von Mises stress", "kPa", kKilopascals * fields.von_mises_stress, all);
  add_principal("principal strain", "", fields.principal_strain, all);
}

void add_reference_stress(const Fields& fields, std::vector<ViewField>& all) {
  add_principal("first Piola-Kirchhoff stress", "kPa", kKilopascals * fields.first_piola_stress, all);
  add_principal("second Piola-Kirchhoff stress", "MPa", fields.principal_stress, all);
  if (fields.regime.empty()) return;
  Vector regime(std::ssize(fields.regime));
  for (Eigen::Index t = 0; t < regime.size(); ++t)
    regime[t] = static_cast<double>(fields.regime[static_cast<size_t>(t)]);
  all.push_back({.title = "Taut, wrinkled, slack",
                 .place = ViewPlace::Triangle,
                 .values = {regime},
                 .categories = {"slack", "wrinkled", "taut"}});
}

void add_regions(const Model& model, std::vector<ViewField>& all) {
  if (model.mesh.regions.empty()) return;
  Vector region(model.mesh.triangle_count());
  for (Eigen::Index t = 0; t < region.size(); ++t) region[t] = model.mesh.regions[static_cast<size_t>(t)];
  all.push_back({.title = "Region",
                 .place = ViewPlace::Triangle,
                 .values = {region},
                 .categories = model.mesh.region_names});
}

std::string label(const Iteration& iteration, bool is_start) {
  if (is_start) return "start, as given";
  std::string label =
      "iterate " + std::to_string(iteration.iteration) + ", residual " + number_text(iteration.residual, 2);
  if (iteration.time > 0) label += ", after " + page_number(iteration.time, 3) + " s of motion";
  return label;
}

std::string label(const Result& result) {
  return "result: " + std::string(status_name(result.status)) + ", residual " +
         number_text(result.residual, 2);
}

// The input's x axis to the right, or where one looks along it, its y axis: the same valve stands the same
// history in every page.
ViewFrame upright(ViewFrame frame) {
  const Vec3 axis = std::abs(frame.up.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  frame.e1 = (axis - axis.dot(frame.up) * frame.up).normalized();
  frame.e2 = frame.up.cross(frame.e1);
  return frame;
}

}  // namespace

Points smooth_outline(const Points& corners, const Vec3& up) {
  const Eigen::Index count = corners.cols();
  Vector length(count);  // from each corner to the next, seen along up
  for (Eigen::Index k = 0; k < count; ++k) {
    const Vec3 step = corners.col((k + 1) % count) - corners.col(k);
    length[k] = (step - step.dot(up) * up).norm();
  }
  const double perimeter = length.sum(), width = kOutlineWidth * perimeter;
  if (!(perimeter > 0)) return corners;
  Points smooth = corners;
  for (Eigen::Index k = 0; k < count; ++k) {
    double sum = 0, weights = 0;
    // Both ways round until the weights vanish, each corner for the stretches at it.
    for (const int way : {-1, 1}) {
      double away = 0;
      for (Eigen::Index j = 0; j < count && away < std::min(3 * width, perimeter / 2); ++j) {
        const Eigen::Index at = ((k + way * j) % count + count) % count, before = (at + count - 1) % count;
        const double weight =
            0.5 * (length[before] + length[at]) * std::exp(-0.5 * away * away / (width * width));
        if (way == 1 || j > 0) {
          sum += weight * corners.col(at).dot(up);
          weights += weight;
        }
        away += way > 0 ? length[at] : length[before];
      }
    }
    if (weights > 0) smooth.col(k) += (sum / weights - corners.col(k).dot(up)) * up;
  }
  return smooth;
}

ViewFrame viewing_frame(const Model& model, const Fields& fields) {
  if (const std::vector<int>* annulus = annulus_of(model)) return annulus_frame(model, fields, *annulus);
  Vec3 facing = Vec3::Zero();
  for (int t = 0; t < model.mesh.triangle_count(); ++t)
    facing += area_vector(fields.x, model.mesh.triangles.col(t));
  const double area = surface_area(fields.x, model.mesh.triangles);
  const Vec3 centre = 0.5 * (fields.x.rowwise().minCoeff() + fields.x.rowwise().maxCoeff());
  return view_frame(centre, facing.norm() > 0.01 * area ? facing : Vec3::UnitZ());
}

ShapeView bare_view(const Model& model, const Fields& fields) {
  ShapeView view;
  view.origin = model.origin;
  view.triangles = model.mesh.triangles;
  view.obstacles = model.obstacles;
  view.lines.resize(2, std::ssize(model.lines));
  for (size_t k = 0; k < model.lines.size(); ++k)
    view.lines.col(static_cast<Eigen::Index>(k)) << model.lines[k].a, model.lines[k].b;
  view.frame = upright(viewing_frame(model, fields));
  view.is_valve = annulus_of(model) != nullptr;
  return view;
}

std::vector<ViewField> view_fields(const Model& model, const Fields& fields) {
  std::vector<ViewField> all;
  add_stress_and_strain(fields, all);
  add_contact(fields, all);
  add_distances(fields, all);
  const Vector moved = fields.displacement.colwise().norm().transpose();
  all.push_back({.title = "Displacement", .unit = "mm", .values = {moved}});
  add_reference_stress(fields, all);
  add_regions(model, all);
  return all;
}

ViewState result_state(const std::string& label, const Report& report, const Vec3& up) {
  ViewState state{.label = label, .x = report.fields.x};
  if (const auto& closure = report.metrics.closure) {
    for (const Seam& seam : closure->line) state.outlines.push_back({false, seam.points});
    for (const Orifice& orifice : closure->orifices)
      state.outlines.push_back({true, smooth_outline(orifice.outline.corners, up)});
  }
  if (const auto& area = report.metrics.orifice_area_mm2)
    state.orifice_text = "orifice outline, " + page_number(*area) + " mm²";
  return state;
}

std::vector<ViewState> view_states(const Report& report, const std::vector<RecordedShape>& history,
                                   const Vec3& up) {
  std::vector<ViewState> states;
  for (const RecordedShape& shape : history)
    states.push_back({.label = label(shape.iteration, states.empty()), .x = shape.x, .is_history = true});
  states.push_back(result_state(label(report.result), report, up));
  return states;
}

ShapeView solved_view(const Model& model, const Report& report) {
  ShapeView view = bare_view(model, report.fields);
  view.name = "coapt";
  if (view.is_valve) view.slider = "Open ↔ closed";
  view.states = view_states(report, report.shape_history, view.frame.up);
  view.fields = view_fields(model, report.fields);
  view.first_order = report.first_order;
  if (model.lines.empty()) return view;
  const auto of_lines = [](const char* title, const char* unit, const Vector& values) {
    return ViewField{.title = title, .unit = unit, .place = ViewPlace::Line, .values = {values}};
  };
  view.line_force = of_lines("Force in chords and cables", "N", report.fields.line_force);
  view.line_values = {of_lines("strain", "", report.fields.line_strain),
                      of_lines("Cauchy stress", "kPa", kKilopascals * report.fields.line_stress)};
  return view;
}

}  // namespace coapt
