#include "results/result_warnings.hpp"

#include "core/number_text.hpp"
#include "mesh/mesh_topology.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr const char* kStabilityDoubt = "its stability is in doubt (";
constexpr double kSevereOrifice = 40;      // effective, of severe regurgitation [mm2]
constexpr double kLeastCoaptation = 0.25;  // of the area within the contact distance, in contact itself
constexpr double kMostFacetStrain = 1, kMostLineStrain = 0.2;  // beyond which they are named

// "3 of 630 facets (12, 45, 300)": those above `most`; empty where none is.
std::string those_above(double most, const Eigen::Ref<const Vector>& values, const char* what) {
  constexpr long kNamed = 8;
  const long count = (values.array() > most).count();
  if (count == 0) return "";
  std::string names;
  long named = 0;
  for (Eigen::Index k = 0; k < values.size() && named < kNamed; ++k)
    if (values[k] > most) names += (named++ > 0 ? ", " : "") + std::to_string(k);
  return std::to_string(count) + " of " + std::to_string(values.size()) + " " + what + " (" + names +
         (count > kNamed ? ", ...)" : ")");
}

std::string percent(double share) { return number_text(100 * share, 3) + " %"; }

}  // namespace

std::string stretch_warning(const Fields& fields) {
  const Vector strain = fields.principal_strain.row(0).transpose();
  const std::string facets = those_above(kMostFacetStrain, strain, "facets"),
                    lines = those_above(kMostLineStrain, fields.line_strain, "chords and cables");
  if (facets.empty() && lines.empty()) return "";
  std::string text = "Overstretched: ";
  if (!facets.empty())
    text += facets + " by more than " + percent(kMostFacetStrain) + ", the most by " +
            percent(strain.maxCoeff<Eigen::PropagateNumbers>());
  if (!facets.empty() && !lines.empty()) text += "; ";
  if (!lines.empty())
    text += lines + " by more than " + percent(kMostLineStrain) + ", the most by " +
            percent(fields.line_strain.maxCoeff<Eigen::PropagateNumbers>());
  return text + ". Are rest lengths, supports, stiffness, loads and their units right?";
}

std::string yield_warning(const Fields& fields) {
  const std::string facets = those_above(1, fields.yield_ratio, "facets"),
                    chords = those_above(1, fields.line_yield_ratio, "chords");
  if (facets.empty() && chords.empty()) return "";
  return "Fibres beyond their yield: " + facets + (facets.empty() || chords.empty() ? "" : " and ") + chords +
         ", numbered as in closed.vtp (yield_ratio, line_yield_ratio).";
}

std::string coaptation_remark(const Metrics& metrics) {
  const double near = metrics.near_coaptation_area_mm2, area = metrics.coaptation_area_mm2.value_or(0);
  if (area >= kLeastCoaptation * near) return "";
  return (metrics.coaptation_area_mm2 ? "hardly" : "not") + std::string(" resolved by this mesh: ") +
         number_text(near, 3) + " mm2 within the contact distance, half of a mean edge";
}

std::vector<std::string> result_warnings(const Report& report) {
  std::vector<std::string> warnings = report.warnings;
  const Certificate& certificate = report.result.certificate;
  if (report.result.status == Status::Converged)
    if (const std::string doubt = stability_doubt(certificate); !doubt.empty())
      warnings.push_back("The stability of this equilibrium is in doubt: " + doubt + ".");
  if (report.branches && report.branches->equilibria.size() > 1)
    warnings.push_back("This shape is one of several equilibria: " + branches_message(*report.branches) +
                       ". Figures that differ between them are given with their range.");
  if (report.branches && report.branches->starts > 0 &&
      report.branches->not_converged == report.branches->starts)
    warnings.push_back("Nothing is known of other equilibria: " + branches_message(*report.branches) + ".");
  const UndeterminedNodes nodes = undetermined_nodes(certificate.free_nodes, report.branches);
  if (nodes.total() > 0)
    warnings.push_back("Nodes whose place is not determined: " + std::to_string(nodes.total()) + " (" +
                       std::to_string(nodes.free) + " can be moved at no cost" +
                       (report.branches && report.branches->converged() > 0
                            ? ", " + std::to_string(nodes.differing) + " others differ between the equilibria"
                            : "") +
                       ").");
  return warnings;
}

