#include "stress/stress_report.hpp"

#include "core/components.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "report/page_table.hpp"
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

// Columns of one share in all tables of the page, so that they stand in line.
PageTable page_rows(std::span<const StressResult> results, const std::string& caption) {
  PageTable page = page_table(
      chosen(stress_table(results), {"name", "verdict", "figure", "limit", "iterations", "wall_s"}), caption);
  constexpr int kShares[] = {25, 34, 18, 7, 8, 8};
  for (size_t c = 0; c < page.columns.size(); ++c) page.columns[c].share = kShares[c];
  for (size_t r = 0; r < results.size(); ++r) {
    const StressRow& row = results[r].row;
    const StressOutcome& outcome = results[r].outcome;
    std::vector<PageCell>& cells = page.rows[r];
    cells[0].remark = row.scene;
    cells[1] = {cells[1].text, tone_of(outcome.verdict), outcome.message};
    if (outcome.figure && !row.unit.empty()) cells[2].text += " " + row.unit;
    cells[2].remark = row.measure;
  }
  return page;
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

Table stress_table(std::span<const StressResult> results) {
  const auto row = [](auto text) { return along(&StressResult::row, text); };
  const auto outcome = [](auto... figure) { return along(&StressResult::outcome, figure...); };
  return table_of<StressResult>(
      results, {{text_column("id", "row", 4), row(&StressRow::id)},
                {text_column("scene", "", 24), row(&StressRow::scene)},
                {text_column("name", "what is varied", 58), row(&StressRow::name)},
                {text_column("verdict", "", 7), outcome(&StressOutcome::verdict, stress_verdict_name)},
                {{"figure", "", "", 3}, outcome(&StressOutcome::figure)},
                {{"limit", "", "", 3}, outcome(&StressOutcome::limit)},
                {text_column("unit"), row(&StressRow::unit)},
                {text_column("status"), outcome(&StressOutcome::status)},
                {{"residual"}, outcome(&StressOutcome::residual)},
                {{"iterations"}, outcome(&StressOutcome::iterations)},
                {{"wall_s", "wall", "s", 2, 2}, &StressResult::wall_s},
                {{"cpu_s"}, &StressResult::cpu_s},
                {text_column("measure"), row(&StressRow::measure)},
                {text_column("message"), outcome(&StressOutcome::message)}});
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
    std::vector<StressResult> failed;
    for (const StressResult& result : matrix.results)
      if (result.outcome.verdict == StressVerdict::Fail) failed.push_back(result);
    page.sections.push_back({"Failures", {page_rows(failed, "Rows that fail")}});
  }
  page.sections.push_back(reading_section());
  if (matrix.shown) page.sections.push_back(shape_section("The scene's own solution", *matrix.shown));
  PageSection all{"The matrix", {}};
  const std::span<const StressResult> results = matrix.results;
  for (size_t k = 0, end = 0; k < results.size(); k = end) {
    const std::string& id = results[k].row.id;
    while (end < results.size() && results[end].row.id == id) ++end;
    all.blocks.emplace_back(
        page_rows(results.subspan(k, end - k), id + ": " + std::string(stress_topic(id))));
  }
  page.sections.push_back(std::move(all));
  if (matrix.shown)
    page.sections.insert(page.sections.end(), matrix.shown->account.begin(), matrix.shown->account.end());
  page.footer = "Time limit of each solve: " + page_number(matrix.row_seconds) + " s.";
  return report_page(page);
}

void write_stress(const std::filesystem::path& folder, const StressMatrix& matrix) {
  write_study(folder, "stress", matrix_json(matrix), stress_table(matrix.results));
  formats::write_whole(folder / "stress.html", stress_page(matrix));
}

}  // namespace coapt
