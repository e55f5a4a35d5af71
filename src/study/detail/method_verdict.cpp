#include "study/detail/method_verdict.hpp"

#include "core/number_text.hpp"
#include "report/report_page.hpp"

namespace coapt {
namespace {

const Result& result_of(const ComparedMethod& method) { return method.run->report.result; }

bool has_converged(const ComparedMethod& method) { return result_of(method).status == Status::Converged; }

// Positions in the coordinates of the input, of all that is compared.
Points compared_points(const Model& model, const Points& x) {
  const Eigen::Index count = model.mesh.triangle_count() > 0 ? model.mesh.vertex_count() : x.cols();
  return x.leftCols(count).colwise() + model.origin;
}

// Of what is compared, the nodes that the certificate of one of the two finds to move at no cost.
std::vector<int> left_out_nodes(const ComparedMethod& reference, const ComparedMethod& method) {
  return either_of(result_of(reference).certificate.free_nodes, result_of(method).certificate.free_nodes,
                   compared_points(method.run->model, method.run->report.fields.x).cols());
}

std::string energy_text(const Result& result) {
  return number_text(result.energy, 9) + " mJ (" +
         spaced(stability_name(result.certificate.stability.verdict)) + ")";
}

std::string not_converged_text(const ComparedMethod& method) {
  const Result& result = result_of(method);
  return spaced(status_name(result.status)) + " at residual " + number_text(result.residual);
}

double energy_above(const ComparedMethod& reference, const ComparedMethod& method) {
  const Result &there = result_of(reference), &here = result_of(method);
  Objective& objective = *reference.run->model.objective;
  if (!objective.has_circulatory_force()) return here.energy - there.energy;
  const Vector q = objective.unknowns(method.run->report.fields.x);
  objective.set_path_anchor(there.q);
  return objective.value(q) - objective.value(there.q);
}

std::string energies_text(const ComparedMethod& reference, const ComparedMethod& method) {
  std::string both = "energy " + energy_text(result_of(method)) + ", of " + reference.name + " " +
                     energy_text(result_of(reference));
  if (!reference.run->model.objective->has_circulatory_force()) return both;
  return both + ", each of a potential of its own; " + number_text(*method.energy_above) +
         " mJ above it on the straight way between them";
}

struct RefinedShape {
  Points x;  // of all that is compared
  double residual = 0, energy = 0;
  bool is_cancelled = false;
};

RefinedShape refined_shape(RunReport& run, const SolveSetup& setup) {
  const Result result = solve_again(run.report.fields.x, run.model, setup);
  return {compared_points(run.model, run.model.objective->positions(result.q)), result.residual,
          result.energy, result.status == Status::Cancelled};
}

// From an unstable state newton would go on to a stable one, which says nothing about where the method stood.
bool may_be_refined(const ComparedMethod& method) {
  return !is_unstable(result_of(method).certificate.stability.verdict);
}

// Nothing where it was cancelled on the way.
std::optional<RefinedPair> refined_pair(ComparedMethod& reference, ComparedMethod& method,
                                        const SolveSetup& setup) {
  const RefinedShape there = refined_shape(*reference.run, setup), here = refined_shape(*method.run, setup);
  if (there.is_cancelled || here.is_cancelled) return std::nullopt;
  return RefinedPair{setup.stop.tolerance, here.residual,
                     there.residual,       here.energy,
                     there.energy,         apart(here.x, there.x, left_out_nodes(reference, method)).max};
}

void say(ComparedMethod& method, Verdict verdict, const std::string& what) {
  method.verdict = verdict;
  method.message = std::string(verdict_name(verdict)) + ": " + what;
  if (method.gap && method.gap->left_out > 0)
    method.message += "; nodes that move at no cost, left out: " + std::to_string(method.gap->left_out);
}

void judge_equilibria(ComparedMethod& reference, ComparedMethod& method, double same_mm,
                      const std::optional<SolveSetup>& refining) {
  const double largest = method.gap->same_vertex.max;
  const std::string distance = "at most " + number_text(largest) + " mm apart";
  if (largest <= same_mm) return say(method, Verdict::SameEquilibrium, distance);
  if (refining && may_be_refined(reference) && may_be_refined(method)) {
    method.refined = refined_pair(reference, method, *refining);
    if (!method.refined)
      return say(method, Verdict::NotConverged,
                 distance + "; cancelled before it was clear whether these are two equilibria");
  }
  const std::string after = method.refined ? ", " + number_text(method.refined->largest_mm) +
                                                 " mm after going on to residuals " +
                                                 number_text(method.refined->residual) + " and " +
                                                 number_text(method.refined->reference_residual)
                                           : "";
  if (method.refined && method.refined->largest_mm <= same_mm)
    return say(method, Verdict::SameEquilibrium, "as solved " + distance + after);
  method.energy_above = energy_above(reference, method);
  say(method, Verdict::AnotherBranch,
      "up to " + number_text(largest) + " mm apart" + after + "; " + energies_text(reference, method));
}

std::string gap_text(const MethodGap& gap) {
  if (!gap.surfaces)
    return "mean " + number_text(gap.same_vertex.mean) + ", max " + number_text(gap.same_vertex.max) + " mm";
  const DistanceFigures distance = both_directions(*gap.surfaces);
  return "mean " + number_text(distance.mean) + ", 95 % " + number_text(distance.p95) + ", max " +
         number_text(distance.max) + " mm";
}

}  // namespace

void measure_gap(const ComparedMethod& reference, ComparedMethod& method) {
  const Model &there = reference.run->model, &here = method.run->model;
  Fields& fields = method.run->report.fields;
  MethodGap gap;
  const std::vector<int> left_out = left_out_nodes(reference, method);
  gap.left_out = static_cast<int>(left_out.size());
  gap.same_vertex = apart(compared_points(here, fields.x),
                          compared_points(there, reference.run->report.fields.x), left_out);
  if (here.mesh.triangle_count() > 0) {
    TriangleMesh closed = surface_at(there, reference.run->report.fields.x);
    closed.vertices.colwise() += there.origin - here.origin;
    gap.surfaces =
        reference_distance(surface_at(here, fields.x), closed, fields.method_distance, {left_out, left_out});
  }
  method.gap = gap;
}

void judge_method(ComparedMethod& reference, ComparedMethod& method, double same_mm,
                  const std::optional<SolveSetup>& refining) {
  if (!method.run) return;
  const bool is_reference = &method == &reference;
  if (is_reference)
    return say(method, Verdict::Reference, has_converged(method) ? "converged" : not_converged_text(method));
  if (!reference.run) return say(method, Verdict::NoReference, reference.name + " failed");
  if (method.model != reference.model)
    return say(method, Verdict::ModelGap,
               gap_text(*method.gap) + (has_converged(method) ? "" : "; " + not_converged_text(method)));
  if (!has_converged(method)) return say(method, Verdict::NotConverged, not_converged_text(method));
  if (!has_converged(reference))
    return say(method, Verdict::NotConverged,
               "the reference " + reference.name + ", " + not_converged_text(reference));
  judge_equilibria(reference, method, same_mm, refining);
}

}  // namespace coapt
