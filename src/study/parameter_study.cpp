#include "study/parameter_study.hpp"

#include "core/components.hpp"
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/checksummed_cbor.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/suggestion.hpp"
#include "formats/text.hpp"
#include "formats/whole_file.hpp"
#include "results/study_files.hpp"
#include "scene/file/scene_text.hpp"
#include "solve/checkpoint.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace coapt {
namespace {

constexpr size_t kGreatestGrid = 100000;
constexpr int kUsualCount = 5;

InputError malformed(const std::string& sweep, const std::string& reason) {
  return InputError("--sweep: \"" + sweep + "\": " + reason +
                    "; write KEY=a..b, KEY=a..b:n or KEY=a,b,c, as in "
                    "ring.size=26..34mm:5");
}

// A number and the unit that follows it.
struct Amount {
  double value = 0;
  std::string unit;
};

Amount amount(const std::string& text, const std::string& sweep) {
  std::string word(formats::trimmed(text));
  // An exponent is part of the number, "e" alone begins a unit.
  size_t end = word.find_first_not_of("0123456789+-.");
  if (end != std::string::npos && (word[end] == 'e' || word[end] == 'E')) {
    const size_t after = word.find_first_not_of("0123456789", word.find_first_not_of("+-", end + 1));
    if (after != end + 1) end = after;
  }
  Amount found;
  const std::string number = word.substr(0, end);
  if (const auto reason = formats::read_number(number, found.value)) throw malformed(sweep, *reason);
  if (end != std::string::npos) found.unit = std::string(formats::trimmed(word.substr(end)));
  return found;
}

std::string text_of(double value, const std::string& unit) {
  return number_text(value, 12) + (unit.empty() ? "" : " " + unit);
}

std::vector<std::string> range(const std::string& text, size_t dots, const std::string& sweep) {
  long long count = kUsualCount;
  std::string upper = text.substr(dots + 2);
  if (const size_t colon = upper.rfind(':'); colon != std::string::npos) {
    if (const auto reason = formats::read_integer(upper.substr(colon + 1), count))
      throw malformed(sweep, *reason);
    if (count < 2 || count > static_cast<long long>(kGreatestGrid))
      throw malformed(sweep, "needs from 2 to " + std::to_string(kGreatestGrid) + " values");
    upper = upper.substr(0, colon);
  }
  const Amount from = amount(text.substr(0, dots), sweep), to = amount(upper, sweep);
  if (!from.unit.empty() && from.unit != to.unit) throw malformed(sweep, "has two units");
  if (from.value == to.value) throw malformed(sweep, "both ends are the same");
  std::vector<std::string> values;
  for (long long k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(count - 1);
    values.push_back(
        text_of(k + 1 == count ? to.value : from.value + part * (to.value - from.value), to.unit));
  }
  return values;
}

std::string described(const std::vector<Sweep>& sweeps, const std::vector<std::string>& values) {
  std::string text;
  for (size_t k = 0; k < sweeps.size(); ++k) text += (k == 0 ? "" : ", ") + sweeps[k].path + "=" + values[k];
  return text;
}

StudyPoint point_at(size_t number, const std::string& text, const std::filesystem::path& scene,
                    const std::vector<Sweep>& sweeps, const std::string& common_key) {
  StudyPoint point{number, {}, text, ""};
  size_t rest = number;
  for (size_t k = sweeps.size(); k-- > 0;) {
    point.values.insert(point.values.begin(), sweeps[k].values[rest % sweeps[k].values.size()]);
    rest /= sweeps[k].values.size();
  }
  for (size_t k = 0; k < sweeps.size(); ++k)
    point.scene = with_value(point.scene, sweeps[k].path, point.values[k], scene.string());
  try {
    parse_scene(point.scene, scene);
    point.key = common_key + "\n" + point.scene;
  } catch (const InputError& error) {
    std::vector<std::string> defects = error.defects();
    for (std::string& defect : defects) defect = described(sweeps, point.values) + ": " + defect;
    throw InputError(defects);
  }
  return point;
}

}  // namespace

Sweep parse_sweep(const std::string& text) {
  const size_t sign = text.find('=');
  if (sign == std::string::npos || sign == 0) throw malformed(text, "names no key");
  Sweep sweep{std::string(formats::trimmed(text.substr(0, sign))), {}};
  const std::string values = text.substr(sign + 1);
  if (const size_t dots = values.find(".."); dots != std::string::npos) {
    sweep.values = range(values, dots, text);
    return sweep;
  }
  std::vector<Amount> all;
  for (size_t from = 0; from != std::string::npos;) {
    const size_t comma = values.find(',', from);
    all.push_back(amount(values.substr(from, comma - from), text));
    from = comma == std::string::npos ? comma : comma + 1;
  }
  for (const Amount& one : all)
    sweep.values.push_back(text_of(one.value, one.unit.empty() ? all.back().unit : one.unit));
  return sweep;
}

