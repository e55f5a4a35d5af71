#include "scene/metrics.hpp"

#include "core/error.hpp"
#include "mesh/intersections.hpp"
#include "mesh/projected_area.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace coapt {
namespace {

// The annulus in the closed state, and which way is up.
struct AnnulusFrame {
  Points loop;  // 3 x count
  Vec3 centre;
  Vec3 up;      // normal of the annulus plane, towards the atrium
  Vec3 e1, e2;  // in the plane
};

AnnulusFrame annulus_frame(const Model& model, const Fields& fields, const std::vector<int>& annulus) {
  AnnulusFrame frame;
  frame.loop = fields.x(Eigen::all, annulus);
  const Plane plane = best_fit_plane(frame.loop);
  frame.centre = plane.centre;
  frame.up = plane.normal;
  // The open leaflets hang into the ventricle.
  const Vec3 open_centre = model.X(Eigen::all, annulus).rowwise().mean();
  const Vec3 hang = model.X.leftCols(model.mesh.vertex_count()).rowwise().mean() - open_centre;
  if (hang.dot(frame.up) > 0) frame.up = -frame.up;
  frame.e1 = frame.up.unitOrthogonal();
  frame.e2 = frame.up.cross(frame.e1);
  return frame;
}

using Cell = std::pair<long, long>;

Cell cell_of(const AnnulusFrame& frame, const Vec3& p, double width) {
  const Vec3 from_centre = p - frame.centre;
  return {std::lround(from_centre.dot(frame.e1) / width), std::lround(from_centre.dot(frame.e2) / width)};
}

double height_of(const AnnulusFrame& frame, const Vec3& p) { return (p - frame.centre).dot(frame.up); }

// Extent of contact along the annulus normal in columns two mean edges wide: the 90th percentile, since a
// single column may hold a fold.
double coaptation_height(const AnnulusFrame& frame, const Model& model, const Fields& fields) {
  const double width = 2 * mean_edge_length(fields.x, model.mesh.triangles);
  std::map<Cell, std::pair<double, double>> columns;
  for (size_t v = 0; v < fields.is_contact.size(); ++v) {
    if (!fields.is_contact[v]) continue;
    const Vec3 p = fields.x.col(static_cast<Eigen::Index>(v));
    const double height = height_of(frame, p);
    const auto [it, is_new] = columns.try_emplace(cell_of(frame, p, width), height, height);
    it->second.first = std::min(it->second.first, height);
    it->second.second = std::max(it->second.second, height);
  }
  if (columns.empty()) return 0;
  std::vector<double> extents;
  for (const auto& [cell, range] : columns) extents.push_back(range.second - range.first);
  const auto ninth = extents.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(extents.size()));
  std::nth_element(extents.begin(), ninth, extents.end());
  return *ninth;
}

// Depth below the annulus plane of the lowest place that is seen from above. The surface is sampled into
// columns and each keeps its highest point, so that the slit between coapting leaflets, which is narrower
// than a column, does not count.
double tenting_height(const AnnulusFrame& frame, const Model& model, const Fields& fields) {
  const double diameter = bounding_box_diagonal(frame.loop);
  const double width = std::max(2 * fields.contact_distance, diameter / 50);
  std::map<Cell, double> top;
  const Triangles& triangles = model.mesh.triangles;
  for (int t = 0; t < triangles.cols(); ++t) {
    const Vec3 a = fields.x.col(triangles(0, t)), b = fields.x.col(triangles(1, t)),
               c = fields.x.col(triangles(2, t));
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const int parts = std::clamp(static_cast<int>(std::ceil(2 * longest / width)), 1, 100);
    for (int i = 0; i <= parts; ++i)
      for (int j = 0; i + j <= parts; ++j) {
        const Vec3 p = a + (b - a) * i / parts + (c - a) * j / parts;
        const double height = height_of(frame, p);
        const auto [it, is_new] = top.try_emplace(cell_of(frame, p, width), height);
        it->second = std::max(it->second, height);
      }
  }
  double depth = 0;
  for (const auto& [cell, height] : top) depth = std::max(depth, -height);
  return depth;
}

double contact_area(const Model& model, const Fields& fields) {
  const Vector areas = nodal_areas(fields.x, model.mesh.triangles);
  double area = 0;
  for (size_t v = 0; v < fields.is_contact.size(); ++v)
    if (fields.is_contact[v]) area += areas[static_cast<Eigen::Index>(v)];
  return area;
}

void measure_annulus(const Model& model, const Fields& fields, const std::vector<int>& annulus,
                     Metrics& metrics) {
  const AnnulusFrame frame = annulus_frame(model, fields, annulus);
  const Points surface = fields.x.leftCols(model.mesh.vertex_count());
  const UncoveredArea area = uncovered_area(surface, model.mesh.triangles, frame.loop, frame.up);
  metrics.orifice_area_mm2 = area.area;
  metrics.annulus_area_mm2 = area.polygon_area;
  if (area.polygon_area > 0) metrics.orifice_area_percent = 100 * area.area / area.polygon_area;
  metrics.coaptation_height_mm = coaptation_height(frame, model, fields);
  metrics.tenting_height_mm = tenting_height(frame, model, fields);
}

