// S16: evaluations that fail. Where the failure lies beyond the solution it must not matter; where it lies
// before it, the run ends with its last finite state and says why.
#include "stress/scenes/faulty_term.hpp"
#include "stress/subject.hpp"

#include <algorithm>
#include <optional>

namespace coapt {
namespace {

constexpr double kBarredSeconds = 2;  // for a run that creeps up to where it cannot go on

// The greatest distance of a node that no support carries along [mm].
double distance_moved(const StressRun& solved, const Points& x, const Points& rest) {
  const FixedMask& fixed = solved.model.objective->fixed();
  double farthest = 0;
  for (Eigen::Index node = 0; node < x.cols(); ++node)
    if (!fixed.col(node).all()) farthest = std::max(farthest, (x.col(node) - rest.col(node)).norm());
  return farthest;
}

StressOutcome with_fault(StressSubject& subject, Fault fault, double part, const std::string& solver) {
  if (auto outcome = no_yardstick(subject)) return *outcome;
  const Points& rest = own_scene(subject).geometry.model.X;
  const StressRun& own = own_solution(subject);
  const double farthest = (own.x - rest).colwise().norm().maxCoeff();
  if (distance_moved(own, own.x, rest) == 0)
    return {
        StressVerdict::NotApplicable, {}, {}, "nothing moves in the solution but what supports carry along"};
  const std::optional<double> seconds = part < 1 ? std::optional(kBarredSeconds) : std::nullopt;
  const StressRun solved = subject.bench.solve(
      own_scene(subject), {.solver = solver, .seconds = seconds, .edit = [&](Model& model) {
                             make_faulty(model, fault, part * farthest);
                           }});
  if (part > 1) return same_shape_as_own(subject, solved, solved.x);
  const double tolerance = tolerance_of(own_scene(subject));
  if (auto wrong = untruth(solved, tolerance)) return *wrong;
  // The path there is barred: a state beyond, or one that is called converged and is none, would be a lie.
  StressOutcome outcome =
      measured(solved, distance_moved(solved, solved.x, rest) / farthest, part, "ended where the term fails");
  if (solved.result.status == Status::Converged &&
      fresh_residual(own_scene(subject), solved.x) > kResidualSlack * tolerance)
    outcome = outcome_of(solved, StressVerdict::Fail, "called converged where it cannot be");
  return outcome;
}

}  // namespace

std::vector<StressRow> failure_rows(const SubjectPointer& subject) {
  std::vector<StressRow> rows;
  for (const Fault fault : {Fault::NaN, Fault::Infinity, Fault::NaNGradient, Fault::Throws})
    for (const double part : {0.5, 1.1})
      for (const std::string solver : {"newton", "lbfgs"}) {
        if (!subject->bench.has_solver(solver) || (part > 1 && solver == "lbfgs")) continue;
        rows.push_back(
            {"S16", subject->name,
             fault_name(fault) + (part < 1 ? ", before the solution, " : ", beyond the solution, ") + solver,
             part < 1 ? "distance moved, over that to the own solution" : kDistanceFromOwn, "",
             fault == Fault::NaN || fault == Fault::Throws,
             [subject, fault, part, solver] { return with_fault(*subject, fault, part, solver); }});
      }
  return rows;
}

}  // namespace coapt
