#include "core/components.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "report/compared_view.hpp"
#include "report/page_table.hpp"
#include "results/result_warnings.hpp"
#include "results/study_files.hpp"
#include "tuning/chord_tuning.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kMainShare = 0.3;  // of a unit direction: lengths that are named in it

const char* bound_name(const TunedLength& length) {
  return length.at_bound < 0 ? "lower" : length.at_bound > 0 ? "upper" : "none";
}

OrderedJson length_json(const TunedLength& length) {
  return {{"name", length.name},
          {"chords", length.chords},
          {"before_mm", length.before},
          {"after_mm", length.after},
          {"factor", length.factor},
          {"low_mm", length.low},
          {"high_mm", length.high},
          {"bound", bound_name(length)},
          {"slack", length.is_slack},
          {"extension_mm", number_json(length.extension)},
          {"standard_deviation_mm", number_json(length.deviation)},
          {"determined",
           std::isnan(length.deviation) ? OrderedJson(nullptr) : OrderedJson(length.is_determined)}};
}

// A direction of the spectrum: the lengths that it mixes most, each with its share.
std::vector<std::pair<std::string, double>> main_lengths(const ChordTuning& found, Eigen::Index k) {
  std::vector<std::pair<std::string, double>> lengths;
  for (size_t j = 0; j < found.lengths.size(); ++j)
    if (const double share = found.determinacy->directions(static_cast<Eigen::Index>(j), k);
        std::abs(share) > kMainShare)
      lengths.emplace_back(found.lengths[j].name, share);
  return lengths;
}

bool is_determined(const ChordTuning& found, Eigen::Index k) {
  return found.determinacy->direction_deviation[k] <= found.determined;
}

OrderedJson direction_json(const ChordTuning& found, Eigen::Index k) {
  const Determinacy& spectrum = *found.determinacy;
  OrderedJson lengths = OrderedJson::object();
  for (const auto& [name, share] : main_lengths(found, k)) lengths[name] = share;
  return {{"singular_value", number_json(spectrum.singular_values[k])},
          {"standard_deviation_mm", number_json(spectrum.direction_deviation[k])},
          {"determined", is_determined(found, k)},
          {"main_lengths", lengths}};
}

OrderedJson trial_json(const ChordTuning& found, const TuningTrial& trial, int number) {
  OrderedJson json = {
      {"solve", number},
      {"status", std::string(status_name(trial.status))},
      {"cost", number_json(trial.cost)},
      {"rms_distance_mm", number_json(std::sqrt(trial.misfit))},
      {"best", trial.is_best},
      {"drawn_to_target", trial.is_aided},
      {"iterations", trial.iterations},
      {"lost_branch_mm", trial.lost_branch ? number_json(trial.lost_branch->distance) : OrderedJson(nullptr)},
      {"seconds", trial.seconds},
      {"factors", OrderedJson::array()}};
  size_t metric = 0;
  for (const auto& [name, weight] : {std::pair("smooth_orifice_mm2", found.orifice_weight),
                                     std::pair("smooth_chord_force_n", found.force_weight)})
    if (weight > 0)
      json[name] =
          metric < trial.metrics.size() ? number_json(trial.metrics[metric++]) : OrderedJson(nullptr);
  for (const double factor : trial.value) json["factors"].push_back(factor);
  return json;
}

std::vector<ChangedFigure> metrics_of(const ChordTuning& found) {
  return changed_figures(found.before.report.metrics, found.after ? &found.after->report.metrics : nullptr);
}

OrderedJson metrics_json(const ChordTuning& found) {
  OrderedJson metrics = OrderedJson::object();
  for (const ChangedFigure& figure : metrics_of(found))
    metrics[figure.before.name] = {{"unit", figure.before.unit},
                                   {"before", number_json(figure.before.value)},
                                   {"after", number_json(figure.after)}};
  return metrics;
}

OrderedJson state_json(const RunReport& run) {
  const Result& result = run.report.result;
  return {{"status", std::string(status_name(result.status))},
          {"message", result.message},
          {"doubts", doubts(run.report)},
          {"residual", number_json(result.residual)},
          {"iterations", result.iterations},
          {"folder", run.folder.filename().string()},
          {"warnings", run.report.warnings}};
}

