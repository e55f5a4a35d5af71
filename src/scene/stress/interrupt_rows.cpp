// S17: runs that are stopped, by hand or by the clock, and taken up again.
#include "scene/stress/subject.hpp"

#include <algorithm>

namespace coapt {
namespace {

// Stopped after this part of the iterations that the scene takes, then solved on from there.
StressOutcome cancelled_and_resumed(StressSubject& subject, double part) {
  if (auto outcome = no_yardstick(subject)) return *outcome;
  const Stressed& own = own_solution(subject);
  const int most = std::max(1, static_cast<int>(part * own.result.iterations));
  int seen = 0;
  const Stressed stopped = subject.bench.solve(
      own_scene(subject), {.observer = [&](const Iteration&, const Vector&) { return ++seen < most; }});
  if (auto wrong = untruth(stopped, tolerance_of(own_scene(subject)))) return *wrong;
  if (stopped.result.status != Status::Cancelled && stopped.result.status != Status::Converged)
    return outcome_of(stopped, StressVerdict::Fail,
                      "was cancelled and says \"" + stopped.result.message + "\"");
  if (stopped.result.status == Status::Cancelled && seen > most)
    return outcome_of(stopped, StressVerdict::Fail,
                      "went on for " + std::to_string(seen - most) + " states after it was cancelled");
  // In the middle of a motion the supports are not yet where a run that goes on has them.
  const Iteration* last = stopped.result.trace.empty() ? nullptr : &stopped.result.trace.back();
  if (own.model.motion.positions && last != nullptr && !own.result.trace.empty() &&
      last->round < own.result.trace.back().round)
    return outcome_of(stopped, StressVerdict::Pass,
                      stopped.result.message + "; not taken up again, as the supports were on their way");
  const Stressed resumed = subject.bench.solve(own_scene(subject), {.start = &stopped.x});
  return same_shape_as_own(subject, resumed, resumed.x);
}

// A limit that is up before the run has begun, or in its midst.
StressOutcome out_of_time(StressSubject& subject, double part) {
  constexpr double kLate = 1;  // [s]
  const double seconds = std::max(1e-6, part * own_solution(subject).wall_s);
  const Stressed solved = subject.bench.solve(own_scene(subject), {.seconds = seconds});
  if (auto wrong = untruth(solved, tolerance_of(own_scene(subject)))) return *wrong;
  const Status status = solved.result.status;
  if (status != Status::TimeLimit && status != Status::Converged)
    return outcome_of(solved, StressVerdict::Stall, solved.result.message);
  return measured(solved, std::max(0.0, solved.wall_s - seconds), kLate, "took no heed of its time limit");
}

}  // namespace

std::vector<StressRow> interrupt_rows(const SubjectPointer& subject) {
  const auto cancelled = [&](const char* name, double part, bool is_quick) -> StressRow {
    return {"S17", subject->name, name, kDistanceFromOwn, "", is_quick, [subject, part] {
              return cancelled_and_resumed(*subject, part);
            }};
  };
  const auto timed = [&](const char* name, double part, bool is_quick) -> StressRow {
    return {"S17", subject->name, name, "time after the limit", "s", is_quick, [subject, part] {
              return out_of_time(*subject, part);
            }};
  };
  return {cancelled("cancelled at the start, taken up again", 0, true),
          cancelled("cancelled half-way, taken up again", 0.5, true),
          cancelled("cancelled near the end, taken up again", 0.9, false), timed("no time at all", 0, true),
          timed("half the time that it takes", 0.5, false)};
}

}  // namespace coapt
