#include "results/result_surfaces.hpp"

#include "valve/fibre_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace coapt {
namespace {

// A distance at the mesh vertices over all nodes; -1 where it has no meaning (points of the networks) or no
// facet was found within reach. Readers trip over NaN.
Eigen::MatrixXd over_nodes(const Vector& of_vertices, Eigen::Index node_count) {
  Eigen::MatrixXd row = Eigen::MatrixXd::Constant(1, node_count, -1);
  for (Eigen::Index v = 0; v < of_vertices.size(); ++v)
    if (std::isfinite(of_vertices[v])) row(0, v) = of_vertices[v];
  return row;
}

// Stresses as papers print them, in kPa.
void add_stresses(const Fields& fields, std::vector<VtpArray>& arrays) {
  if (fields.cauchy_stress.cols() == 0) return;
  arrays.push_back({"cauchy_stress_1_kpa", kKilopascals * fields.cauchy_stress.row(0), false});
  arrays.push_back({"cauchy_stress_2_kpa", kKilopascals * fields.cauchy_stress.row(1), false});
  arrays.push_back({"von_mises_stress_kpa", kKilopascals * fields.von_mises_stress.transpose(), false});
  if (fields.first_piola_stress.cols() == 0) return;
  arrays.push_back({"first_piola_stress_1_kpa", kKilopascals * fields.first_piola_stress.row(0), false});
  arrays.push_back({"first_piola_stress_2_kpa", kKilopascals * fields.first_piola_stress.row(1), false});
}

// Strain and stress of the lines where some line has one: -1 for those that have none, whose strain is never
// so low and whose stress, of a line that only pulls, never negative.
void add_line_arrays(const Fields& fields, std::vector<VtpArray>& arrays) {
  arrays.push_back({"line_force_n", fields.line_force.transpose(), false});
  const auto add = [&arrays](const char* name, const Vector& values) {
    if (!values.array().isNaN().all()) arrays.push_back({name, over_nodes(values, values.size()), false});
  };
  add("line_strain", fields.line_strain);
  add("line_cauchy_stress_kpa", kKilopascals * fields.line_stress);
  add("line_yield_ratio", fields.line_yield_ratio);
}

// Flags as a row of `count` numbers; 0 behind the last.
Eigen::MatrixXd row_of(const std::vector<char>& flags, Eigen::Index count) {
  Eigen::MatrixXd row = Eigen::MatrixXd::Zero(1, count);
  for (size_t k = 0; k < flags.size(); ++k) row(0, static_cast<Eigen::Index>(k)) = flags[k];
  return row;
}

// Polylines, with arrays of one number for each of their stretches.
class Polylines {
 public:
  Polylines(const Model& model, const std::vector<std::string>& names) : model_(model), names_(names) {}

  void add(const Points& points, bool is_closed) {
    const auto first = static_cast<int>(points_.size());
    for (const auto& p : points.colwise()) points_.push_back(p + model_.origin);
    const auto last = static_cast<int>(points_.size()) - 1;
    for (int k = first; k < last; ++k) lines_.push_back({k, k + 1});
    if (is_closed) lines_.push_back({last, first});
  }

  // In the order of the names.
  void add_values(const std::vector<double>& values) { values_.push_back(values); }

  // is_integer: of each array.
  VtpSurface surface(const std::vector<bool>& is_integer) const {
    VtpSurface surface;
    surface.vertices.resize(3, static_cast<Eigen::Index>(points_.size()));
    for (size_t k = 0; k < points_.size(); ++k)
      surface.vertices.col(static_cast<Eigen::Index>(k)) = points_[k];
    surface.lines.resize(2, static_cast<Eigen::Index>(lines_.size()));
    for (size_t k = 0; k < lines_.size(); ++k)
      surface.lines.col(static_cast<Eigen::Index>(k)) << lines_[k][0], lines_[k][1];
    for (size_t a = 0; a < names_.size(); ++a) {
      Eigen::MatrixXd row(1, surface.lines.cols());
      for (size_t k = 0; k < values_.size(); ++k) row(0, static_cast<Eigen::Index>(k)) = values_[k][a];
      surface.line_arrays.push_back({names_[a], row, is_integer[a]});
    }
    if (!model_.mesh.regions.empty()) surface.texts.push_back({"region_names", model_.mesh.region_names});
    surface.texts.push_back({"units", {"mm"}});
    return surface;
  }

 private:
  const Model& model_;
  std::vector<std::string> names_;
  std::vector<Vec3> points_;
  std::vector<std::array<int, 2>> lines_;
  std::vector<std::vector<double>> values_;  // per stretch
};

}  // namespace