PageTable figure_table(const ChordTuning& found) {
  std::vector<ChangedFigure> figures = metrics_of(found);
  if (std::isfinite(found.misfit_before()))
    figures.insert(figures.begin(),
                   changed_figure({.name = "rms_distance_mm",
                                   .unit = "mm",
                                   .meaning = "Root mean square distance of the vertices from the target.",
                                   .value = found.misfit_before()},
                                  found.misfit_after()));
  return change_page_table(figures);
}

std::string remarks_on(const TunedLength& length, bool has_determinacy) {
  std::string remarks;
  const auto remark = [&](bool holds, const std::string& text) {
    if (holds) remarks += (remarks.empty() ? "" : ", ") + text;
  };
  remark(length.chords > 1, "mean of " + std::to_string(length.chords) + " chords");
  remark(length.at_bound != 0, std::string("at its ") + bound_name(length) + " bound");
  remark(length.is_slack, "slack");
  const bool is_open = has_determinacy && !length.is_determined;
  remark(is_open, "not determined by the target");
  remark(is_open && !length.is_slack && length.is_hardly_taut, "hardly taut");
  return remarks;
}

PageTable page_lengths(const ChordTuning& found) {
  PageTable table = page_table(chosen(length_table(found), kShownOfLengths), "Rest lengths");
  for (size_t k = 0; k < table.rows.size(); ++k) {
    const TunedLength& length = found.lengths[k];
    const bool is_open = found.determinacy && !length.is_determined;
    if (is_open || length.at_bound != 0) table.rows[k].back().tone = Tone::Caution;
  }
  if (found.determinacy)
    table.note = "Standard deviation where the distance of every vertex from the target is off by " +
                 page_number(found.noise) +
                 " mm (standard deviation, independent from vertex to vertex); above " +
                 page_number(found.determined) + " mm a length counts as not determined.";
  return table;
}

PagePlot history_plot(const ChordTuning& found) {
  PagePlot plot{.title = "Cost of each solve",
                .x = {"solve"},
                .y = {"cost", Scale::ByRange},
                .crossed = "on another branch of equilibria"};
  PageSeries all{.name = "each", .is_joined = false}, best{.name = "best so far"};
  int number = 1, rejected = 0, aided = 0;
  double least = kInfinity;
  for (const TuningTrial& trial : found.tuning.best.history) {
    ++number;
    if (!std::isfinite(trial.cost)) {
      ++(trial.is_aided ? aided : rejected);
      continue;
    }
    least = std::min(least, trial.cost);
    all.points.push_back({static_cast<double>(number), trial.cost, trial.lost_branch.has_value()});
    best.points.push_back({static_cast<double>(number), least});
  }
  plot.series = {best, all};
  if (aided > 0)
    plot.note =
        std::to_string(aided) +
        " solves had springs that drew the leaflets to the target; they have no cost and are not shown. ";
  if (rejected > 0)
    plot.note += std::to_string(rejected) + " solves did not converge; they have no cost and are not shown.";
  return plot;
}

PagePlot spectrum_plot(const ChordTuning& found) {
  PagePlot plot{.title = "Singular value of each combination of lengths",
                .x = {"combination, best determined first"},
                .y = {"singular value [mm/mm]", Scale::ByRange}};
  PageSeries known{.name = "determined", .is_joined = false},
      open{.name = "not determined", .is_joined = false};
  const Determinacy& spectrum = *found.determinacy;
  int without = 0;
  for (Eigen::Index k = 0; k < spectrum.singular_values.size(); ++k) {
    if (!std::isfinite(spectrum.direction_deviation[k])) {
      ++without;  // its value is rounding
      continue;
    }
    PageSeries& series = is_determined(found, k) ? known : open;
    series.points.push_back({static_cast<double>(k + 1), spectrum.singular_values[k], false,
                             "standard deviation " + page_number(spectrum.direction_deviation[k]) + " mm"});
  }
  for (const PageSeries& series : {known, open})
    if (!series.points.empty()) plot.series.push_back(series);
  plot.note =
      "Root mean square of how far the distances from the target move where the lengths change by 1 mm along "
      "the combination.";
  if (without > 0) plot.note += " Not shown: " + std::to_string(without) + " that have no influence on them.";
  return plot;
}

std::string combination_text(const ChordTuning& found, Eigen::Index k) {
  std::string text;
  for (const auto& [name, share] : main_lengths(found, k)) {
    if (text.empty())
      text = share < 0 ? "−" : "";
    else
      text += share < 0 ? " − " : " + ";
    text += page_number(std::abs(share), 2) + " " + name;
  }
  return text.empty() ? "many lengths, a little of each" : text;
}