void measure_regimes(const Model& model, const Fields& fields, Metrics& metrics) {
  if (fields.regime.empty()) return;
  const auto area_in = [&](MembraneRegime regime) {
    double area = 0;
    for (int t = 0; t < model.mesh.triangle_count(); ++t)
      if (fields.regime[static_cast<size_t>(t)] == regime)
        area += area_vector(model.X, model.mesh.triangles.col(t)).norm();
    return area;
  };
  metrics.taut_area_mm2 = area_in(MembraneRegime::Taut);
  metrics.wrinkled_area_mm2 = area_in(MembraneRegime::Wrinkled);
  metrics.slack_area_mm2 = area_in(MembraneRegime::Slack);
}

void measure_lines(const Fields& fields, Metrics& metrics) {
  if (fields.line_force.size() == 0) return;
  metrics.max_chord_force_n = fields.line_force.maxCoeff();
  metrics.slack_chords = (fields.line_force.array() <= 0).count();
}

}  // namespace

Metrics measure(const Model& model, const Vector& q, const Fields& fields) {
  Metrics metrics;
  const Triangles& triangles = model.mesh.triangles;
  metrics.leaflet_area_open_mm2 = surface_area(model.X, triangles);
  metrics.leaflet_area_closed_mm2 = surface_area(fields.x, triangles);
  metrics.max_displacement_mm =
      fields.displacement.cols() == 0 ? 0 : fields.displacement.colwise().norm().maxCoeff();
  if (triangles.cols() > 0) {
    const Points surface = fields.x.leftCols(model.mesh.vertex_count());
    metrics.intersections = static_cast<long>(intersecting_pairs(surface, triangles).size());
    metrics.max_principal_strain = fields.principal_strain.row(0).maxCoeff();
  }
  measure_lines(fields, metrics);
  measure_regimes(model, fields, metrics);

  const auto annulus = model.sets.find("annulus");
  const bool has_annulus = annulus != model.sets.end() && annulus->second.size() >= 3;
  if (has_annulus) try {
      measure_annulus(model, fields, annulus->second, metrics);
    } catch (const InputError&) {  // an annulus on one line encloses nothing: its metrics stay undefined
    }
  if (has_annulus || model.contact_range > 0) {
    metrics.contact_vertices = std::count(fields.is_contact.begin(), fields.is_contact.end(), 1);
    metrics.coaptation_area_mm2 = contact_area(model, fields) / 2;
  }
  const double gap = fields.gap.size() == 0 ? kNaN : fields.gap.minCoeff<Eigen::PropagateNumbers>();
  if (std::isfinite(gap)) metrics.smallest_gap_mm = gap;

  const Balance balance = model.objective->balance(q);
  metrics.force_balance = balance.force;
  metrics.moment_balance = balance.moment;
  return metrics;
}

std::vector<MetricRow> metric_rows(const Metrics& m) {
  const auto count = [](std::optional<long> value) {
    return value ? std::optional<double>(static_cast<double>(*value)) : std::nullopt;
  };
  return {
      {"intersections", "", "pairs of facets without a common vertex that touch or pass through each other",
       true, count(m.intersections)},
      {"orifice_area_mm2", "mm2", "area of the annulus opening, seen along its normal, left uncovered", false,
       m.orifice_area_mm2},
      {"annulus_area_mm2", "mm2", "area of the annulus opening, seen along its normal", false,
       m.annulus_area_mm2},
      {"orifice_area_percent", "%", "orifice area over annulus area", false, m.orifice_area_percent},
      {"coaptation_area_mm2", "mm2", "half the area of the leaflets that is in contact", false,
       m.coaptation_area_mm2},
      {"coaptation_height_mm", "mm",
       "extent of contact along the annulus normal: 90th percentile over the coaptation line", false,
       m.coaptation_height_mm},
      {"tenting_height_mm", "mm",
       "greatest depth of the leaflets, seen from the atrium, below the annulus plane", false,
       m.tenting_height_mm},
      {"leaflet_area_open_mm2", "mm2", "area of the reference mesh", false, m.leaflet_area_open_mm2},
      {"leaflet_area_closed_mm2", "mm2", "area of the closed mesh", false, m.leaflet_area_closed_mm2},
      {"taut_area_mm2", "mm2", "reference area of the membrane in tension both ways", false, m.taut_area_mm2},
      {"wrinkled_area_mm2", "mm2", "reference area of the membrane in tension one way", false,
       m.wrinkled_area_mm2},
      {"slack_area_mm2", "mm2", "reference area of the membrane without tension", false, m.slack_area_mm2},
      {"max_principal_strain", "", "greatest principal engineering strain, stretch - 1", false,
       m.max_principal_strain},
      {"max_chord_force_n", "N", "greatest tension of a chord or cable", false, m.max_chord_force_n},
      {"force_balance", "", "resultant of loads and reactions over the sum of their magnitudes", false,
       m.force_balance},
      {"moment_balance", "", "the same for moments about the centre of the nodes", false, m.moment_balance},
      {"contact_vertices", "", "vertices in contact", true, static_cast<double>(m.contact_vertices)},
      {"smallest_gap_mm", "mm", "smallest distance of a vertex from a facet beyond its neighbourhood", false,
       m.smallest_gap_mm},
      {"slack_chords", "", "chords and cables without tension", true, count(m.slack_chords)},
      {"max_displacement_mm", "mm", "greatest displacement of a node", false, m.max_displacement_mm},
  };
}

}  // namespace coapt
