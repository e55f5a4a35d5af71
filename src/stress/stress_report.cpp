#include "stress/stress_report.hpp"

#include "core/components.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "report/report_page.hpp"
#include "results/csv_row.hpp"
#include "results/study_files.hpp"

namespace coapt {
namespace {

constexpr StressVerdict kVerdicts[] = {StressVerdict::Pass, StressVerdict::OtherBranch, StressVerdict::Stall,
                                       StressVerdict::NotApplicable, StressVerdict::Fail};

OrderedJson row_json(const StressResult& result) {
  const StressOutcome& outcome = result.outcome;
  OrderedJson json = {{"id", result.row.id},
                      {"topic", std::string(stress_topic(result.row.id))},
                      {"scene", result.row.scene},
                      {"name", result.row.name},
                      {"verdict", std::string(stress_verdict_name(outcome.verdict))},
                      {"measure", result.row.measure},
                      {"figure", number_json(outcome.figure)},
                      {"limit", number_json(outcome.limit)},
                      {"unit", result.row.unit},
                      {"status", outcome.status.empty() ? OrderedJson(nullptr) : OrderedJson(outcome.status)},
                      {"residual", number_json(outcome.residual)}};
  json["iterations"] = outcome.iterations ? OrderedJson(*outcome.iterations) : OrderedJson(nullptr);
  json["wall_s"] = number_json(result.wall_s);
  json["cpu_s"] = number_json(result.cpu_s);
  json["message"] = outcome.message;
  return json;
}

OrderedJson matrix_json(const StressMatrix& matrix) {
  OrderedJson json = {{"version", version()}};
  json["scene"] = matrix.scene_file.empty() ? OrderedJson(nullptr) : OrderedJson(matrix.scene_file);
  json["time_limit_s"] = number_json(matrix.row_seconds);
  json["holds"] = matrix.holds();
  json["cancelled"] = matrix.is_cancelled;
  for (const StressVerdict verdict : kVerdicts)
    json["counts"][std::string(stress_verdict_name(verdict))] = matrix.count(verdict);
  json["rows"] = OrderedJson::array();
  for (const StressResult& result : matrix.results) json["rows"].push_back(row_json(result));
  return json;
}

Tone tone_of(StressVerdict verdict) {
  switch (verdict) {
    case StressVerdict::Pass:
      return Tone::Good;
    case StressVerdict::OtherBranch:
    case StressVerdict::Stall:
      return Tone::Caution;
    case StressVerdict::Fail:
      return Tone::Bad;
    case StressVerdict::NotApplicable:
      break;
  }
  return Tone::Plain;
}

std::string number_cell(const std::optional<double>& value) { return value ? page_number(*value, 3) : ""; }

std::vector<PageCell> page_row(const StressResult& result) {
  const StressRow& row = result.row;
  const StressOutcome& outcome = result.outcome;
  const std::string unit = row.unit.empty() ? "" : " " + row.unit;
  return {{row.name, Tone::Plain, row.scene},
          {std::string(stress_verdict_name(outcome.verdict)), tone_of(outcome.verdict), outcome.message},
          {number_cell(outcome.figure) + (outcome.figure ? unit : ""), Tone::Plain, row.measure},
          {number_cell(outcome.limit)},
          {outcome.iterations ? std::to_string(*outcome.iterations) : ""},
          {page_number(result.wall_s, 2)}};
}

PageTable table_of(const std::string& caption) {
  return {caption,
          {{"what is varied", true, 25},
           {"verdict", true, 34},
           {"figure", false, 18},
           {"limit", false, 7},
           {"iterations", false, 8},
           {"wall [s]", false, 8}},
          {},
          ""};
}

PageSection reading_section() {
  return {
      "How to read it",
      {PageList{{{"pass: an answer, and the figure is within its limit.", Tone::Good},
                 {"branch: an equilibrium of the same scene, confirmed by its residual, but another one.",
                  Tone::Caution},
                 {"stall: no answer; the status says so, the positions are finite, and there is a reason.",
                  Tone::Caution},
                 {"fail: a wrong answer called converged, numbers that are not finite, a limit or a promise "
                  "not kept.",
                  Tone::Bad},
                 {"n/a: the row means nothing for this scene, or the scene is refused with the reason."}}}}};
}

}  // namespace

std::string stress_json(const StressMatrix& matrix) { return json_text(matrix_json(matrix), 2) + "\n"; }

std::string stress_csv(const StressMatrix& matrix) {
  std::ostringstream csv = csv_with_header(
      "id,scene,name,verdict,figure,limit,unit,status,residual,iterations,wall_s,cpu_s,measure,message");
  for (const StressResult& result : matrix.results) {
    const StressOutcome& outcome = result.outcome;
    Row row(csv);
    for (const std::string& text : {result.row.id, result.row.scene, result.row.name,
                                    std::string(stress_verdict_name(outcome.verdict))})
      row.text(text);
    for (const auto& value : {outcome.figure, outcome.limit}) row.number(value);
    for (const std::string& text : {result.row.unit, outcome.status}) row.text(text);
    row.number(outcome.residual);
    row.number(outcome.iterations);
    for (const double seconds : {result.wall_s, result.cpu_s}) row.number(seconds);
    for (const std::string& text : {result.row.measure, outcome.message}) row.text(text);
    csv << '\n';
  }
  return csv.str();
}

std::string stress_summary(const StressMatrix& matrix) {
  const auto part = [&](StressVerdict verdict, const char* words) {
    const int count = matrix.count(verdict);
    return count == 0 ? std::string() : ", " + std::to_string(count) + words;
  };
  return std::to_string(matrix.results.size()) +
         " rows: " + std::to_string(matrix.count(StressVerdict::Pass)) + " pass" +
         part(StressVerdict::OtherBranch, " on another branch") +
         part(StressVerdict::Stall, " stall honestly") + part(StressVerdict::NotApplicable, " do not apply") +
         part(StressVerdict::Fail, " FAIL") + (matrix.is_cancelled ? "; cancelled before the end" : "");
}

std::string stress_page(const StressMatrix& matrix) {
  Page page{.title = "Stability matrix of " +
                     (matrix.scene_file.empty() ? std::string("the built-in scenes") : matrix.scene_title),
            .lead = stress_summary(matrix)};
  const bool is_whole = !matrix.is_cancelled && matrix.count(StressVerdict::Stall) == 0;
  page.tone = matrix.has_failed() ? Tone::Bad : (is_whole ? Tone::Good : Tone::Caution);
  if (matrix.has_failed()) {
    PageTable failed = table_of("Rows that fail");
    for (const StressResult& result : matrix.results)
      if (result.outcome.verdict == StressVerdict::Fail) failed.rows.push_back(page_row(result));
    page.sections.push_back({"Failures", {std::move(failed)}});
  }
  page.sections.push_back(reading_section());
  if (matrix.shown) page.sections.push_back(shape_section("The scene's own solution", *matrix.shown));
  PageSection all{"The matrix", {}};
  for (size_t k = 0; k < matrix.results.size();) {
    const std::string& id = matrix.results[k].row.id;
    PageBlock& block = all.blocks.emplace_back(table_of(id + ": " + std::string(stress_topic(id))));
    std::vector<std::vector<PageCell>>& rows = std::get<PageTable>(block).rows;
    for (; k < matrix.results.size() && matrix.results[k].row.id == id; ++k)
      rows.push_back(page_row(matrix.results[k]));
  }
  page.sections.push_back(std::move(all));
  if (matrix.shown)
    page.sections.insert(page.sections.end(), matrix.shown->account.begin(), matrix.shown->account.end());
  page.footer = "Time limit of each solve: " + page_number(matrix.row_seconds) + " s.";
  return report_page(page);
}

void write_stress(const std::filesystem::path& folder, const StressMatrix& matrix) {
  write_study(folder, "stress", matrix_json(matrix), stress_csv(matrix));
  formats::write_whole(folder / "stress.html", stress_page(matrix));
}

}  // namespace coapt