PageTable spectrum_table(const ChordTuning& found) {
  Table table{.columns = {text_column("combination"),
                          {"singular value", "", "mm/mm"},
                          {"standard deviation", "", "mm"},
                          text_column("determined"),
                          text_column("lengths with the greatest shares")}};
  const Determinacy& spectrum = *found.determinacy;
  for (Eigen::Index k = 0; k < spectrum.singular_values.size(); ++k)
    table.rows.push_back({k + 1, spectrum.singular_values[k], spectrum.direction_deviation[k],
                          is_determined(found, k) ? "yes" : "no", combination_text(found, k)});
  PageTable page = page_table(
      table, "Combinations of lengths",
      "Unit directions in the lengths, from the singular values of the derivatives of all distances: "
      "docs/tuning.md. Lengths with a share above " +
          page_number(kMainShare) + " are named; – is a standard deviation without bound.");
  for (std::vector<PageCell>& row : page.rows)
    if (row[3].text == "no") row[3].tone = Tone::Caution;
  return page;
}

// Of what was found: the untuned state where there is no other.
std::vector<Standing> standings(const ChordTuning& found) {
  if (found.after) return {standing("after", found.after->report)};
  return {standing("before", found.before.report)};
}

PageList messages(const ChordTuning& found) {
  PageList list;
  const bool is_plain = found.has_converged() && doubts_in_words(standings(found)).empty();
  list.items.push_back({found.tuning.message, is_plain ? Tone::Good : Tone::Caution});
  list.items.push_back({std::to_string(found.solves) + " solves by " + found.method + " in " +
                        page_number(found.seconds) + " s, " + std::to_string(found.tuning.failed) +
                        " of them rejected because they did not converge"});
  if (!found.target.empty()) list.items.push_back({"target: " + found.target});
  if (found.tuning.lost_branches > 0)
    list.items.push_back({std::to_string(found.tuning.lost_branches) +
                              (found.tuning.lost_branches == 1 ? " trial" : " trials") +
                              " ended on another branch of equilibria than the shape it came from",
                          Tone::Caution});
  if (found.tuning.anchor && !found.tuning.anchor->is_same_branch)
    list.items.push_back({"the best shape " + found.tuning.anchor->message, Tone::Caution});
  if (found.determinacy && !found.is_explained)
    list.items.push_back({"a target that is off by " + page_number(found.noise) +
                              " mm does not explain what the fit leaves: it is trapped, or the model is "
                              "another; no length counts as determined",
                          Tone::Caution});
  const auto add = [&](const char* name, const RunReport& run) {
    PageText line = message_line(standing(name, run.report));
    if (line.tone == Tone::Good) line.tone = Tone::Plain;
    list.items.push_back(std::move(line));
    for (const std::string& warning : result_warnings(run.report))
      list.items.push_back({std::string(name) + ": " + warning, Tone::Caution});
  };
  add("before", found.before);
  if (found.after) add("after", *found.after);
  return list;
}

OrderedJson anchor_json(const std::optional<AnchorCheck>& anchor) {
  if (!anchor) return nullptr;
  return {{"same_branch", anchor->is_same_branch},
          {"message", anchor->message},
          {"back_mm", number_json(anchor->back)},
          {"here_mm", number_json(anchor->here)},
          {"travel_mm", number_json(anchor->travel)}};
}

}  // namespace

Table length_table(const ChordTuning& found) {
  const auto change = [](const TunedLength& length) { return length.after - length.before; };
  const auto slack = [](const TunedLength& length) { return length.is_slack ? "yes" : "no"; };
  const auto determined = [](const TunedLength& length) {
    return std::isnan(length.deviation) ? "" : length.is_determined ? "yes" : "no";
  };
  const auto remarks = [&](const TunedLength& length) {
    return remarks_on(length, found.determinacy.has_value());
  };
  return table_of<TunedLength>(
      found.lengths, {{text_column("name", "rest length"), &TunedLength::name},
                      {{"chords"}, &TunedLength::chords},
                      {{"before_mm", "before", "mm", 6, 4}, &TunedLength::before},
                      {{"after_mm", "after", "mm", 6, 4}, &TunedLength::after},
                      {{"change_mm", "change", "mm", 4, 4}, change},
                      {{"factor"}, &TunedLength::factor},
                      {{"low_mm"}, &TunedLength::low},
                      {{"high_mm"}, &TunedLength::high},
                      {text_column("bound"), bound_name},
                      {text_column("slack"), slack},
                      {{"extension_mm"}, &TunedLength::extension},
                      {{"standard_deviation_mm", "standard deviation", "mm"}, &TunedLength::deviation},
                      {text_column("determined"), determined},
                      {text_column("remarks"), remarks}});
}

