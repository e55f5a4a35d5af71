// S3, S4, S5, S6, S25: loads, stiffnesses, chords and triangles far from the usual. Nothing is known of the
// answer but that it must be one: what is called converged is measured again by an objective that was made
// anew.
#include "core/number_text.hpp"
#include "stress/scenes/slivers.hpp"
#include "stress/subject.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr int kEvery = 10;  // vertices for one that is moved

StressOutcome solved_anew(StressSubject& subject, const StressScene& changed) {
  const double tolerance = tolerance_of(own_scene(subject));
  const StressRun solved = subject.bench.solve(changed);
  if (auto outcome = not_converged(solved, tolerance)) return *outcome;
  double residual = fresh_residual(changed, solved.x);
  if (std::isnan(residual)) residual = solved.result.residual;  // of a barrier that was stiffened on the way
  return measured(solved, residual, kResidualSlack * tolerance,
                  "called converged, but a new objective measures another residual");
}

StressRow row(const SubjectPointer& subject, const char* id, const std::string& name, bool is_quick,
              std::function<StressOutcome()> run) {
  return {id, subject->name, name, "residual, measured anew", "", is_quick, std::move(run)};
}

StressRow scaled_row(const SubjectPointer& subject, const char* id, const std::string& what, double factor,
                     bool is_quick, bool (*is_meant)(const TermSpec&)) {
  return row(subject, id, what + " times " + number_text(factor), is_quick,
             [subject, what, factor, is_meant]() -> StressOutcome {
               const std::vector<TermSpec>& terms = own_scene(*subject).scene.terms;
               if (std::none_of(terms.begin(), terms.end(), is_meant))
                 return {StressVerdict::NotApplicable, {}, {}, "the scene has no " + what};
               for (const TermSpec& term : terms)
                 if (is_meant(term) && term.parameters.has("forces"))
                   return {StressVerdict::NotApplicable, {}, {}, "the loads are read from a file"};
               return solved_anew(*subject, with_energy_scaled(own_scene(*subject), factor, is_meant));
             });
}

StressRow short_chords_row(const SubjectPointer& subject) {
  return row(subject, "S5", "chords that start half as long again as they should", true,
             [subject]() -> StressOutcome {
               if (own_scene(*subject).geometry.networks.empty())
                 return {StressVerdict::NotApplicable, {}, {}, "the scene has no network of chords"};
               return solved_anew(*subject, with_chords_scaled(own_scene(*subject), 1 / 1.5));
             });
}

StressRow sliver_row(const SubjectPointer& subject, double aspect, bool is_quick) {
  return row(subject, "S6", "slivers of aspect " + number_text(aspect), is_quick,
             [subject, aspect]() -> StressOutcome {
               StressScene changed = copy_of(own_scene(*subject));
               const int count = add_slivers(changed, 1 / aspect, kEvery);
               if (count == 0)
                 return {StressVerdict::NotApplicable, {}, {}, "no vertex can be moved along an edge"};
               StressOutcome outcome = solved_anew(*subject, changed);
               outcome.message += "; " + std::to_string(count) + " vertices were moved";
               return outcome;
             });
}

}  // namespace

std::vector<StressRow> number_rows(const SubjectPointer& subject) {
  std::vector<StressRow> rows;
  for (const double factor : {1e-6, 1e-3, 10.0, 100.0})
    rows.push_back(scaled_row(subject, "S3", "loads", factor, factor == 1e-3, is_load));
  for (const double factor : {1e-2, 1e2, 1e4, 1e6, 1e8})
    rows.push_back(scaled_row(subject, "S4", "membranes", factor, factor == 1e2, is_sheet));
  for (const double factor : {1e-2, 1e2, 1e4, 1e6, 1e8})
    rows.push_back(scaled_row(subject, "S4", "lines", factor, factor == 1e2, is_line));
  for (const double factor : {1e-12, 1e12})
    rows.push_back(scaled_row(subject, "S25", "membranes", factor, false, is_sheet));
  rows.push_back(short_chords_row(subject));
  for (const double aspect : {1e2, 1e4, 1e6}) rows.push_back(sliver_row(subject, aspect, aspect == 1e4));
  return rows;
}

}  // namespace coapt
