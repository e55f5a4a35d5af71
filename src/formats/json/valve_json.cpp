#include "formats/json/valve_json.hpp"

#include "core/error.hpp"
#include "formats/file_numbering.hpp"
#include "formats/json/detail/stated_laws.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/read_json.hpp"
#include "formats/json/units.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/rim_order.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace coapt {
namespace {

using Numbers = std::vector<int>;

// The file, its scale and the defects found so far.
class ValveReader {
 public:
  ValveReader(const Json& json, std::filesystem::path path) : json_(json), path_(std::move(path)) {}

  ValveFile read(ValveMeshes meshes) {
    if (!json_.is_object()) throw InputError(path_.string() + ": expected an object { ... }");
    read_scalars();
    for (const auto& [key, value] : json_.items()) keep_named(key, value);
    if (json_.contains("sets") && json_["sets"].is_object())
      for (const auto& [key, value] : json_["sets"].items()) keep_named(key, value);
    join_free_edges();
    fill_valve();
    read_chords();
    file_.valve.membranes = materials("membranes");
    file_.valve.cables = materials("cables");
    read_supports();
    keep_other_sets();
    if (meshes == ValveMeshes::Read) {
      read_meshes();
      read_tissue();
    }
    if (!defects_.empty()) throw InputError(defects_);
    return std::move(file_);
  }

 private:
  void refuse(const std::string& place, const std::string& reason) {
    constexpr size_t kMost = 20;
    if (defects_.size() < kMost) defects_.push_back(path_.string() + ": " + place + ": " + reason);
  }

  const Json* find(const std::string& key) const {
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }

  std::string text(const std::string& key) {
    const Json* value = find(key);
    if (value == nullptr) return "";
    if (value->is_string()) return value->get<std::string>();
    refuse(key, "expected a text");
    return "";
  }

  double finite_number(const Json& value, const std::string& place) {
    if (value.is_number()) return value.get<double>();
    refuse(place, "expected a number");
    return 0;
  }

  void read_scalars() {
    file_.valve.name = text("name");
    // Others add remarks: "m (by size: ...)"; the unit is the first word.
    const std::string units = text("units");
    if (!units.empty()) try {
        scale_ = unit_factor(units.substr(0, units.find(' ')), kLength);
      } catch (const InputError& error) {
        refuse("units", error.what());
      }
    if (const Json* thickness = find("leaflet_thickness_mm"))
      file_.valve.thickness = finite_number(*thickness, "leaflet_thickness_mm");
    if (const Json* thickness = find("leaflet_thickness"))
      file_.valve.thickness = scale_ * finite_number(*thickness, "leaflet_thickness");
    if (file_.valve.thickness < 0) refuse("leaflet_thickness", "is negative");
    const Json* pressure = find("pressure");
    if (pressure == nullptr || !pressure->is_object() || !pressure->contains("value")) return;
    try {
      const Json unit = pressure->value("unit", Json("MPa"));
      file_.valve.pressure = finite_number((*pressure)["value"], "pressure.value") *
                             unit_factor(unit.is_string() ? unit.get<std::string>() : "?", kPressure);
    } catch (const InputError& error) {
      refuse("pressure.unit", error.what());
    }
  }

  static bool is_number_list(const Json& value) {
    return value.is_array() && !value.empty() &&
           std::all_of(value.begin(), value.end(),
                       [](const Json& entry) { return entry.is_number_integer(); });
  }

  static bool is_point_list(const Json& value) {
    const auto is_point = [](const Json& entry) {
      return entry.is_array() && entry.size() == 3 && entry[0].is_number() && entry[1].is_number() &&
             entry[2].is_number();
    };
    return value.is_array() && !value.empty() && std::all_of(value.begin(), value.end(), is_point);
  }

