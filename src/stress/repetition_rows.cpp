// S18, S19 and H3: the same run twice, in another process, on several threads, and by another method.
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "scene/build/build.hpp"
#include "stress/subject.hpp"

#include <algorithm>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDiffering = "numbers that differ";

double differing_numbers(const StressRun& a, const StressRun& b) {
  double different = (a.x.array() != b.x.array()).cast<double>().sum();
  if (a.result.energy != b.result.energy) ++different;
  if (a.result.residual != b.result.residual) ++different;
  if (a.result.iterations != b.result.iterations) ++different;
  return different;
}

// What is stopped by the clock is not stopped at the same state.
bool is_out_of_time(const StressRun& solved) { return solved.result.status == Status::TimeLimit; }

StressOutcome same_bits(StressSubject& subject) {
  const StressRun& own = own_solution(subject);
  const StressRun solved = subject.bench.solve(own_scene(subject));
  if (auto wrong = untruth(solved, tolerance_of(own_scene(subject)))) return *wrong;
  if (is_out_of_time(own) || is_out_of_time(solved))
    return outcome_of(solved, StressVerdict::Stall, solved.result.message);
  return measured(solved, differing_numbers(solved, own), 0, "the two runs differ");
}

// What is not the same in two folders of results of one scene: positions and all fields in every bit, and
// each of these figures.
double differing_results(const fs::path& a, const fs::path& b) {
  double different = formats::read_whole(a / "closed.vtp") != formats::read_whole(b / "closed.vtp");
  const auto json_of = [](const fs::path& folder) {
    return nlohmann::json::parse(formats::read_whole(folder / "result.json"));
  };
  const nlohmann::json one = json_of(a), other = json_of(b);
  for (const char* key : {"status", "energy_mj", "residual", "iterations", "metrics"})
    different += one.at(key) != other.at(key);
  return different;
}

// As `coapt solve` does it, here and there.
StressOutcome same_bits_apart(StressSubject& subject) {
  const StressOptions& options = subject.bench.options();
  const Scene& scene = own_scene(subject).scene;
  const fs::path folder = options.folder / "S18", here = folder / "here", there = folder / "there";
  RunOptions run_options;
  run_options.factorisations = options.factorisations;
  run_options.checker = options.checker;
  run_options.max_seconds = options.row_seconds;
  run_options.folder = here;
  run_options.writes_page = false;
  run_options.observer = [&options](const Iteration&, const Vector&) {
    return !options.is_cancelled || !options.is_cancelled();
  };
  const RunReport own = run(load_scene(scene.file), options.solvers, run_options);
  options.solve_apart(scene.file, there, options.row_seconds);
  const Result& result = own.report.result;
  if (!fs::exists(there / "result.json"))
    return {StressVerdict::Fail, {}, {}, "the process of its own left no result"};
  const double different = differing_results(here, there);
  fs::remove_all(folder);
  StressOutcome outcome{
      StressVerdict::Stall, {}, {}, result.message, std::string(status_name(result.status)), result.residual,
      result.iterations};
  if (result.status == Status::TimeLimit) return outcome;
  outcome.figure = different;
  outcome.limit = 0;
  outcome.verdict = different == 0 ? StressVerdict::Pass : StressVerdict::Fail;
  if (different != 0) outcome.message = "a process of its own finds something else";
  return outcome;
}

// Elements of the largest term.
long largest_term(const StressScene& scene) {
  const Model model = build(scene.scene, scene.geometry);
  long most = 0;
  for (const auto& term : model.objective->terms())
    most = std::max(most, static_cast<long>(term->stencils().count()));
  return most;
}

// The first iterations of `newton` on the scene's own mesh, whatever the scene's method: each assembles a
// Hessian, and a bit that differs in one of them is seen in all that follows.
StressOutcome same_bits_on_threads(StressSubject& subject) {
  constexpr long kWorthThreads = 4000;  // elements, of energy/pour_elements.hpp
  constexpr int kIterations = 5;
  if (!subject.bench.has_solver("newton"))
    return {StressVerdict::NotApplicable, {}, {}, "this build has no newton, which assembles Hessians"};
  StressScene scene = copy_of(own_scene(subject));
  const long elements = largest_term(scene);
  if (elements < kWorthThreads)
    return {StressVerdict::NotApplicable,
            {},
            {},
            "no term has " + std::to_string(kWorthThreads) + " elements: threads get no work"};
  scene.scene.solver.cascade = false;
  scene.scene.solver.max_iterations = std::min(scene.scene.solver.max_iterations, kIterations);
  std::optional<StressRun> one;
  double different = 0;
  for (const int threads : {1, 2, 4, 8}) {
    scene.scene.solver.threads = threads;
    StressRun solved = subject.bench.solve(scene, {.solver = "newton"});
    if (auto wrong = untruth(solved, tolerance_of(scene))) return *wrong;
    if (is_out_of_time(solved)) return outcome_of(solved, StressVerdict::Stall, solved.result.message);
    if (one)
      different += differing_numbers(solved, *one);
    else
      one = std::move(solved);
  }
  StressOutcome outcome = measured(*one, different, 0, "numbers depend on the number of threads");
  outcome.message += "; the largest term has " + std::to_string(elements) + " elements";
  return outcome;
}

}  // namespace

std::vector<StressRow> repetition_rows(const SubjectPointer& subject) {
  std::vector<StressRow> rows = {{"S18", subject->name, "the same run again", kDiffering, "", true,
                                  [subject] { return same_bits(*subject); }}};
  if (subject->bench.options().solve_apart)
    rows.push_back({"S18", subject->name, "the same run in a process of its own", "results that differ", "",
                    true, [subject] { return same_bits_apart(*subject); }});
  for (const std::string solver : {"newton", "lbfgs"}) {
    if (!subject->bench.has_solver(solver)) continue;
    rows.push_back({"H3", subject->name, "by " + solver, kDistanceFromOwn, "", true,
                    [subject, solver]() -> StressOutcome {
                      if (own_scene(*subject).scene.solver.type == solver)
                        return {StressVerdict::NotApplicable, {}, {}, "it is the scene's own solver"};
                      const StressRun solved = subject->bench.solve(own_scene(*subject), {.solver = solver});
                      return same_shape_as_own(*subject, solved, solved.x);
                    }});
  }
  return rows;
}

std::vector<StressRow> thread_rows(const SubjectPointer& subject) {
  return {{"S19", subject->name, "1, 2, 4 and 8 threads", kDiffering, "", true,
           [subject] { return same_bits_on_threads(*subject); }}};
}

}  // namespace coapt
