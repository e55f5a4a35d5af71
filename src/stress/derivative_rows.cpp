// S23: the derivative of a result with respect to the length of a chord.
//
// The result is the least potential energy. Where the loads have a potential its derivative is exact without
// a solve: at an equilibrium the shape's own change costs nothing, so that what is left is the derivative of
// the energy at fixed positions (the envelope theorem). That is compared with a central difference of two
// solves.
#include "core/number_text.hpp"
#include "scene/build/build.hpp"
#include "scene/terms/term_types.hpp"
#include "stress/subject.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kTolerance = 1e-9;  // of the solves, or the scene's own where that is less

// A chord by the path of its network and its number there.
struct ChordPlace {
  std::string network;
  size_t number = 0;
  double elongation = 0;  // [mm]
};

// Pressures held as they act on the rest shape: a pressure on a free edge has no potential.
StressScene with_a_potential(const StressScene& subject) {
  StressScene changed = copy_of(subject);
  for (TermSpec& term : changed.scene.terms)
    if (kind_of(term) == TermKind::Pressure && term.parameters.text("model") == "follower")
      term.parameters.set("model", std::string("frozen"));
  changed.scene.solver.tolerance = std::min(tolerance_of(subject), kTolerance);
  return changed;
}

// The chord that pulls most for its length.
std::optional<ChordPlace> tautest_chord(const StressScene& scene, const Points& x) {
  constexpr double kLeastStrain = 1e-4;
  std::optional<ChordPlace> tautest;
  double strain = kLeastStrain;
  for (const auto& [path, placed] : scene.geometry.networks)
    for (size_t k = 0; k < placed.network.chords.size(); ++k) {
      const Chord& chord = placed.network.chords[k];
      const double elongation =
          (x.col(placed.node(chord.from)) - x.col(placed.node(chord.to))).norm() - chord.rest_length;
      if (!(elongation > strain * chord.rest_length) || chord.rest_length == 0) continue;
      strain = elongation / chord.rest_length;
      tautest = ChordPlace{path, k, elongation};
    }
  return tautest;
}

StressScene with_longer_chord(const StressScene& scene, const ChordPlace& place, double by) {
  StressScene changed = copy_of(scene);
  changed.geometry.networks.at(place.network).network.chords[place.number].rest_length += by;
  return changed;
}

// (f(h) - f(-h)) / 2h.
template <class Function>
double central_difference(double h, const Function& f) {
  return (f(h) - f(-h)) / (2 * h);
}

double energy_at(const StressScene& scene, const Points& x) {
  Model model = build(scene.scene, scene.geometry);
  const Problem problem = problem_at(x, model);
  return model.objective->value(problem.q0);
}

StressOutcome derivative_by_chord(StressSubject& subject) {
  constexpr double kLimit = 1e-4, kStepFixed = 1e-3, kStepSolved = 3e-3;  // steps: shares of the elongation
  const StressScene scene = with_a_potential(own_scene(subject));
  if (scene.geometry.networks.empty())
    return {StressVerdict::NotApplicable, {}, {}, "the scene has no network of chords"};
  const StressRun solved = subject.bench.solve(scene);
  if (auto outcome = not_converged(solved, tolerance_of(scene))) return *outcome;
  if (solved.model.objective->step_limiting_term() != nullptr)
    return {StressVerdict::NotApplicable, {}, {}, "where contact changes there is no such derivative"};
  const std::optional<ChordPlace> place = tautest_chord(scene, solved.x);
  if (!place) return {StressVerdict::NotApplicable, {}, {}, "no chord pulls in the solution"};
  const double exact = central_difference(kStepFixed * place->elongation, [&](double by) {
    return energy_at(with_longer_chord(scene, *place, by), solved.x);
  });
  std::optional<StressOutcome> missed;
  const double found = central_difference(kStepSolved * place->elongation, [&](double by) {
    const StressRun near = subject.bench.solve(with_longer_chord(scene, *place, by), {.start = &solved.x});
    if (auto outcome = not_converged(near, tolerance_of(scene))) missed = outcome;
    return near.result.energy;
  });
  if (missed) return *missed;
  StressOutcome outcome = measured(solved, std::abs(found / exact - 1), kLimit,
                                   "the energies of two solves have another derivative");
  outcome.message += "; chord " + std::to_string(place->number) + ": " + number_text(exact) +
                     " mJ/mm at fixed positions, " + number_text(found) + " by two solves";
  return outcome;
}

}  // namespace

std::vector<StressRow> derivative_rows(const SubjectPointer& subject) {
  return {{"S23", subject->name, "the tautest chord made longer and shorter, pressures dead",
           "error of the energy's derivative", "", true,
           [subject] { return derivative_by_chord(*subject); }}};
}

}  // namespace coapt