  void keep_named(const std::string& key, const Json& value) {
    if (is_number_list(value)) {
      file_.sets[key] = node_numbers(value, key);
    } else if (is_point_list(value)) {
      Points points(3, static_cast<Eigen::Index>(value.size()));
      for (size_t k = 0; k < value.size(); ++k)
        for (int c = 0; c < 3; ++c) points(c, static_cast<int>(k)) = scale_ * value[k][c].get<double>();
      for (Eigen::Index k = 0; k < points.cols(); ++k)
        if (!(points.col(k).array().abs() <= kGreatestCoordinate).all())
          refuse(key + "[" + std::to_string(k) + "]", "a coordinate is greater than 1e9 mm");
      file_.points[key] = points;
    }
  }

  Numbers node_numbers(const Json& value, const std::string& key) {
    Numbers numbers;
    for (size_t k = 0; k < value.size(); ++k) {
      const double number = value[k].get<double>();
      if (number < 0 || number > 2147483647) {
        refuse(key + "[" + std::to_string(k) + "]",
               "read " + json_text(value[k]) + "; expected a number counted from 0");
        return {};
      }
      numbers.push_back(static_cast<int>(number));
    }
    return numbers;
  }

  void join_free_edges() {
    const Json* edges = find("free_edges");
    if (edges == nullptr || !edges->is_array() || file_.sets.contains("free_edge")) return;
    Numbers joined;
    for (const Json& part : *edges)
      if (is_number_list(part)) {
        const Numbers numbers = node_numbers(part, "free_edges");
        joined.insert(joined.end(), numbers.begin(), numbers.end());
      }
    if (!joined.empty()) file_.sets["free_edge"] = joined;
  }

  // A key that we use must have its form, or be absent, or empty.
  Numbers numbers_of(const std::string& key) {
    if (file_.sets.contains(key)) return file_.sets[key];
    const Json* value = find(key);
    if (value != nullptr && !(value->is_array() && value->empty()) && !is_point_list(*value))
      refuse(key, "expected a list of vertex numbers");
    return {};
  }

  Points points_of(const std::string& key) {
    if (file_.points.contains(key)) return file_.points[key];
    const Json* value = find(key);
    if (value != nullptr && !(value->is_array() && value->empty()))
      refuse(key, "expected a list of positions [x, y, z]");
    return Points(3, 0);
  }

  void fill_valve() {
    Valve& valve = file_.valve;
    valve.annulus = numbers_of("annulus");
    valve.free_edge = numbers_of("free_edge");
    valve.commissures = numbers_of("commissures");
    valve.annulus_closed = points_of("annulus_closed");
    ChordNetwork& chords = valve.chords;
    chords.papillary = points_of("papillary");
    chords.papillary_closed = points_of("papillary_closed");
    chords.junctions = points_of("junctions");
    const auto compare = [&](const std::string& key, Eigen::Index count, const std::string& other,
                             size_t wanted) {
      if (count != 0 && static_cast<size_t>(count) != wanted)
        refuse(key, "has " + std::to_string(count) + " positions, but " + other + " has " +
                        std::to_string(wanted));
    };
    compare("annulus_closed", valve.annulus_closed.cols(), "annulus", valve.annulus.size());
    compare("papillary_closed", chords.papillary_closed.cols(), "papillary",
            static_cast<size_t>(chords.papillary.cols()));
  }

  ChordEnd chord_end(const Json& chord, const std::string& key, const std::string& place) {
    ChordEnd end;
    const auto found = chord.find(key);
    const std::string where = place + "." + key;
    const bool is_end = found != chord.end() && found->is_object() && found->size() == 1 &&
                        found->begin()->is_number_integer();
    const std::string kind = is_end ? found->begin().key() : "";
    if (kind != "papillary" && kind != "junction" && kind != "leaflet") {
      refuse(where, "expected one of {\"papillary\": i}, {\"junction\": i}, {\"leaflet\": vertex}");
      return end;
    }
    const double index = found->begin()->get<double>();
    end.kind = kind == "papillary"  ? ChordEnd::Kind::Papillary
               : kind == "junction" ? ChordEnd::Kind::Junction
                                    : ChordEnd::Kind::Leaflet;
    const ChordNetwork& chords = file_.valve.chords;
    const double count = kind == "papillary"  ? static_cast<double>(chords.papillary.cols())
                         : kind == "junction" ? static_cast<double>(chords.junctions.cols())
                                              : 2147483647.0;
    if (index < 0 || index >= count) {
      refuse(where, kind + " " + json_text(*found->begin()) + " does not exist; the file has " +
                        std::to_string(static_cast<long>(count)) + ", counted from 0");
      return end;
    }
    end.index = static_cast<int>(index);
    return end;
  }

