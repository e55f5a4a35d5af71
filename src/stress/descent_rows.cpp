// S21: between accepted states the energy never rises. Random scenes of a few triangles, many of them beyond
// what can be solved, and any scene whose energy is one and the same from start to end.
#include "core/error.hpp"
#include "core/random_source.hpp"
#include "formats/whole_file.hpp"
#include "optim/dynamic/dynamic.hpp"
#include "results/results.hpp"
#include "stress/energy_checker.hpp"
#include "stress/scenes/built_in.hpp"
#include "stress/scenes/small_scene.hpp"
#include "stress/subject.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr unsigned kSeed = 4711;

SmallScene random_scene(int number) {
  constexpr int kBytes = 96;  // more than a scene asks for
  RandomSource draw(kSeed + static_cast<unsigned>(number));
  std::string bytes;
  for (int k = 0; k < kBytes; ++k) bytes += static_cast<char>(draw.whole(0, 255));
  return small_scene(bytes);
}

// What is wrong with the solve of a scene; empty: nothing.
std::string defect_of(const StressRun& solved, const StressScene& scene, bool has_one_potential) {
  const Result& result = solved.result;
  // Loads and stiffnesses of any size may overflow at the start: then that is what is said.
  if (result.status == Status::NonFinite && solved.x.allFinite() && !result.message.empty()) return "";
  if (const auto wrong = untruth(solved, scene.scene.solver.tolerance)) return wrong->message;
  return has_one_potential ? energy_rise(result, *solved.model.objective, solved.model.X) : "";
}

struct SmallScenes {
  int solved = 0, converged = 0, refused = 0, judged = 0, broken = 0;
  std::string first;  // what is wrong with the first that is broken
};

void solve_one(const StressRunner& bench, const std::filesystem::path& folder, int number,
               SmallScenes& tally) {
  const SmallScene small = random_scene(number);
  std::filesystem::path place = folder / "any";
  const auto write = [&] {
    prepare_result_folder(place);
    formats::write_whole(place / "mesh.obj", small.mesh);
    formats::write_whole(place / "scene.json", small.scene);
  };
  write();
  std::string defect;
  try {
    const StressScene scene = stress_scene(load_scene(place / "scene.json"));
    const StressRun solved = bench.solve(scene);
    ++tally.solved;
    tally.converged += solved.result.status == Status::Converged ? 1 : 0;
    tally.judged += small.has_one_potential ? 1 : 0;
    defect = defect_of(solved, scene, small.has_one_potential);
  } catch (const InputError&) {
    ++tally.refused;
  } catch (const std::exception& error) {
    defect = std::string("exception: ") + error.what();
  }
  if (defect.empty()) return;
  ++tally.broken;
  place = folder / std::to_string(number);  // for whoever wonders
  write();
  if (tally.first.empty()) tally.first = "scenes/S21/" + std::to_string(number) + ": " + defect;
}

StressOutcome random_scenes(const StressRunner& bench, int count) {
  const StressOptions& options = bench.options();
  SmallScenes tally;
  for (int k = 0; k < count && !(options.is_cancelled && options.is_cancelled()); ++k)
    solve_one(bench, options.folder / "scenes" / "S21", k, tally);
  std::filesystem::remove_all(options.folder / "scenes" / "S21" / "any");
  StressOutcome outcome{tally.broken == 0 ? StressVerdict::Pass : StressVerdict::Fail, tally.broken, 0};
  outcome.message = std::to_string(tally.solved) + " solved, " + std::to_string(tally.converged) +
                    " of them to the tolerance, " + std::to_string(tally.refused) +
                    " refused; energy judged in " + std::to_string(tally.judged) +
                    (tally.first.empty() ? "" : "; " + tally.first);
  return outcome;
}

StressRow random_row(const StressRunner& bench, int count, bool is_quick) {
  return {"S21",
          "random scenes",
          std::to_string(count) + " of at most 18 triangles",
          "scenes that break a promise",
          "",
          is_quick,
          [bench, count] { return random_scenes(bench, count); }};
}

// Why the energies of the trace are not all of one potential; empty: they are.
std::string other_potential(const StressRun& own, const Scene& scene) {
  Objective& objective = *own.model.objective;
  if (objective.has_circulatory_force()) return "a pressure on a free edge has no potential";
  if (objective.step_limiting_term() != nullptr) return "the barrier may be stiffened on the way";
  if (is_dynamic(scene.solver.type) || scene.solver.type == "xpbd") return "masses in motion overshoot";
  const bool has_kinks = objective.round_kinks(0);
  return scene.solver.type == "newton" && has_kinks ? "newton rounds the kinks of lines on its way" : "";
}

StressOutcome own_descent(StressSubject& subject) {
  const StressRun& own = own_solution(subject);
  const StressScene& scene = own_scene(subject);
  if (auto wrong = untruth(own, tolerance_of(scene))) return *wrong;
  const std::string other = other_potential(own, scene.scene);
  if (!other.empty()) return {StressVerdict::NotApplicable, {}, {}, other};
  const std::string rise = energy_rise(own.result, *own.model.objective, own.model.X);
  return measured(own, rise.empty() ? 0 : 1, 0, rise);
}

}  // namespace

std::vector<StressRow> random_scene_rows(const StressRunner& bench) {
  return {random_row(bench, 100, true), random_row(bench, 2000, false)};
}

std::vector<StressRow> descent_rows(const SubjectPointer& subject) {
  return {{"S21", subject->name, "the energy from state to state", "states at which it rises", "", true,
           [subject] { return own_descent(*subject); }}};
}

}  // namespace coapt
