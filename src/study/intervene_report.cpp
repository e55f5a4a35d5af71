#include "core/components.hpp"
#include "formats/json/json_text.hpp"
#include "formats/whole_file.hpp"
#include "report/compared_view.hpp"
#include "report/page_table.hpp"
#include "results/result_warnings.hpp"
#include "results/study_files.hpp"
#include "study/intervene.hpp"

#include <cmath>

namespace coapt {
namespace {

OrderedJson state_json(const std::optional<RunReport>& run) {
  if (!run) return nullptr;
  const Result& result = run->report.result;
  return {{"status", std::string(status_name(result.status))},
          {"converged", result.status == Status::Converged},
          {"message", result.message},
          {"doubts", doubts(run->report)},
          {"residual", number_json(result.residual)},
          {"iterations", result.iterations},
          {"wall_s", number_json(result.wall_s)},
          {"judge", run->report.metrics.intersection_checker},
          {"folder", run->folder.filename().string()},
          {"warnings", run->report.warnings}};
}

// "ring: size 30 mm, stiffness flexible"
std::string in_words(const std::string& intervention) {
  const OrderedJson json = OrderedJson::parse(intervention);
  const auto plain = [](const OrderedJson& value) {
    return value.is_string() ? value.get<std::string>() : json_text(value);
  };
  std::string text;
  for (const auto& [key, value] : json.items())
    if (key != "type") text += (text.empty() ? "" : ", ") + key + " " + plain(value);
  return json.contains("type") ? plain(json["type"]) + ": " + text : text;
}

PageList what_was_done(const BeforeAfter& found) {
  PageList list;
  for (const std::string& text : found.interventions) list.items.push_back({in_words(text)});
  return list;
}

PageList messages(const BeforeAfter& found) {
  PageList list;
  const auto add = [&](const char* name, const std::optional<RunReport>& run) {
    if (!run) return list.items.push_back({std::string(name) + ": not solved; it was cancelled", Tone::Bad});
    list.items.push_back(message_line(standing(name, run->report)));
    for (const std::string& warning : result_warnings(run->report))
      list.items.push_back({std::string(name) + ": " + warning, Tone::Caution});
  };
  add("before", found.before);
  add("after", found.after);
  return list;
}

}  // namespace

std::string intervene_json(const BeforeAfter& found) {
  OrderedJson json = {{"version", version()},
                      {"scene", found.scene_file},
                      {"converged", found.has_converged()},
                      {"interventions", OrderedJson::array()},
                      {"before", state_json(found.before)},
                      {"after", state_json(found.after)},
                      {"figures", OrderedJson::object()}};
  for (const std::string& text : found.interventions)
    json["interventions"].push_back(OrderedJson::parse(text));
  for (const ChangedFigure& figure : changed_figures(found))
    json["figures"][figure.before.name] = {{"unit", figure.before.unit},
                                           {"before", number_json(figure.before.value)},
                                           {"after", number_json(figure.after)},
                                           {"change", number_json(figure.change)}};
  return json_text(json, 2) + "\n";
}

std::string intervene_page(const BeforeAfter& found) {
  Page page{.title = "Before and after: " + found.scene_title};
  std::vector<Standing> states;
  if (found.before) states.push_back(standing("before", found.before->report));
  if (found.after) states.push_back(standing("after", found.after->report));
  lead_with(page, found.has_converged() ? "both states converged" : "not both states converged", states,
            found.has_converged());
  page.sections.push_back({"Interventions", {what_was_done(found), messages(found)}});
  std::vector<ComparedShape> shapes;
  if (found.before) shapes.push_back({"before", &found.before->model, &found.before->report});
  if (found.after) shapes.push_back({"after", &found.after->model, &found.after->report});
  if (!shapes.empty())
    if (const auto view = compared_view(shapes, shapes.size() - 1, "intervention", "Before ↔ after"))
      page.sections.push_back({"Shapes", {shape_view_html(*view)}});
  page.sections.push_back({"Figures", {change_page_table(changed_figures(found))}});
  return report_page(page);
}

void write_intervene(const BeforeAfter& found) {
  write_study(found.folder, "intervene", OrderedJson::parse(intervene_json(found)),
              change_table(changed_figures(found)));
  formats::write_whole(found.folder / "intervene.html", intervene_page(found));
}

}  // namespace coapt