  void read_chords() {
    const Json* chords = find("chords");
    if (chords == nullptr) return;
    if (!chords->is_array()) return refuse("chords", "expected a list of chords");
    for (size_t k = 0; k < chords->size(); ++k) read_chord((*chords)[k], "chords[" + std::to_string(k) + "]");
  }

  void read_chord(const Json& json, const std::string& place) {
    if (!json.is_object()) return refuse(place, "expected an object with from, to, rest_length");
    Chord chord;
    chord.from = chord_end(json, "from", place);
    chord.to = chord_end(json, "to", place);
    if (chord.from.kind == chord.to.kind && chord.from.index == chord.to.index)
      refuse(place, "both ends are the same point");
    if (!json.contains("rest_length")) return refuse(place + ".rest_length", "missing");
    chord.rest_length = scale_ * finite_number(json["rest_length"], place + ".rest_length");
    if (json.contains("area")) chord.area = scale_ * scale_ * finite_number(json["area"], place + ".area");
    if (chord.rest_length < 0) refuse(place + ".rest_length", "is negative");
    if (chord.area < 0) refuse(place + ".area", "is negative");
    if (chord.rest_length > kGreatestCoordinate) refuse(place + ".rest_length", "is greater than 1e9 mm");
    if (chord.area > kGreatestCoordinate) refuse(place + ".area", "is greater than 1e9 mm^2");
    if (const auto material = json.find("material"); material != json.end() && material->is_string())
      chord.material = material->get<std::string>();
    if (const auto level = json.find("level"); level != json.end() && level->is_number_integer())
      chord.level = level->get<int>();
    file_.valve.chords.chords.push_back(std::move(chord));
  }

  std::map<std::string, Material> materials(const std::string& key) {
    std::map<std::string, Material> result;
    const Json* all = find(key);
    if (all == nullptr) return result;
    if (!all->is_object()) {
      refuse(key, "expected an object: a name and the keys of its law for each");
      return result;
    }
    for (const auto& [name, law] : all->items()) {
      if (!law.is_object() || !law.contains("type") || !law["type"].is_string()) {
        refuse(key + "." + name, "expected an object with a type, such as {\"type\": \"cst_stvk\", ...}");
        continue;
      }
      Material& material = result[name];
      material.type = law["type"].get<std::string>();
      for (const auto& [entry, value] : law.items())
        if (entry != "type") material.keys.emplace_back(entry, json_text(value));
    }
    return result;
  }

  void read_tissue() {
    detail::Remarks remarks;
    detail::read_stated_laws(json_, file_.valve, remarks);
    for (const std::string& warning : remarks.warnings)
      file_.warnings.push_back(path_.string() + ": " + warning);
    for (const std::string& defect : remarks.defects) defects_.push_back(path_.string() + ": " + defect);
  }

  // Its vertices are a set of its name, and where they go are positions of its name with "_closed".
  void read_supports() {
    const Json* all = find("supports");
    if (all == nullptr) return;
    if (!all->is_array()) return refuse("supports", "expected a list of supports");
    for (size_t k = 0; k < all->size(); ++k) {
      const Json& json = (*all)[k];
      const std::string place = "supports[" + std::to_string(k) + "]";
      if (!json.is_object() || !json.contains("name") || !json["name"].is_string()) {
        refuse(place, "expected an object with name and fix");
        continue;
      }
      Support support;
      support.name = json["name"].get<std::string>();
      if (file_.sets.contains(support.name))
        support.vertices = file_.sets[support.name];
      else
        refuse(place + ".name", "no set of vertices is named \"" + support.name + "\"");
      if (const auto found = file_.points.find(support.name + "_closed"); found != file_.points.end())
        support.closed = found->second;
      if (support.closed.cols() > 0 && support.closed.cols() != static_cast<int>(support.vertices.size()))
        refuse(place, "has " + std::to_string(support.closed.cols()) + " closed positions for " +
                          std::to_string(support.vertices.size()) + " vertices");
      if (json.contains("fix")) read_axes(json["fix"], place + ".fix", support.axes);
      file_.valve.supports.push_back(std::move(support));
    }
  }