std::vector<StudyPoint> study_points(const std::filesystem::path& scene, const std::vector<Sweep>& sweeps,
                                     const std::string& settings) {
  size_t count = 1;
  for (size_t k = 0; k < sweeps.size(); ++k) {
    for (size_t j = 0; j < k; ++j)
      if (sweeps[j].path == sweeps[k].path)
        throw InputError("--sweep: " + sweeps[k].path + " is swept twice");
    count *= sweeps[k].values.size();
    if (count > kGreatestGrid)
      throw InputError("--sweep: the grid has more than " + std::to_string(kGreatestGrid) + " points");
  }
  const std::string text = scene_text(scene);
  // Sweeps name no files: those are the same for every point.
  const std::string common_key = "version " + version() + ", " + settings + ", files " +
                                 named_files_fingerprint(text, scene.parent_path());
  std::vector<StudyPoint> points;
  for (size_t number = 0; number < count; ++number)
    points.push_back(point_at(number, text, scene, sweeps, common_key));
  return points;
}

std::optional<double> PointResult::metric(const std::string& name) const {
  for (const auto& [known, value] : metrics)
    if (known == name) return value;
  return std::nullopt;
}

PointResult point_result(const StudyPoint& point, const RunReport& run) {
  const Result& result = run.report.result;
  PointResult kept{point.number,
                   point.values,
                   point.key,
                   std::string(status_name(result.status)),
                   result.message,
                   result.residual,
                   result.iterations,
                   result.wall_s,
                   {},
                   {}};
  for (const MetricRow& row : metric_rows(run.report.metrics)) kept.metrics.emplace_back(row.name, row.value);
  kept.doubts = doubts(run.report);
  return kept;
}

Standing standing(const PointResult& result) {
  return {"point " + std::to_string(result.number), result.status, result.message, result.doubts};
}

PointResult refused_point(const StudyPoint& point, const std::string& message) {
  PointResult kept;
  kept.number = point.number;
  kept.values = point.values;
  kept.key = point.key;
  kept.status = "refused";
  kept.message = message;
  kept.residual = kNaN;
  return kept;
}

std::filesystem::path point_folder(const std::filesystem::path& study, size_t number) {
  char name[24];
  std::snprintf(name, sizeof name, "point_%04zu", number);
  return study / name;
}

void write_point(const std::filesystem::path& folder, const PointResult& result) {
  OrderedJson json = {{"number", result.number},
                      {"values", result.values},
                      {"key", result.key},
                      {"status", result.status},
                      {"message", result.message},
                      {"doubts", result.doubts},
                      {"residual", number_json(result.residual)},
                      {"iterations", result.iterations},
                      {"wall_s", number_json(result.wall_s)},
                      {"metrics", OrderedJson::object()}};
  for (const auto& [name, value] : result.metrics) json["metrics"][name] = number_json(value);
  formats::write_whole(folder / "point.json", json_text(json, 2) + "\n");
}

std::optional<PointResult> read_point(const std::filesystem::path& folder, const StudyPoint& point) {
  const std::filesystem::path file = folder / "point.json";
  std::error_code missing;
  if (!std::filesystem::is_regular_file(file, missing)) return std::nullopt;
  try {
    const OrderedJson json = OrderedJson::parse(formats::read_whole(file));
    if (json.at("key").get<std::string>() != point.key) return std::nullopt;
    const auto number = [](const OrderedJson& value) { return value.is_null() ? kNaN : value.get<double>(); };
    PointResult result{point.number,
                       point.values,
                       point.key,
                       json.at("status").get<std::string>(),
                       json.at("message").get<std::string>(),
                       number(json.at("residual")),
                       count_of(json.at("iterations").get<double>()),
                       number(json.at("wall_s")),
                       {},
                       json.at("doubts").get<std::vector<std::string>>()};
    for (const auto& [name, value] : json.at("metrics").items())
      result.metrics.emplace_back(name, value.is_null() ? std::nullopt : std::optional(value.get<double>()));
    return result;
  } catch (const std::exception&) {  // of the file, of the library, or of a number that is none
    return std::nullopt;
  }
}

bool ParameterStudy::has_converged() const {
  return results.size() == point_count &&
         std::all_of(results.begin(), results.end(), [](const PointResult& r) { return r.has_converged(); });
}

void check_metric(const std::string& name) {
  std::vector<std::string> names;
  for (const MetricRow& row : metric_rows(Metrics())) names.push_back(row.name);
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw InputError("--rank-by: \"" + name + "\" is no metric; there are: " + listed(names) +
                     suggestion(name, names));
}

std::vector<size_t> ranked(const ParameterStudy& study) {
  std::vector<size_t> places(study.results.size());
  std::iota(places.begin(), places.end(), size_t{0});
  const auto group = [&](size_t place) {
    const PointResult& result = study.results[place];
    if (!result.has_converged()) return 2;
    const std::optional<double> value = result.metric(study.metric);
    return value && std::isfinite(*value) ? 0 : 1;
  };
  std::stable_sort(places.begin(), places.end(), [&](size_t a, size_t b) {
    if (group(a) != group(b)) return group(a) < group(b);
    if (group(a) != 0) return false;
    const double x = *study.results[a].metric(study.metric), y = *study.results[b].metric(study.metric);
    return study.is_greatest_best ? x > y : x < y;
  });
  return places;
}

}  // namespace coapt
