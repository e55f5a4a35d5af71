#include "results/metrics.hpp"

#include "core/error.hpp"
#include "results/detail/contact_limit.hpp"
#include "results/orifice_area.hpp"
#include "scene/build/contact_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <utility>

namespace coapt {
namespace {

void measure_annulus(const Model& model, const Fields& fields, const ContactMeasure& contact,
                     const ViewDetail& detail, Metrics& metrics) {
  const std::optional<OrificeArea> area = orifice_area(model, fields.x, detail.refinement);
  if (!area) return;  // an annulus on one line encloses nothing: its metrics stay undefined
  metrics.orifice_area_mm2 = area->open;
  metrics.annulus_area_mm2 = area->annulus;
  metrics.orifice_area_percent = 100 * area->open / area->annulus;
  Closure closure = closure_of(model, fields, contact, detail);
  metrics.regurgitant_area_mm2 = std::min(closure.regurgitant_area_mm2, area->open);
  metrics.orifice_film_area_mm2 = closure.orifice_film_area_mm2;
  metrics.coaptation_length_mm = closure.coaptation_length_mm;
  metrics.coaptation_height_mm = closure.coaptation_height_mm;
  metrics.tenting_height_mm = closure.tenting_height_mm;
  metrics.tenting_volume_mm3 = closure.tenting_volume_mm3;
  metrics.prolapse_height_mm = closure.prolapse_height_mm;
  if (closure.anterior_share)
    metrics.healthy_closure = healthy_criteria({*closure.anterior_share, closure.coaptation_height_mm,
                                                *metrics.regurgitant_area_mm2, model.applied_pressure,
                                                metrics.p99_principal_strain});
  metrics.closure = std::move(closure);
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

void measure_stress(const Fields& fields, Metrics& metrics) {
  if (fields.cauchy_stress.cols() > 0) {
    metrics.max_cauchy_stress_kpa = kKilopascals * fields.cauchy_stress.row(0).maxCoeff();
    metrics.max_von_mises_stress_kpa = kKilopascals * fields.von_mises_stress.maxCoeff();
  }
  for (const double stress : fields.line_stress)
    if (!std::isnan(stress))
      metrics.max_chord_stress_kpa =
          std::max(metrics.max_chord_stress_kpa.value_or(kKilopascals * stress), kKilopascals * stress);
}

void measure_line_strains(const Model& model, const Fields& fields, Metrics& metrics) {
  double sum = 0;
  int stretched = 0;
  for (const Line& line : model.lines) {
    const std::optional<double> strain = line_strain(line, fields.x);
    if (!strain) continue;
    metrics.max_chord_strain = std::max(metrics.max_chord_strain.value_or(*strain), *strain);
    if (*strain <= 0) continue;
    sum += *strain;
    ++stretched;
  }
  if (stretched > 0) metrics.mean_chord_strain = sum / stretched;
}

void measure_lines(const Model& model, const Fields& fields, Metrics& metrics) {
  if (fields.line_force.size() == 0) return;
  metrics.max_chord_force_n = fields.line_force.maxCoeff();
  metrics.slack_chords = (fields.line_force.array() <= 0).count();
  measure_line_strains(model, fields, metrics);
}

void measure_yield(const Vector& ratios, std::optional<double>& greatest, std::optional<long>& beyond) {
  if (ratios.size() == 0) return;
  greatest = ratios.maxCoeff<Eigen::PropagateNumbers>();
  beyond = (ratios.array() > 1).count();
}

// What `share` of the area does not exceed, each facet counting with its own.
double area_percentile(const Vector& values, const Vector& areas, double share) {
  std::vector<int> order(static_cast<size_t>(values.size()));
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return values[a] < values[b]; });
  const double wanted = share * areas.sum();
  double below = 0;
  for (const int facet : order)
    if ((below += areas[facet]) >= wanted) return values[facet];
  return values[order.back()];
}

void measure_strains(const Model& model, const Fields& fields, Metrics& metrics) {
  const Vector strains = fields.principal_strain.row(0);
  metrics.max_principal_strain = strains.maxCoeff();
  if (!strains.allFinite()) return;
  Vector areas(strains.size());
  for (int t = 0; t < areas.size(); ++t)
    areas[t] = 0.5 * area_vector(model.X, model.mesh.triangles.col(t)).norm();
  metrics.p95_principal_strain = area_percentile(strains, areas, 0.95);
  metrics.p99_principal_strain = area_percentile(strains, areas, 0.99);
}

std::optional<double> counted(std::optional<long> value) {
  return value ? std::optional<double>(static_cast<double>(*value)) : std::nullopt;
}

// Strain, stress and force of membrane and lines.
std::vector<MetricRow> strength_rows(const Metrics& m) {
  return {
      {"max_principal_strain", "", "greatest principal engineering strain, stretch - 1", false,
       m.max_principal_strain},
      {"p95_principal_strain", "", "the same, not exceeded on 95 % of the area", false,
       m.p95_principal_strain},
      {"p99_principal_strain", "", "the same, not exceeded on 99 % of the area", false,
       m.p99_principal_strain},
      {"max_cauchy_stress_kpa", "kPa", "greatest principal Cauchy stress of the membrane", false,
       m.max_cauchy_stress_kpa},
      {"max_von_mises_stress_kpa", "kPa", "greatest von Mises stress in the plane of the membrane", false,
       m.max_von_mises_stress_kpa},
      {"max_chord_force_n", "N", "greatest tension of a chord or cable", false, m.max_chord_force_n},
      {"max_chord_stress_kpa", "kPa", "greatest Cauchy stress of a chord or cable of known cross-section",
       false, m.max_chord_stress_kpa},
      {"max_chord_strain", "", "greatest strain of a chord or cable, length over rest length - 1", false,
       m.max_chord_strain},
      {"mean_chord_strain", "", "mean strain of the chords and cables longer than at rest", false,
       m.mean_chord_strain},
      {"max_yield_ratio", "", "greatest elongation of a leaflet's fibres over that at which they yield",
       false, m.max_yield_ratio},
      {"max_chord_yield_ratio", "", "greatest strain of a chord over that at which its fibres yield", false,
       m.max_chord_yield_ratio},
      {"yielded_facets", "", "facets whose fibres are beyond their yield", true, counted(m.yielded_facets)},
      {"yielded_chords", "", "chords whose fibres are beyond their yield", true, counted(m.yielded_chords)},
  };
}

}  // namespace