std::string chord_tuning_json(const ChordTuning& found) {
  const Tuning& tuning = found.tuning;
  OrderedJson json = {
      {"version", version()},
      {"scene", found.scene_file},
      {"status", std::string(tuning_status_name(tuning.status))},
      {"converged", found.has_converged()},
      {"message", tuning.message},
      {"method", found.method},
      {"target", found.target.empty() ? OrderedJson(nullptr) : OrderedJson(found.target)},
      {"weights",
       {{"distance_per_mm2", found.distance_weight},
        {"orifice_per_mm2", found.orifice_weight},
        {"force_per_n", found.force_weight},
        {"change_per_mm2", found.change_weight}}},
      {"cost", {{"before", number_json(tuning.cost_before)}, {"after", number_json(tuning.cost_after)}}},
      {"rms_distance_mm",
       {{"before", number_json(found.misfit_before())}, {"after", number_json(found.misfit_after())}}},
      {"solves", found.solves},
      {"failed_solves", tuning.failed},
      {"lost_branches", tuning.lost_branches},
      {"anchor", anchor_json(tuning.anchor)},
      {"seconds", number_json(found.seconds)},
      {"tuned_scene", found.tuned_scene.empty() ? OrderedJson(nullptr) : OrderedJson(found.tuned_scene)},
      {"before", state_json(found.before)},
      {"after", found.after ? state_json(*found.after) : OrderedJson(nullptr)},
      {"lengths", OrderedJson::array()},
      {"noise_mm", found.noise},
      {"determined_mm", found.determined},
      {"explained_by_noise", found.determinacy ? OrderedJson(found.is_explained) : OrderedJson(nullptr)},
      {"undetermined", found.determinacy ? OrderedJson::array() : OrderedJson(nullptr)},
      {"spectrum", found.determinacy ? OrderedJson::array() : OrderedJson(nullptr)},
      {"metrics", metrics_json(found)},
      {"history", OrderedJson::array()}};
  for (const TunedLength& length : found.lengths) json["lengths"].push_back(length_json(length));
  if (found.determinacy) {
    for (const TunedLength& length : found.lengths)
      if (!length.is_determined) json["undetermined"].push_back(length.name);
    for (Eigen::Index k = 0; k < found.determinacy->singular_values.size(); ++k)
      json["spectrum"].push_back(direction_json(found, k));
  }
  int number = 1;
  for (const TuningTrial& trial : tuning.best.history)
    json["history"].push_back(trial_json(found, trial, ++number));
  return json_text(json, 2) + "\n";
}

std::string chord_tuning_page(const ChordTuning& found) {
  Page page{.title = "Chord lengths of " + found.scene_title};
  lead_with(page,
            spaced(tuning_status_name(found.tuning.status)) + ": cost " +
                page_number(found.tuning.cost_before) + " before, " + page_number(found.tuning.cost_after) +
                " after",
            standings(found), found.has_converged(), Tone::Caution);
  page.sections.push_back({"Tuning", {messages(found)}});
  std::vector<ComparedShape> shapes = {{"before", &found.before.model, &found.before.report}};
  if (found.after) shapes.push_back({"after", &found.after->model, &found.after->report});
  if (const auto view = compared_view(shapes, shapes.size() - 1, "tuning", "Before ↔ after"))
    page.sections.push_back({"Shapes", {shape_view_html(*view)}});
  if (!found.tuning.best.history.empty())
    page.sections.push_back({"Course of the tuning", {history_plot(found)}});
  page.sections.push_back({"Lengths", {page_lengths(found)}});
  if (found.determinacy)
    page.sections.push_back({"What the target determines", {spectrum_plot(found), spectrum_table(found)}});
  page.sections.push_back({"Figures", {figure_table(found)}});
  return report_page(page);
}

void write_chord_tuning(const ChordTuning& found) {
  write_study(found.folder, "tuning", OrderedJson::parse(chord_tuning_json(found)),
              without(length_table(found), {"change_mm", "remarks"}));
  formats::write_whole(found.folder / "tuning.html", chord_tuning_page(found));
}

}  // namespace coapt