  void read_axes(const Json& json, const std::string& place, std::array<bool, 3>& axes) {
    axes.fill(false);
    const auto is_axis = [](const Json& entry) { return entry == "x" || entry == "y" || entry == "z"; };
    if (!json.is_array() || json.empty() || !std::all_of(json.begin(), json.end(), is_axis))
      return refuse(place, "expected some of [\"x\", \"y\", \"z\"]");
    for (const Json& entry : json) axes[static_cast<size_t>(entry.get<std::string>()[0] - 'x')] = true;
  }

  // What is left of the object `sets` when the valve's own lists and the supports have taken theirs.
  void keep_other_sets() {
    for (const auto& [name, vertices] : file_.sets) {
      if (!json_.contains("sets") || !json_["sets"].is_object() || !json_["sets"].contains(name)) continue;
      const auto& supports = file_.valve.supports;
      if (std::none_of(supports.begin(), supports.end(),
                       [&name = name](const Support& s) { return s.name == name; }))
        file_.valve.sets[name] = vertices;
    }
  }

  TriangleMesh read_scaled(const std::string& key) {
    MeshFile read = read_mesh(path_.parent_path() / text(key));
    read.mesh.vertices *= scale_;
    file_.warnings.insert(file_.warnings.end(), read.warnings.begin(), read.warnings.end());
    return std::move(read.mesh);
  }

  // Each vertex keeps its closed position.
  void order_annulus() {
    Valve& valve = file_.valve;
    const RimLoop loop = rim_loop(valve.annulus, valve.leaflets.triangles);
    if (loop.spans_rims()) return refuse("annulus", spans_rims_text(loop.rims));
    if (!loop.is_reordered) return;
    if (valve.annulus_closed.cols() > 0) {
      std::map<int, Vec3> closed;
      for (size_t k = 0; k < valve.annulus.size(); ++k)
        closed[valve.annulus[k]] = valve.annulus_closed.col(static_cast<Eigen::Index>(k));
      for (size_t k = 0; k < loop.vertices.size(); ++k)
        valve.annulus_closed.col(static_cast<Eigen::Index>(k)) = closed[loop.vertices[k]];
      file_.points["annulus_closed"] = valve.annulus_closed;
    }
    valve.annulus = file_.sets["annulus"] = loop.vertices;
    file_.warnings.push_back(path_.string() + ": annulus: " + reordered_text());
  }

  void read_meshes() {
    try {
      if (find("leaflets") != nullptr) {
        file_.valve.leaflets = read_scaled("leaflets");
        file_.numbering = file_numbering(text("leaflets"));
        for (const std::string& defect :
             vertex_defects(file_, path_.string(), file_.valve.leaflets.vertex_count()))
          defects_.push_back(defect);
        if (defects_.empty()) order_annulus();
      }
      if (find("closed_reference") != nullptr) file_.valve.closed_reference = read_scaled("closed_reference");
    } catch (const InputError& error) {
      defects_.insert(defects_.end(), error.defects().begin(), error.defects().end());
    }
  }

  const Json& json_;
  std::filesystem::path path_;
  double scale_ = 1;  // mm per unit of the file
  ValveFile file_;
  std::vector<std::string> defects_;
};

}  // namespace

ValveFile read_valve(const std::filesystem::path& path, ValveMeshes meshes) {
  const Json json = read_json(path);
  return ValveReader(json, path).read(meshes);
}

}  // namespace coapt