Metrics measure(const Model& model, const Vector& q, const Fields& fields, const IntersectionChecker& checker,
                const ViewDetail& detail) {
  Metrics metrics;
  metrics.intersection_checker = checker.name;
  const Triangles& triangles = model.mesh.triangles;
  metrics.leaflet_area_open_mm2 = surface_area(model.X, triangles);
  metrics.leaflet_area_closed_mm2 = surface_area(fields.x, triangles);
  metrics.leaflet_area_change_mm2 = metrics.leaflet_area_closed_mm2 - metrics.leaflet_area_open_mm2;
  metrics.max_displacement_mm =
      fields.displacement.cols() == 0 ? 0 : fields.displacement.colwise().norm().maxCoeff();
  const bool is_finite = fields.x.allFinite();
  if (triangles.cols() > 0 && is_finite)
    metrics.intersections = std::ssize(membrane_intersections(fields.x, model, checker));
  if (triangles.cols() > 0) measure_strains(model, fields, metrics);
  measure_lines(model, fields, metrics);
  measure_stress(fields, metrics);
  measure_regimes(model, fields, metrics);
  measure_yield(fields.yield_ratio, metrics.max_yield_ratio, metrics.yielded_facets);
  measure_yield(fields.line_yield_ratio, metrics.max_chord_yield_ratio, metrics.yielded_chords);

  if (looks_for_contact(model)) {
    const ContactMeasure contact = measure_contact(model, fields);
    if (is_finite) try {
        measure_annulus(model, fields, contact, detail, metrics);
      } catch (const InputError&) {  // of what cannot be measured of it, nothing is said
      }
    metrics.contact_vertices = std::count(fields.is_contact.begin(), fields.is_contact.end(), 1);
    metrics.contact_facets = std::count(fields.is_contact_facet.begin(), fields.is_contact_facet.end(), 1);
    metrics.near_coaptation_area_mm2 = contact.near.sum() / 2;
    metrics.coaptation_area_mm2 = resolved_area(metrics.near_coaptation_area_mm2, contact.areas.sum() / 2);
  }
  const double gap = fields.gap.size() == 0 ? kNaN : fields.gap.minCoeff<Eigen::PropagateNumbers>();
  if (std::isfinite(gap)) metrics.smallest_gap_mm = gap;

  const Balance balance = model.objective->balance(q);
  metrics.force_balance = balance.force;
  metrics.moment_balance = balance.moment;
  return metrics;
}

