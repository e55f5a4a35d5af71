// S13, S14 and the balance: what the product promises of any result.
#include "stress/subject.hpp"

#include <algorithm>

namespace coapt {
namespace {

StressOutcome intersections_on_the_way(StressSubject& subject, double load) {
  const StressScene pressed =
      load == 1 ? copy_of(own_scene(subject)) : with_energy_scaled(own_scene(subject), load, is_load);
  if (pressed.geometry.model.mesh.triangle_count() == 0)
    return {StressVerdict::NotApplicable, {}, {}, "the scene has no facets"};
  const StressRun solved = subject.bench.solve(pressed, {.judges_every_state = true});
  if (auto wrong = untruth(solved, tolerance_of(own_scene(subject)))) {
    wrong->figure = static_cast<double>(solved.intersections);
    wrong->limit = 0;
    return *wrong;
  }
  const std::string seen = ", " + std::to_string(solved.judged) + " states were judged";
  if (!solved.promises_contact)
    return {StressVerdict::NotApplicable,
            static_cast<double>(solved.intersections),
            {},
            "the scene has no barrier that promises anything" + seen};
  const bool has_converged = solved.result.status == Status::Converged;
  StressOutcome outcome = outcome_of(solved, has_converged ? StressVerdict::Pass : StressVerdict::Stall,
                                     solved.result.message + seen);
  outcome.figure = static_cast<double>(solved.intersections);
  outcome.limit = 0;
  return outcome;
}

StressRow intersection_row(const SubjectPointer& subject, const char* id, const std::string& name,
                           double load, bool is_quick) {
  return {id,
          subject->name,
          name,
          "most pairs of facets through each other at any state",
          "",
          is_quick,
          [subject, load] { return intersections_on_the_way(*subject, load); }};
}

StressOutcome balance(StressSubject& subject) {
  constexpr double kLimit = 1e-10;
  if (auto outcome = no_yardstick(subject)) return *outcome;
  const StressRun& own = own_solution(subject);
  const Certificate& certificate = own.result.certificate;
  if (!certificate.is_balance_clear)
    return {StressVerdict::NotApplicable,
            {},
            {},
            "there are no loads or reactions that stand clear of round-off"};
  // What is left over at the free nodes is missing in the reactions.
  const double limit = std::max(kLimit, own.result.residual);
  return measured(own, std::max(certificate.balance.force, certificate.balance.moment), limit,
                  "reactions do not balance the loads");
}

}  // namespace

std::vector<StressRow> promise_rows(const SubjectPointer& subject) {
  return {intersection_row(subject, "S13", "contact at every state", 1, true),
          intersection_row(subject, "S14", "contact at every state, loads times 10", 10, false),
          intersection_row(subject, "S14", "contact at every state, loads times 100", 100, false),
          {"P", subject->name, "reactions balance the loads", "forces and moments left over, relative", "",
           true, [subject] { return balance(*subject); }}};
}

}  // namespace coapt