std::string standing_open(const Metrics& metrics) {
  const double area = metrics.regurgitant_area_mm2.value_or(0);
  const bool meets = metrics.coaptation_length_mm.value_or(0) > 0, is_severe = area >= kSevereOrifice;
  if (!(area > 0) || (meets && !is_severe)) return "";
  std::string text = "the valve stands open: " + number_text(area, 3) + " mm2 of regurgitant orifice";
  if (is_severe) text += ", as in severe regurgitation (" + number_text(kSevereOrifice) + " and more)";
  return meets ? text : text + "; its leaflets meet nowhere";
}

bool is_in_doubt(const Report& report) { return !stability_doubt(report.result.certificate).empty(); }

void withdraw_penetrated(Report& report) {
  const long pairs = report.metrics.intersections;
  if (!report.has_collisions || pairs == 0 || report.result.status != Status::Converged) return;
  report.result.status = Status::Stalled;
  report.result.message =
      "not converged: " + std::to_string(pairs) +
      (pairs == 1 ? " pair of facets passes" : " pairs of facets pass") +
      " through each other, which `solver.dynamics.collisions` were to keep apart; at rest " +
      "with a residual of " + number_text(report.result.residual, 3);
}

std::vector<std::string> surface_doubts(const TriangleMesh& mesh) {
  const std::vector<Edge> all = edges(mesh.triangles);
  const auto crowded =
      std::count_if(all.begin(), all.end(), [](const Edge& edge) { return edge.triangles.size() > 2; });
  const int flipped = consistent_orientation(mesh).flip_count;
  std::vector<std::string> doubts;
  if (crowded > 0)
    doubts.push_back(std::to_string(crowded) + (crowded == 1 ? " edge has" : " edges have") +
                     " more than two facets");
  if (flipped > 0)
    doubts.push_back((flipped == 1 ? "the normal of 1 facet points"
                                   : "the normals of " + std::to_string(flipped) + " facets point") +
                     " against the neighbours'");
  return doubts;
}

namespace {

// Beside its stability, which the message of the solve tells.
std::vector<std::string> further_doubts(const Report& report) {
  std::vector<std::string> list;
  if (const long pairs = report.metrics.intersections; pairs > 0)
    list.push_back(std::to_string(pairs) + (pairs == 1 ? " pair of facets passes" : " pairs of facets pass") +
                   " through each other");
  if (const std::string reason = standing_open(report.metrics); !reason.empty()) list.push_back(reason);
  if (const std::string reason = strain_doubt(report.metrics.healthy_closure); !reason.empty())
    list.push_back(reason);
  if (2 * report.metrics.slack_chords.value_or(0) > report.fields.line_strain.size())
    list.emplace_back("most chords are slack");
  list.insert(list.end(), report.surface_doubts.begin(), report.surface_doubts.end());
  if (report.branches && report.branches->equilibria.size() > 1)
    list.emplace_back("one of several equilibria");
  else if ((!report.branches || !report.branches->answers_suspicion()) && report.neighbours.is_suspected)
    list.emplace_back("there may be other equilibria near by");
  return list;
}

}  // namespace

std::vector<std::string> doubts(const Report& report) {
  if (report.result.status != Status::Converged) return {};
  std::vector<std::string> list = further_doubts(report);
  if (is_in_doubt(report))
    list.insert(list.begin(), kStabilityDoubt + stability_doubt(report.result.certificate) + ")");
  return list;
}

bool are_about_stability(const std::vector<std::string>& doubts) {
  return std::any_of(doubts.begin(), doubts.end(),
                     [](const std::string& doubt) { return doubt.starts_with(kStabilityDoubt); });
}

Headline headline(const Report& report) {
  Headline line{report.result.message};
  if (report.result.status != Status::Converged) return line;
  const std::vector<std::string> further = further_doubts(report);
  for (const std::string& doubt : further) line.text += "; " + doubt;
  line.is_in_doubt = is_in_doubt(report) || !further.empty();
  return line;
}

}  // namespace coapt
