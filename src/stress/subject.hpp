// A scene under stress and its own solution, which the rows are compared with. Private to this room.
#pragma once

#include "stress/scenes/changed_scene.hpp"

#include <memory>

namespace coapt {

struct StressSubject {
  std::string name;  // in the table
  StressRunner bench;
  std::function<StressScene()> make;  // called once
  double same_shape = 1e-6;           // distance that counts as none, over the extent
  bool same_history = false;          // judges status and number of iterations in other units too
  std::optional<StressScene> scene = {};
  std::optional<StressRun> solution = {};
};
using SubjectPointer = std::shared_ptr<StressSubject>;

inline constexpr const char* kDistanceFromOwn = "greatest distance from the own solution, over the extent";
inline constexpr double kResidualSlack =
    10;  // of the tolerance, where another objective measures the residual

// The scene as it is and its solution, each made when it is first asked for. The former throws InputError.
const StressScene& own_scene(StressSubject& subject);
StressRun& own_solution(StressSubject& subject);

double extent_of(StressSubject& subject);  // diagonal of the box around all nodes at rest [mm]

// The own solution to look at; nothing where no row has asked for it.
std::optional<ShownSolve> own_solve(const StressSubject& subject);

// Judges a solve that must end in the scene's own shape. x: its shape in the frame of the scene, relative to
// the origin there [mm]; energy_unit: what an energy there is in the solve. Figure: the largest distance of a
// node from where it is in the own solution, over the extent. Where that is above the limit both are solved
// on to a smaller residual first, so that a loose tolerance is not taken for another answer.
StressOutcome same_shape_as_own(StressSubject& subject, const StressRun& solved, const Points& x,
                                double energy_unit = 1);

// The outcome where the scene itself is no yardstick, as it does not converge.
std::optional<StressOutcome> no_yardstick(StressSubject& subject);

inline double tolerance_of(const StressScene& scene) { return scene.scene.solver.tolerance; }

// The rows by family. Each row keeps the subject.
std::vector<StressRow> frame_rows(const SubjectPointer& subject);       // S1, S2, S7
std::vector<StressRow> number_rows(const SubjectPointer& subject);      // S3, S4, S5, S6, S25
std::vector<StressRow> start_rows(const SubjectPointer& subject);       // S8, S9, S10, S22
std::vector<StressRow> failure_rows(const SubjectPointer& subject);     // S16
std::vector<StressRow> interrupt_rows(const SubjectPointer& subject);   // S17
std::vector<StressRow> repetition_rows(const SubjectPointer& subject);  // S18, methods
std::vector<StressRow> thread_rows(const SubjectPointer& subject);      // S19
std::vector<StressRow> promise_rows(const SubjectPointer& subject);     // S13, S14, balance
std::vector<StressRow> collision_rows(const SubjectPointer& subject);   // S15
std::vector<StressRow> input_rows(const SubjectPointer& subject);       // S20
std::vector<StressRow> descent_rows(const SubjectPointer& subject);     // S21
std::vector<StressRow> derivative_rows(const SubjectPointer& subject);  // S23
std::vector<StressRow> size_rows(const SubjectPointer& subject);        // S24

}  // namespace coapt