VtpSurface closed_surface(const Model& model, const Fields& fields) {
  VtpSurface surface;
  const Eigen::Index nodes = fields.x.cols();
  surface.vertices = fields.x.colwise() + model.origin;
  surface.triangles = model.mesh.triangles;
  surface.point_arrays = {{"displacement", fields.displacement, false}};
  if (fields.gap.size() > 0) {
    surface.point_arrays.push_back({"gap", over_nodes(fields.gap, nodes), false});
    surface.point_arrays.push_back({"contact", row_of(fields.is_contact, nodes), true});
  }
  if (fields.reference_distance.size() > 0)
    surface.point_arrays.push_back(
        {"distance_to_reference", over_nodes(fields.reference_distance, nodes), false});
  if (fields.method_distance.size() > 0)
    surface.point_arrays.push_back(
        {"distance_to_reference_method", over_nodes(fields.method_distance, nodes), false});
  if (fields.branch_spread.size() > 0)
    surface.point_arrays.push_back({"branch_spread", fields.branch_spread.transpose(), false});
  if (!fields.undetermined.empty())
    surface.point_arrays.push_back({"undetermined", row_of(fields.undetermined, nodes), true});

  surface.triangle_arrays = {{"principal_strain_1", fields.principal_strain.row(0), false},
                             {"principal_strain_2", fields.principal_strain.row(1), false}};
  if (!fields.is_contact_facet.empty())
    surface.triangle_arrays.push_back(
        {"contact", row_of(fields.is_contact_facet, model.mesh.triangle_count()), true});
  if (fields.principal_stress.cols() > 0) {
    Eigen::MatrixXd regime(1, model.mesh.triangle_count());
    for (Eigen::Index t = 0; t < regime.cols(); ++t)
      regime(0, t) = static_cast<double>(fields.regime[static_cast<size_t>(t)]);
    surface.triangle_arrays.push_back({"regime", regime, true});
    surface.triangle_arrays.push_back({"principal_stress_1_mpa", fields.principal_stress.row(0), false});
    surface.triangle_arrays.push_back({"principal_stress_2_mpa", fields.principal_stress.row(1), false});
    add_stresses(fields, surface.triangle_arrays);
  }
  if (fields.yield_ratio.size() > 0)
    surface.triangle_arrays.push_back(
        {"yield_ratio", over_nodes(fields.yield_ratio, fields.yield_ratio.size()), false});
  if (model.fibres.cols() > 0) {
    surface.triangle_arrays.push_back(
        {"fibre", carried(model.fibres, model.mesh.triangles, model.X, fields.x), false});
    surface.triangle_arrays.push_back({"fibre_anisotropy", model.fibre_anisotropy.transpose(), false});
  }
  if (!model.mesh.regions.empty()) {
    Eigen::MatrixXd region(1, model.mesh.triangle_count());
    for (int t = 0; t < model.mesh.triangle_count(); ++t) region(0, t) = model.mesh.regions[t];
    surface.triangle_arrays.push_back({"region", region, true});
    surface.texts.push_back({"region_names", model.mesh.region_names});
  }
  surface.lines.resize(2, static_cast<Eigen::Index>(model.lines.size()));
  for (size_t k = 0; k < model.lines.size(); ++k)
    surface.lines.col(static_cast<Eigen::Index>(k)) << model.lines[k].a, model.lines[k].b;
  if (!model.lines.empty()) add_line_arrays(fields, surface.line_arrays);
  surface.texts.push_back({"units", {"mm"}});
  return surface;
}

VtpSurface coaptation_line(const Model& model, const Closure& closure) {
  Polylines lines(model, {"piece", "leaflet_1", "leaflet_2", "coaptation_height_mm"});
  const auto region = [&](int t) {
    return model.mesh.regions.empty() ? 0 : model.mesh.regions[static_cast<size_t>(t)];
  };
  for (size_t piece = 0; piece < closure.line.size(); ++piece) {
    const Seam& seam = closure.line[piece];
    lines.add(seam.points, false);
    for (size_t k = 0; k < seam.triangles.size(); ++k) {
      const auto [one, other] = std::minmax({region(seam.triangles[k][0]), region(seam.triangles[k][1])});
      const double height = closure.local_height[piece][k];
      lines.add_values({static_cast<double>(piece), static_cast<double>(one), static_cast<double>(other),
                        std::isfinite(height) ? height : -1});
    }
  }
  return lines.surface({true, true, true, false});
}

VtpSurface orifice_outlines(const Model& model, const Closure& closure) {
  Polylines lines(model, {"outline", "area_mm2", "regurgitant_area_mm2", "perimeter_mm"});
  for (size_t n = 0; n < closure.orifices.size(); ++n) {
    const Outline& outline = closure.orifices[n].outline;
    lines.add(outline.corners, true);
    for (Eigen::Index k = 0; k < outline.corners.cols(); ++k)
      lines.add_values({static_cast<double>(n), outline.area, closure.orifices[n].regurgitant_area_mm2,
                        outline.perimeter});
  }
  return lines.surface({true, false, false, false});
}

}  // namespace coapt
