// S1, S2, S7: the answer does not depend on units, place and point of view.
#include "stress/subject.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

// What is solved in other units goes the same way but for round-off. That may leave a residual on either side
// of the tolerance; and a run out of time says nothing.
bool ends_otherwise(const StressRun& solved, const StressRun& own, double tolerance) {
  return own.result.status == Status::Converged && solved.result.status != Status::Converged &&
         solved.result.status != Status::TimeLimit && solved.result.residual > kResidualSlack * tolerance;
}

bool is_as_long(const StressRun& solved, const StressRun& own) {
  constexpr double kShare = 0.2, kFew = 2;
  return std::abs(solved.result.iterations - own.result.iterations) <=
         std::max(kFew, kShare * own.result.iterations);
}

StressOutcome in_another_frame(StressSubject& subject, const StressFrame& frame) {
  if (const std::string obstacle = frame_obstacle(own_scene(subject), frame); !obstacle.empty())
    return {StressVerdict::NotApplicable, {}, {}, obstacle};
  const StressRun solved = subject.bench.solve(in_frame(own_scene(subject), frame));
  const StressRun& own = own_solution(subject);
  const bool judges_history = subject.same_history && (frame.length != 1 || frame.stress != 1);
  if (judges_history && ends_otherwise(solved, own, tolerance_of(own_scene(subject))))
    return outcome_of(solved, StressVerdict::Fail,
                      solved.result.message + "; in the scene's own units: " + own.result.message);
  const Points x = frame.back(solved.x, solved.model.origin, own_scene(subject).geometry.model.origin);
  StressOutcome outcome = same_shape_as_own(subject, solved, x, frame.stress * std::pow(frame.length, 3));
  if (outcome.verdict != StressVerdict::Pass) return outcome;
  outcome.message += "; " + std::to_string(solved.result.iterations) + " iterations, " +
                     std::to_string(own.result.iterations) + " in the scene's own frame";
  if (judges_history && !is_as_long(solved, own)) outcome.verdict = StressVerdict::Fail;
  return outcome;
}

// frame: its shift is in extents of the scene.
StressRow row(const SubjectPointer& subject, const char* id, const std::string& name,
              const StressFrame& frame, bool is_quick) {
  return {id, subject->name, name, kDistanceFromOwn, "", is_quick, [subject, frame] {
            StressFrame absolute = frame;
            absolute.shift *= extent_of(*subject);
            return in_another_frame(*subject, absolute);
          }};
}

StressOutcome with_triangles_turned_over(StressSubject& subject) {
  const StressRun solved = subject.bench.solve(turned_over(own_scene(subject)));
  return same_shape_as_own(subject, solved, solved.x);
}

StressOutcome in_another_order(StressSubject& subject) {
  if (const std::string obstacle = numbering_obstacle(own_scene(subject)); !obstacle.empty())
    return {StressVerdict::NotApplicable, {}, {}, obstacle};
  const Renumbered other = renumbered(own_scene(subject));
  const StressRun solved = subject.bench.solve(other.scene);
  return same_shape_as_own(subject, solved, other.back(solved.x));
}

}  // namespace

std::vector<StressRow> frame_rows(const SubjectPointer& subject) {
  const Vec3 axis = Vec3(1, 2, 3).normalized();
  StressFrame far, renamed, turned, mirrored;
  far.shift = 1e7 * Vec3(1, -1, 0.5);
  renamed.turn << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x becomes y, y z, z x
  turned.turn = Eigen::AngleAxisd(0.4 * std::numbers::pi, axis).toRotationMatrix();
  mirrored.turn.diagonal() << -1, 1, 1;
  return {row(subject, "S1", "m and Pa", {.length = 1e-3, .stress = 1e6}, true),
          row(subject, "S1", "mm and kPa", {.length = 1, .stress = 1e3}, false),
          row(subject, "S1", "um and Pa", {.length = 1e3, .stress = 1e6}, false),
          row(subject, "S1", "lengths times 1e-6", {.length = 1e-6}, true),
          row(subject, "S1", "lengths times 1e6", {.length = 1e6}, false),
          row(subject, "S2", "1e7 extents away", far, true),
          row(subject, "S7", "axes renamed", renamed, true),
          row(subject, "S7", "turned by 72 degrees", turned, false),
          row(subject, "S7", "seen in a mirror", mirrored, false),
          {"S7", subject->name, "triangles turned over, pressure of the other sign", kDistanceFromOwn, "",
           true, [subject] { return with_triangles_turned_over(*subject); }},
          {"S7", subject->name, "nodes and triangles in another order", kDistanceFromOwn, "", true,
           [subject] { return in_another_order(*subject); }}};
}

}  // namespace coapt
