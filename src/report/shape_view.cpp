#include "report/shape_view.hpp"

#include "formats/json/base64.hpp"
#include "formats/json/json_text.hpp"
#include "formats/xml_escaped.hpp"
#include "report/detail/report_files.hpp"
#include "report/detail/slider_json.hpp"

#include <algorithm>

namespace coapt {
namespace {

template <class Numbers>
std::string floats(const Numbers& numbers) {
  const Eigen::MatrixXf singles = numbers.template cast<float>();
  return base64(std::span<const float>(singles.data(), static_cast<size_t>(singles.size())));
}

template <class Indices>
std::string integers(const Indices& indices) {
  const Eigen::Matrix<std::uint32_t, -1, -1> words = indices.template cast<std::uint32_t>();
  return base64(std::span<const std::uint32_t>(words.data(), static_cast<size_t>(words.size())));
}

OrderedJson numbers(const Vec3& v) { return {v[0], v[1], v[2]}; }

std::string_view place_name(ViewPlace place) {
  switch (place) {
    case ViewPlace::Vertex:
      return "vertex";
    case ViewPlace::Triangle:
      return "triangle";
    case ViewPlace::Line:
      return "line";
  }
  return "";
}

OrderedJson field_json(const ViewField& field) {
  OrderedJson values = OrderedJson::array();
  for (const Vector& state : field.values) {
    OrderedJson text = state.size() > 0 ? OrderedJson(floats(state)) : OrderedJson(nullptr);
    // Values that an earlier state has, as regions do, are named by its number.
    const auto same = std::find(values.begin(), values.end(), text);
    values.push_back(text.is_null() || same == values.end() ? std::move(text)
                                                            : OrderedJson(same - values.begin()));
  }
  OrderedJson json = {
      {"title", field.title}, {"unit", field.unit}, {"at", place_name(field.place)}, {"values", values}};
  if (!field.categories.empty()) json["categories"] = field.categories;
  if (field.is_reversed) json["map"] = "reversed";
  if (!field.none.empty()) json["none"] = field.none;
  return json;
}

OrderedJson state_json(const ViewState& state) {
  OrderedJson outlines = OrderedJson::array();
  for (const ViewOutline& outline : state.outlines)
    outlines.push_back(
        {{"kind", outline.is_orifice ? "orifice" : "coaptation"}, {"points", floats(outline.points)}});
  return {{"label", state.label},
          {"nodes", floats(state.x)},
          {"carried", state.is_history},
          {"outlines", outlines},
          {"orifice_text", state.orifice_text}};
}

OrderedJson view_json(const ShapeView& view) {
  OrderedJson states = OrderedJson::array(), sequences = OrderedJson::array(), fields = OrderedJson::array(),
              line_values = OrderedJson::array();
  for (const ViewState& state : view.states) {
    OrderedJson json = state_json(state);
    // Nodes that an earlier state has, as the start of every method does, are named by its number.
    const auto same = std::find_if(states.begin(), states.end(), [&json](const OrderedJson& earlier) {
      return earlier.at("nodes") == json.at("nodes");
    });
    if (same != states.end()) json["nodes"] = same - states.begin();
    states.push_back(std::move(json));
  }
  for (const ViewSequence& sequence : view.sequences)
    sequences.push_back({{"label", sequence.label}, {"states", sequence.state_count}});
  for (const ViewField& field : view.fields) fields.push_back(field_json(field));
  for (const ViewField& field : view.line_values) line_values.push_back(field_json(field));
  return {{"name", view.name},
          {"origin", numbers(view.origin)},
          {"frame",
           {{"right", numbers(view.frame.e1)},
            {"up", numbers(view.frame.e2)},
            {"towards", numbers(view.frame.up)}}},
          {"triangles", integers(view.triangles)},
          {"lines", integers(view.lines)},
          {"obstacles", integers(view.obstacles)},
          {"states", states},
          {"sequences", sequences},
          {"fields", fields},
          {"pair", view.is_pair && view.states.size() == 2},
          {"sliders", view.first_order ? sliders_json(*view.first_order) : OrderedJson(nullptr)},
          {"line_force", view.line_force ? field_json(*view.line_force) : OrderedJson(nullptr)},
          {"line_values", line_values}};
}

void replace(std::string& text, std::string_view mark, std::string_view by) {
  const size_t at = text.find(mark);
  if (at != std::string::npos) text.replace(at, mark.size(), by);
}

std::string script(std::string_view text) { return "<script>\n" + std::string(text) + "\n</script>\n"; }

}  // namespace

bool has_shape_view() { return !report_files::three.empty(); }

PageMarkup shape_view_html(const ShapeView& view) {
  namespace files = report_files;
  if (!has_shape_view())
    return {
        "<p class=\"quiet\">This build of coapt has no 3-D view (three.js was not found, or was turned off, "
        "when it was configured): the shape is left out. closed.vtp holds it.</p>\n"};
  std::string markup(files::viewer_markup);
  replace(markup, "@ABOVE@", view.is_valve ? "From the atrium" : "From above");
  replace(markup, "@BELOW@", view.is_valve ? "From the ventricle" : "From below");
  replace(markup, "@SLIDER@", formats::xml_escaped(view.slider));
  std::string html = "<style>\n" + std::string(files::viewer_style) + "</style>\n" + markup;
  html += "<noscript>The shape needs scripts. Figures and plots do not.</noscript>\n";
  html +=
      "<script type=\"application/json\" id=\"shape-data\">" + script_text(view_json(view)) + "</script>\n";
  html += "<details><summary>Licence of three.js, which draws the shape</summary><pre>" +
          formats::xml_escaped(files::three_notice) + "</pre></details>\n";
  html += script(files::three) + script(files::three_controls);
  std::string own = "\"use strict\";\n{\n";
  for (const std::string_view part :
       {files::viewer_base, files::viewer_stage, files::viewer_parts, files::viewer_values,
        files::viewer_screenshot, files::viewer_sliders, files::viewer_controls})
    own += part;
  html += script(own + "}");
  return {html};
}

}  // namespace coapt
