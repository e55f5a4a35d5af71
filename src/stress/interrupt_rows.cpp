// S17: runs that are stopped, by hand or by the clock, and taken up again.
#include "core/random_source.hpp"
#include "stress/subject.hpp"

#include <algorithm>

namespace coapt {
namespace {

// Stopped after this part of the iterations that the scene takes, then solved on from what was recorded of
// it, as by `coapt solve --resume`: also where the supports were still on their way.
StressOutcome cancelled_and_resumed(StressSubject& subject, double part) {
  if (auto outcome = no_yardstick(subject)) return *outcome;
  const StressRun& own = own_solution(subject);
  const int most = std::max(1, static_cast<int>(part * own.result.iterations));
  int seen = 0;
  RunRecorder first({}, kInfinity, {});
  const StressRun stopped = subject.bench.solve(
      own_scene(subject),
      {.observer = [&](const Iteration&, const Vector&) { return ++seen < most; }, .recorder = &first});
  if (auto wrong = untruth(stopped, tolerance_of(own_scene(subject)))) return *wrong;
  if (stopped.result.status != Status::Cancelled && stopped.result.status != Status::Converged)
    return outcome_of(stopped, StressVerdict::Fail,
                      "was cancelled and says \"" + stopped.result.message + "\"");
  if (stopped.result.status == Status::Cancelled && seen > most)
    return outcome_of(stopped, StressVerdict::Fail,
                      "went on for " + std::to_string(seen - most) + " states after it was cancelled");
  RunRecorder second(first.record(), kInfinity, {});
  const StressRun resumed = subject.bench.solve(own_scene(subject), {.recorder = &second});
  return same_shape_as_own(subject, resumed, resumed.x);
}

// A limit that is up before the run has begun, or in its midst.
StressOutcome out_of_time(StressSubject& subject, double part) {
  constexpr double kLate = 1;  // [s]
  const double seconds = std::max(1e-6, part * own_solution(subject).wall_s);
  const StressRun solved = subject.bench.solve(own_scene(subject), {.seconds = seconds});
  if (auto wrong = untruth(solved, tolerance_of(own_scene(subject)))) return *wrong;
  const Status status = solved.result.status;
  if (status != Status::TimeLimit && status != Status::Converged)
    return outcome_of(solved, StressVerdict::Stall, solved.result.message);
  return measured(solved, std::max(0.0, solved.wall_s - seconds), kLate, "took no heed of its time limit");
}

}  // namespace

std::vector<StressRow> interrupt_rows(const SubjectPointer& subject) {
  constexpr unsigned kSeed = 17;
  constexpr int kMoments = 3;
  const auto cancelled = [&](const std::string& moment, double part, bool is_quick) -> StressRow {
    return {"S17",
            subject->name,
            "cancelled " + moment + ", taken up again",
            kDistanceFromOwn,
            "",
            is_quick,
            [subject, part] { return cancelled_and_resumed(*subject, part); }};
  };
  const auto timed = [&](const char* name, double part, bool is_quick) -> StressRow {
    return {"S17", subject->name, name, "time after the limit", "s", is_quick, [subject, part] {
              return out_of_time(*subject, part);
            }};
  };
  std::vector<StressRow> rows = {cancelled("at the start", 0, true), cancelled("half-way", 0.5, true),
                                 cancelled("near the end", 0.9, false)};
  RandomSource draw(kSeed);
  for (int k = 0; k < kMoments; ++k) {
    const int percent = draw.whole(1, 99);
    rows.push_back(
        cancelled("after " + std::to_string(percent) + " % of the iterations", 0.01 * percent, k == 0));
  }
  rows.push_back(timed("no time at all", 0, true));
  rows.push_back(timed("half the time that it takes", 0.5, false));
  return rows;
}

}  // namespace coapt
