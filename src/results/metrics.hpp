// The numbers that a user came for. Definitions, sources and conventions: docs/metrics.md.
#pragma once

#include "mesh/distance/intersections.hpp"
#include "results/closure.hpp"
#include "results/fields.hpp"
#include "results/healthy_closure.hpp"

#include <optional>
#include <string>
#include <vector>

namespace coapt {

// Empty where a quantity is not defined for the scene: no annulus, no chords, no contact.
struct Metrics {
  long intersections = 0;                       // pairs of facets, one or both of the mesh
  std::string intersection_checker;             // who counted them
  std::optional<double> orifice_area_mm2;       // of the annulus opening, left uncovered
  std::optional<double> annulus_area_mm2;       // projected on the annulus plane
  std::optional<double> orifice_area_percent;   // of the annulus area
  std::optional<double> regurgitant_area_mm2;   // of the orifice, wider than the contact distance
  std::optional<double> orifice_film_area_mm2;  // of the least surface that closes the same from rim to rim
  std::optional<double> coaptation_area_mm2;   // half the area of the leaflets that touch another; empty also
                                               // where the mesh does not resolve it
  double near_coaptation_area_mm2 = 0;         // half the area within the contact distance
  std::optional<double> coaptation_length_mm;  // of the coaptation line
  std::optional<double> coaptation_height_mm;  // extent of contact below that line, 90th percentile
  std::optional<double> tenting_height_mm;     // depth of the coaptation line below the annulus plane
  std::optional<double> tenting_volume_mm3;    // between the leaflets and the surface that the annulus spans
  std::optional<double> prolapse_height_mm;    // greatest height above every line across the annulus
  double leaflet_area_open_mm2 = 0;
  double leaflet_area_closed_mm2 = 0;
  double leaflet_area_change_mm2 = 0;  // of the closed mesh against the reference
  std::optional<double> taut_area_mm2, wrinkled_area_mm2, slack_area_mm2;  // of the reference mesh, by regime
  std::optional<double> max_principal_strain;                              // stretch - 1
  std::optional<double> p95_principal_strain, p99_principal_strain;  // not exceeded on that share of the area
  std::optional<double> max_cauchy_stress_kpa;                       // greatest principal value
  std::optional<double> max_von_mises_stress_kpa;                    // of the Cauchy stress, in the plane
  std::optional<double> max_chord_force_n;
  std::optional<double> max_chord_stress_kpa;  // Cauchy, of those with a known cross-section
  std::optional<double> max_chord_strain;      // length over rest length, less 1
  std::optional<double> mean_chord_strain;     // of the lines longer than at rest
  std::optional<double> max_yield_ratio;       // of the leaflets' fibres: elongation over that at yield
  std::optional<double> max_chord_yield_ratio;
  std::optional<long> yielded_facets, yielded_chords;  // of which it is above 1
  std::optional<double> force_balance;                 // |sum of loads and reactions| / sum of magnitudes
  std::optional<double> moment_balance;
  long contact_vertices = 0, contact_facets = 0;
  std::optional<double> smallest_gap_mm;
  std::optional<long> slack_chords;  // lines that carry no tension
  double max_displacement_mm = 0;
  std::optional<Closure>
      closure;  // lines, outlines and leaflets behind the figures; empty without an annulus
  std::vector<HealthyCriterion> healthy_closure;  // of a mitral valve; empty for any other scene
};

// Measures the state q. fields: those of the same state. checker: counts the intersections. detail: coarser
// for changes of figures, of which both sides are measured so. Pre: the set "annulus" of the model, where
// there is one, is an ordered loop of at least three vertices.
Metrics measure(const Model& model, const Vector& q, const Fields& fields,
                const IntersectionChecker& checker = {}, const ViewDetail& detail = {});

// The same as a table, for files and summaries: one row per metric, in the order of the struct.
struct MetricRow {
  std::string name, unit;
  std::string meaning;  // one sentence
  bool is_count = false;
  std::optional<double> value;
};
std::vector<MetricRow> metric_rows(const Metrics& metrics);

// The same for one leaflet, its name left out.
std::vector<MetricRow> leaflet_rows(const LeafletMetrics& leaflet);

}  // namespace coapt
