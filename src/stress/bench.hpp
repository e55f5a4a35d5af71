// What the rows of the stability matrix share: a scene on its nodes, one way to solve it, and one judge of
// whether what came out is true. Private to this room.
#pragma once

#include "optim/run_record.hpp"
#include "scene/build/scene_geometry.hpp"
#include "stress/stress.hpp"

#include <string>

namespace coapt {

// A scene and its nodes, before it has terms. What is done to either is not seen by the file.
struct StressScene {
  Scene scene;
  SceneGeometry geometry;
};

// Throws InputError.
StressScene stress_scene(const Scene& scene);

// The same scene once more, to be changed.
StressScene copy_of(const StressScene& subject);

// How one solve differs from what the scene wants.
struct StressSolve {
  std::string solver = {};             // empty: the scene's
  std::optional<double> seconds = {};  // time limit; empty: that of the rows
  const Points* start = nullptr;       // the supports are then where their motion ends
  Observer observer = {};              // besides that of the rows; may be empty
  RunRecorder* recorder = nullptr;     // keeps the run or takes it up; may be null. Not with a start
  bool keeps_history = false;          // for a page
  bool judges_every_state = false;     // counts intersections at each accepted state, not at the last alone
  std::function<void(Model&)> edit = {};  // changes the model before the solve; may be empty
};

struct StressRun {
  Model model;
  Result result;
  Points x;                                       // the last state, relative to the model's origin [mm]
  std::vector<RecordedShape> shape_history = {};  // to x, where it is kept
  long intersections = 0;                         // the most at any state that was judged
  long judged = 0;                                // states
  double seconds = 0;                             // time limit that held [s]
  double wall_s = 0;                              // of the solve
  bool promises_contact = false;
};

class StressRunner {
 public:
  explicit StressRunner(StressOptions options = {}) : options_(std::move(options)) {}

  const StressOptions& options() const { return options_; }
  bool has_solver(const std::string& name) const { return options_.solvers.contains(name); }

  // Throws InputError where the scene cannot be built, or asks for what this build has not.
  void check(const StressScene& subject) const;
  StressRun solve(const StressScene& subject, const StressSolve& how = {}) const;

 private:
  StressOptions options_;
};

// Pairs of facets at x that pass through each other, one or both of the mesh.
long intersection_count(const Model& model, const Points& x, const IntersectionChecker& checker);

// The outcome with status, residual and iterations of the solve.
StressOutcome outcome_of(const StressRun& solved, StressVerdict verdict, std::string message);

// A failure where something that is said or promised is not true: numbers that are not finite, a residual
// above the tolerance that is called converged, no reason given, a time limit that was not kept,
// intersections in spite of a barrier. Else nothing.
std::optional<StressOutcome> untruth(const StressRun& solved, double tolerance);

// The same, and the stall of what did not converge. Nothing: it did.
std::optional<StressOutcome> not_converged(const StressRun& solved, double tolerance);

// The relative residual of x in the scene as it is, terms made anew; not a number where terms change with
// what they have seen (a barrier that was stiffened), as theirs is then another energy.
double fresh_residual(const StressScene& subject, const Points& x);

// A pass where figure <= limit, else a failure with the message; the figure stands in both.
StressOutcome measured(const StressRun& solved, double figure, double limit, const std::string& message);
}  // namespace coapt
