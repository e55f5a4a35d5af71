#include "results/standing.hpp"

#include "results/result_warnings.hpp"

namespace coapt {

bool Standing::has_converged() const { return status == status_name(Status::Converged); }

Standing standing(const std::string& name, const Report& report) {
  return {name, std::string(status_name(report.result.status)), headline(report).text, doubts(report)};
}

std::vector<std::string> doubts(const Model& model, const Result& result, const Fields& fields,
                                const Metrics& metrics) {
  Report report;
  report.result = result;
  report.fields = fields;
  report.metrics = metrics;
  report.surface_doubts = surface_doubts(model.mesh);
  return doubts(report);
}

std::string joined_doubts(const std::vector<std::string>& doubts) {
  std::string text;
  for (const std::string& doubt : doubts) text += (text.empty() ? "" : "; ") + doubt;
  return text;
}

std::string shown_status(const Standing& of) {
  return of.has_converged() && !of.doubts.empty() ? of.status + ", in doubt" : of.status;
}

std::string doubts_in_words(std::span<const Standing> all) {
  constexpr size_t kNamed = 3;
  std::vector<const Standing*> doubted;
  for (const Standing& each : all)
    if (each.has_converged() && !each.doubts.empty()) doubted.push_back(&each);
  if (doubted.empty()) return "";
  std::string text;
  if (doubted.size() > kNamed) {
    text = std::to_string(doubted.size()) + " of " + std::to_string(all.size());
  } else {
    for (size_t k = 0; k < doubted.size(); ++k)
      text += (k == 0 ? "" : k + 1 == doubted.size() ? " and " : ", ") + doubted[k]->name;
  }
  text += doubted.size() == 1 ? " is in doubt" : " are in doubt";
  return text + (doubted.size() > kNamed ? ", " + doubted.front()->name : "") + ": " +
         joined_doubts(doubted.front()->doubts);
}

}  // namespace coapt
