#include "core/error.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/read_json.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/mesh_io.hpp"
#include "formats/whole_file.hpp"

#include <cmath>

namespace coapt {
namespace {

OrderedJson positions(const Points& points) {
  OrderedJson list = OrderedJson::array();
  for (int k = 0; k < points.cols(); ++k) list.push_back({points(0, k), points(1, k), points(2, k)});
  return list;
}

OrderedJson end_of(const ChordEnd& end) {
  switch (end.kind) {
    case ChordEnd::Kind::Papillary:
      return {{"papillary", end.index}};
    case ChordEnd::Kind::Junction:
      return {{"junction", end.index}};
    case ChordEnd::Kind::Leaflet:
      break;
  }
  return {{"leaflet", end.index}};
}

OrderedJson chord_of(const Chord& chord) {
  OrderedJson json{{"from", end_of(chord.from)},
                   {"to", end_of(chord.to)},
                   {"rest_length", chord.rest_length},
                   {"area", chord.area}};
  if (!chord.material.empty()) json["material"] = chord.material;
  if (chord.level != 0) json["level"] = chord.level;
  return json;
}

OrderedJson materials_of(const std::map<std::string, Material>& materials) {
  OrderedJson json = OrderedJson::object();
  for (const auto& [name, material] : materials) {
    OrderedJson& law = json[name];
    law["type"] = material.type;
    for (const auto& [key, value] : material.keys) law[key] = OrderedJson::parse(value);
  }
  return json;
}

void add_supports(const Valve& valve, OrderedJson& json) {
  OrderedJson sets = OrderedJson::object(), supports = OrderedJson::array();
  for (const auto& [name, vertices] : valve.sets) sets[name] = vertices;
  for (const Support& support : valve.supports) {
    sets[support.name] = support.vertices;
    if (support.closed.cols() > 0) sets[support.name + "_closed"] = positions(support.closed);
    OrderedJson axes = OrderedJson::array();
    for (size_t c = 0; c < 3; ++c)
      if (support.axes[c]) axes.push_back(std::string(1, "xyz"[c]));
    supports.push_back({{"name", support.name}, {"fix", axes}});
  }
  if (!sets.empty()) json["sets"] = sets;
  if (!supports.empty()) json["supports"] = supports;
}

// JSON has no word for a number that is not finite: it would be written as null.
void refuse_bad_numbers(const std::filesystem::path& path, const Valve& valve) {
  std::vector<std::string> defects;
  const auto refuse = [&](const std::string& place, const std::string& reason) {
    constexpr size_t kMost = 20;
    if (defects.size() < kMost) defects.push_back(path.string() + ": not written: " + place + ": " + reason);
  };
  const auto check_points = [&](const std::string& name, const Points& points) {
    for (int k = 0; k < points.cols(); ++k)
      if (!(points.col(k).array().abs() <= kGreatestCoordinate).all())
        refuse(name + "[" + std::to_string(k) + "]", "a coordinate is not finite or greater than 1e9 mm");
  };
  const auto check_number = [&](const std::string& name, double value) {
    if (!std::isfinite(value)) refuse(name, "is not finite");
  };
  check_points("leaflets", valve.leaflets.vertices);
  if (valve.closed_reference) check_points("closed_reference", valve.closed_reference->vertices);
  check_points("annulus_closed", valve.annulus_closed);
  for (const Support& support : valve.supports) check_points(support.name + "_closed", support.closed);
  check_points("papillary", valve.chords.papillary);
  check_points("papillary_closed", valve.chords.papillary_closed);
  check_points("junctions", valve.chords.junctions);
  for (size_t k = 0; k < valve.chords.chords.size(); ++k) {
    check_number("chords[" + std::to_string(k) + "].rest_length", valve.chords.chords[k].rest_length);
    check_number("chords[" + std::to_string(k) + "].area", valve.chords.chords[k].area);
  }
  check_number("pressure", valve.pressure);
  check_number("leaflet_thickness", valve.thickness);
  if (!defects.empty()) throw InputError(defects);
}

// One entry of a long list per line: people compare such files.
std::string laid_out(const OrderedJson& json) {
  std::string text = "{";
  bool is_first = true;
  for (const auto& [key, value] : json.items()) {
    text += (is_first ? "\n  " : ",\n  ") + json_text(OrderedJson(key)) + ": ";
    is_first = false;
    if (!value.is_array() || value.empty() || !value[0].is_structured()) {
      text += json_text(value);
      continue;
    }
    for (size_t k = 0; k < value.size(); ++k) text += (k == 0 ? "[\n    " : ",\n    ") + json_text(value[k]);
    text += "\n  ]";
  }
  return text + "\n}\n";
}

}  // namespace

void write_valve(const std::filesystem::path& path, const Valve& valve) {
  refuse_bad_numbers(path, valve);
  OrderedJson json;
  if (!valve.name.empty()) json["name"] = valve.name;
  json["units"] = "mm";
  json["index_base"] = 0;
  if (valve.leaflets.triangle_count() > 0) {
    json["leaflets"] = "leaflets.obj";
    write_mesh(path.parent_path() / "leaflets.obj", valve.leaflets);
  }
  if (valve.closed_reference) {
    json["closed_reference"] = "closed_reference.obj";
    write_mesh(path.parent_path() / "closed_reference.obj", *valve.closed_reference);
  }
  if (valve.pressure > 0) json["pressure"] = {{"value", valve.pressure}, {"unit", "MPa"}};
  if (valve.thickness > 0) json["leaflet_thickness"] = valve.thickness;
  if (!valve.annulus.empty()) json["annulus"] = valve.annulus;
  if (valve.annulus_closed.cols() > 0) json["annulus_closed"] = positions(valve.annulus_closed);
  if (!valve.free_edge.empty()) json["free_edge"] = valve.free_edge;
  if (!valve.commissures.empty()) json["commissures"] = valve.commissures;
  add_supports(valve, json);
  if (!valve.membranes.empty()) json["membranes"] = materials_of(valve.membranes);
  if (!valve.cables.empty()) json["cables"] = materials_of(valve.cables);
  const ChordNetwork& chords = valve.chords;
  if (chords.papillary.cols() > 0) json["papillary"] = positions(chords.papillary);
  if (chords.papillary_closed.cols() > 0) json["papillary_closed"] = positions(chords.papillary_closed);
  if (chords.junctions.cols() > 0) json["junctions"] = positions(chords.junctions);
  if (!chords.chords.empty()) {
    OrderedJson list = OrderedJson::array();
    for (const Chord& chord : chords.chords) list.push_back(chord_of(chord));
    json["chords"] = list;
  }
  formats::write_whole(path, laid_out(json));
}

}  // namespace coapt