std::vector<MetricRow> metric_rows(const Metrics& m) {
  std::vector<MetricRow> rows = {
      {"intersections", "",
       "pairs of facets without a common vertex, one or both of the mesh, that touch or pass through each "
       "other",
       true, counted(m.intersections)},
      {"orifice_area_mm2", "mm2", "area of the annulus opening, seen along its normal, left uncovered", false,
       m.orifice_area_mm2},
      {"annulus_area_mm2", "mm2", "area of the annulus opening, seen along its normal", false,
       m.annulus_area_mm2},
      {"orifice_area_percent", "%", "orifice area over annulus area", false, m.orifice_area_percent},
      {"regurgitant_area_mm2", "mm2", "of the orifice, what is wider than the contact distance", false,
       m.regurgitant_area_mm2},
      {"orifice_film_area_mm2", "mm2",
       "area of the least surface that closes the regurgitant orifices from rim to rim", false,
       m.orifice_film_area_mm2},
      {"coaptation_area_mm2", "mm2", "half the area of the leaflets that is in contact", false,
       m.coaptation_area_mm2},
      {"coaptation_length_mm", "mm", "length of the coaptation line", false, m.coaptation_length_mm},
      {"coaptation_height_mm", "mm",
       "extent of contact below and across the coaptation line: 90th percentile along it", false,
       m.coaptation_height_mm},
      {"tenting_height_mm", "mm",
       "depth of the coaptation line below the annulus plane: 90th percentile along it", false,
       m.tenting_height_mm},
      {"tenting_volume_mm3", "mm3",
       "between the leaflets, seen from the atrium, and the annulus surface above", false,
       m.tenting_volume_mm3},
      {"prolapse_height_mm", "mm",
       "greatest height of the leaflets above every straight line across the annulus", false,
       m.prolapse_height_mm},
      {"leaflet_area_open_mm2", "mm2", "area of the reference mesh", false, m.leaflet_area_open_mm2},
      {"leaflet_area_closed_mm2", "mm2", "area of the closed mesh", false, m.leaflet_area_closed_mm2},
      {"leaflet_area_change_mm2", "mm2", "area of the closed mesh less that of the reference mesh", false,
       m.leaflet_area_change_mm2},
      {"taut_area_mm2", "mm2", "reference area of the membrane in tension both ways", false, m.taut_area_mm2},
      {"wrinkled_area_mm2", "mm2", "reference area of the membrane in tension one way", false,
       m.wrinkled_area_mm2},
      {"slack_area_mm2", "mm2", "reference area of the membrane without tension", false, m.slack_area_mm2},
  };
  const std::vector<MetricRow> strength = strength_rows(m);
  const std::vector<MetricRow> rest = {
      {"force_balance", "", "resultant of loads and reactions over the sum of their magnitudes", false,
       m.force_balance},
      {"moment_balance", "", "the same for moments about the centre of the nodes", false, m.moment_balance},
      {"contact_vertices", "", "vertices in contact", true, static_cast<double>(m.contact_vertices)},
      {"contact_facets", "", "facets with all three vertices in contact", true,
       static_cast<double>(m.contact_facets)},
      {"smallest_gap_mm", "mm", "smallest distance of a vertex from a facet beyond its neighbourhood", false,
       m.smallest_gap_mm},
      {"slack_chords", "", "chords and cables without tension", true, counted(m.slack_chords)},
      {"max_displacement_mm", "mm", "greatest displacement of a node", false, m.max_displacement_mm},
  };
  rows.insert(rows.end(), strength.begin(), strength.end());
  rows.insert(rows.end(), rest.begin(), rest.end());
  return rows;
}

std::vector<MetricRow> leaflet_rows(const LeafletMetrics& l) {
  return {
      {"area_open_mm2", "mm2", "area in the reference mesh", false, l.area_open_mm2},
      {"area_closed_mm2", "mm2", "area in the closed mesh", false, l.area_closed_mm2},
      {"contact_area_mm2", "mm2", "of the closed area, what is in contact", false, l.contact_area_mm2},
      {"contact_vertices", "", "vertices in contact", true, static_cast<double>(l.contact_vertices)},
      {"contact_facets", "", "facets with all three vertices in contact", true,
       static_cast<double>(l.contact_facets)},
      {"coaptation_length_mm", "mm", "length of the coaptation line along it", false, l.coaptation_length_mm},
      {"coaptation_height_mm", "mm",
       "extent of its contact below and across the coaptation line: 90th percentile along it", false,
       l.coaptation_height_mm},
      {"tenting_height_mm", "mm",
       "depth of its coaptation line below the annulus plane: 90th percentile along it", false,
       l.tenting_height_mm},
      {"tenting_volume_mm3", "mm3", "between it, as seen from the atrium, and the annulus surface above",
       false, l.tenting_volume_mm3},
      {"prolapse_height_mm", "mm", "its greatest height above every straight line across the annulus", false,
       l.prolapse_height_mm},
  };
}

}  // namespace coapt
