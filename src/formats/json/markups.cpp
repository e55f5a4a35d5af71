#include "formats/json/markups.hpp"

#include "core/error.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/read_json.hpp"
#include "formats/json/units.hpp"
#include "formats/lower_extension.hpp"
#include "formats/valve.hpp"
#include "formats/whole_file.hpp"

#include <cmath>

namespace coapt {
namespace {

constexpr const char* kSchema =
    "https://raw.githubusercontent.com/slicer/slicer/master/Modules/Loadable/Markups/Resources/Schema/"
    "markups-schema-v1.0.0.json#";

class MarkupReader {
 public:
  explicit MarkupReader(std::filesystem::path path) : path_(std::move(path)) {}

  std::vector<Markup> read() {
    const Json json = read_json(path_);
    if (!json.is_object() || !json.contains("markups") || !json["markups"].is_array())
      throw InputError(path_.string() + ": markups: missing; is this a markups file of 3D Slicer?");
    std::vector<Markup> markups;
    for (size_t k = 0; k < json["markups"].size(); ++k)
      markups.push_back(markup(json["markups"][k], "markups[" + std::to_string(k) + "]"));
    if (!defects_.empty()) throw InputError(defects_);
    return markups;
  }

 private:
  void refuse(const std::string& place, const std::string& reason) {
    constexpr size_t kMost = 20;
    if (defects_.size() < kMost) defects_.push_back(path_.string() + ": " + place + ": " + reason);
  }

  static std::string text(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? found->get<std::string>() : "";
  }

  // +1 for LPS, -1 for RAS: of x and y.
  double sign(const Json& json, const std::string& place) {
    const auto found = json.find("coordinateSystem");
    if (found == json.end() || *found == "LPS" || *found == 1 || *found == "1") return 1;
    if (*found == "RAS" || *found == 0 || *found == "0") return -1;
    refuse(place + ".coordinateSystem", "read " + json_text(*found) + "; expected \"LPS\" or \"RAS\"");
    return 1;
  }

  double scale(const Json& json, const std::string& place) {
    const auto found = json.find("coordinateUnits");
    if (found == json.end()) return 1;
    const std::string unit = found->is_array() && !found->empty() && (*found)[0].is_string()
                                 ? (*found)[0].get<std::string>()  // a coded entry: symbol first
                             : found->is_string() ? found->get<std::string>()
                                                  : "?";
    try {
      return unit_factor(unit, kLength);
    } catch (const InputError& error) {
      refuse(place + ".coordinateUnits", error.what());
      return 1;
    }
  }

  Markup markup(const Json& json, const std::string& place) {
    Markup result;
    if (!json.is_object()) {
      refuse(place, "expected an object with type and controlPoints");
      return result;
    }
    result.type = text(json, "type");
    result.name = text(json, "name");
    const double turn = sign(json, place), unit = scale(json, place);
    const auto points = json.find("controlPoints");
    if (points == json.end()) return result;
    if (!points->is_array()) {
      refuse(place + ".controlPoints", "expected a list of points");
      return result;
    }
    std::vector<Vec3> positions;
    for (size_t k = 0; k < points->size(); ++k) {
      const Json& point = (*points)[k];
      const std::string status = point.is_object() ? text(point, "positionStatus") : "";
      if (!status.empty() && status != "defined") continue;  // undefined, preview, missing
      const std::string where = place + ".controlPoints[" + std::to_string(k) + "].position";
      const bool fits = point.is_object() && point.contains("position") && point["position"].is_array() &&
                        point["position"].size() == 3 && point["position"][0].is_number() &&
                        point["position"][1].is_number() && point["position"][2].is_number();
      if (!fits) {
        refuse(where, "expected three numbers");
        continue;
      }
      const Json& x = point["position"];
      const Vec3 position =
          unit * Vec3(turn * x[0].get<double>(), turn * x[1].get<double>(), x[2].get<double>());
      if (!(position.array().abs() <= kGreatestCoordinate).all()) {
        refuse(where, "read " + json_text(x) + "; a coordinate is greater than 1e9 mm");
        continue;
      }
      positions.push_back(position);
      result.labels.push_back(text(point, "label"));
    }
    result.points.resize(3, static_cast<Eigen::Index>(positions.size()));
    for (size_t k = 0; k < positions.size(); ++k)
      result.points.col(static_cast<Eigen::Index>(k)) = positions[k];
    return result;
  }

  std::filesystem::path path_;
  std::vector<std::string> defects_;
};

}  // namespace

bool is_markup_file(const std::filesystem::path& path) {
  return formats::lower_extension(path) == ".json" && formats::lower_extension(path.stem()) == ".mrk";
}

std::vector<Markup> read_markups(const std::filesystem::path& path) { return MarkupReader(path).read(); }

void write_markups(const std::filesystem::path& path, const std::vector<Markup>& markups) {
  OrderedJson list = OrderedJson::array();
  for (const Markup& markup : markups) {
    OrderedJson points = OrderedJson::array();
    for (int k = 0; k < markup.points.cols(); ++k) {
      const std::string label = markup.labels.empty() ? markup.name + "-" + std::to_string(k + 1)
                                                      : markup.labels[static_cast<size_t>(k)];
      points.push_back({{"id", std::to_string(k + 1)},
                        {"label", label},
                        {"position", {markup.points(0, k), markup.points(1, k), markup.points(2, k)}},
                        {"positionStatus", "defined"}});
    }
    list.push_back({{"type", markup.type},
                    {"name", markup.name},
                    {"coordinateSystem", "LPS"},
                    {"coordinateUnits", "mm"},
                    {"controlPoints", points}});
  }
  const OrderedJson json{{"@schema", kSchema}, {"markups", list}};
  formats::write_whole(path, json_text(json, 1) + "\n");
}

Points annulus_curve(const std::filesystem::path& path) {
  const std::vector<Markup> markups = read_markups(path);
  for (const char* type : {"ClosedCurve", "Curve", "Fiducial"})
    for (const Markup& markup : markups)
      if (markup.type == type && markup.points.cols() >= 3) {
        if ((markup.points.colwise() - Vec3(markup.points.col(0))).isZero(0))
          throw InputError(path.string() + ": all points of the curve" +
                           (markup.name.empty() ? "" : " \"" + markup.name + "\"") +
                           " are the same; it has no length");
        return markup.points;
      }
  throw InputError(path.string() + ": holds no closed curve of at least three points");
}

Points papillary_points(const std::filesystem::path& path) {
  Points points(3, 0);
  for (const Markup& markup : read_markups(path)) {
    if (markup.type != "Fiducial" && markup.type != "PointList") continue;
    points.conservativeResize(3, points.cols() + markup.points.cols());
    points.rightCols(markup.points.cols()) = markup.points;
  }
  if (points.cols() == 0)
    throw InputError(path.string() + ": holds no points; it must be a list of points (of type Fiducial)");
  return points;
}

}  // namespace coapt
