// S18, S19 and H3: the same run twice, on several threads, and by another method.
#include "scene/stress/subject.hpp"

namespace coapt {
namespace {

StressOutcome same_bits(StressSubject& subject, int threads) {
  StressScene again = copy_of(own_scene(subject));
  if (threads > 0) again.scene.solver.threads = threads;
  const Stressed& own = own_solution(subject);
  const Stressed solved = subject.bench.solve(again);
  if (auto wrong = untruth(solved, tolerance_of(own_scene(subject)))) return *wrong;
  // What is stopped by the clock is not stopped at the same state.
  if (own.result.status == Status::TimeLimit || solved.result.status == Status::TimeLimit)
    return outcome_of(solved, StressVerdict::Stall, solved.result.message);
  double different = (solved.x.array() != own.x.array()).cast<double>().sum();
  if (solved.result.energy != own.result.energy) ++different;
  if (solved.result.residual != own.result.residual) ++different;
  if (solved.result.iterations != own.result.iterations) ++different;
  return measured(solved, different, 0, "the two runs differ");
}

StressRow repeated(const SubjectPointer& subject, const char* id, const std::string& name, int threads) {
  return {id, subject->name, name, "numbers that differ", "", true, [subject, threads] {
            return same_bits(*subject, threads);
          }};
}

}  // namespace

std::vector<StressRow> repetition_rows(const SubjectPointer& subject) {
  std::vector<StressRow> rows = {repeated(subject, "S18", "the same run again", 0),
                                 repeated(subject, "S19", "four threads", 4)};
  for (const std::string solver : {"newton", "lbfgs"}) {
    if (!subject->bench.has_solver(solver)) continue;
    rows.push_back({"H3", subject->name, "by " + solver, kDistanceFromOwn, "", true,
                    [subject, solver]() -> StressOutcome {
                      if (own_scene(*subject).scene.solver.type == solver)
                        return {StressVerdict::NotApplicable, {}, {}, "it is the scene's own solver"};
                      const Stressed solved = subject->bench.solve(own_scene(*subject), {.solver = solver});
                      return same_shape_as_own(*subject, solved, solved.x);
                    }});
  }
  return rows;
}

}  // namespace coapt
