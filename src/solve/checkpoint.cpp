#include "solve/checkpoint.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/checksummed_cbor.hpp"
#include "formats/whole_file.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBeginAnew = "; solve without --resume to begin anew";
constexpr Seal kSeal = {"coapt checkpoint", "checkpoint of coapt", "1", kBeginAnew};

void add_named_files(const Json& json, const fs::path& folder, Fingerprint& result) {
  if (json.is_structured()) {
    for (const Json& item : json) add_named_files(item, folder, result);
  } else if (json.is_string()) {
    std::error_code error;
    const fs::path file = folder / json.get_ref<const std::string&>();
    if (fs::is_regular_file(file, error)) result.add(fingerprint(formats::read_whole(file)));
  }
}

std::vector<double> numbers(const Eigen::Ref<const Vector>& values) { return {values.begin(), values.end()}; }

Vector vector_of(const Json& json) {
  const auto values = json.get<std::vector<double>>();
  return Eigen::Map<const Vector>(values.data(), std::ssize(values));
}

constexpr std::array kStatuses = {Status::Converged, Status::IterationLimit,   Status::TimeLimit,
                                  Status::Stalled,   Status::LineSearchFailed, Status::NonFinite,
                                  Status::Cancelled, Status::NoEquilibrium};

Json end_json(const MinimisationEnd& end) {
  return {{"x", numbers(end.x.reshaped())},
          {"status", status_name(end.status)},
          {"is_at_rest", end.is_at_rest},
          {"remark", end.remark}};
}

MinimisationEnd end_of(const Json& json) {
  MinimisationEnd end;
  const Vector x = vector_of(json.at("x"));
  if (x.size() % 3 != 0 || !x.allFinite()) throw std::domain_error("positions that are none");
  end.x = x.reshaped(3, x.size() / 3);
  const auto name = json.at("status").get<std::string>();
  const auto* status = std::find_if(kStatuses.begin(), kStatuses.end(),
                                    [&](Status known) { return status_name(known) == name; });
  if (status == kStatuses.end()) throw std::domain_error("the status \"" + name + "\"");
  end.status = *status;
  end.is_at_rest = json.at("is_at_rest").get<bool>();
  end.remark = json.at("remark").get<std::string>();
  return end;
}

Json record_json(const RunRecord& record) {
  Json ends = Json::array();
  for (const MinimisationEnd& end : record.ends) ends.push_back(end_json(end));
  return {{"ends", ends},
          {"iterate", numbers(record.iterate)},
          {"iterations", record.iterations},
          {"seconds", record.seconds}};
}

RunRecord record_of(const Json& json) {
  RunRecord record;
  for (const Json& end : json.at("ends")) record.ends.push_back(end_of(end));
  record.iterate = vector_of(json.at("iterate"));
  if (!record.iterate.allFinite()) throw std::domain_error("positions that are none");
  record.iterations = count_of(json.at("iterations").get<double>());
  record.seconds = seconds_of(json.at("seconds").get<double>());
  return record;
}

Json identity_json(const RunIdentity& identity) {
  Json json = {{"version", identity.version},
               {"scene", identity.scene},
               {"solver", identity.solver},
               {"tolerance", identity.tolerance}};
  if (identity.accuracy_mm) json["accuracy_mm"] = *identity.accuracy_mm;
  if (identity.damped_steps > 0) json["damped_steps"] = identity.damped_steps;
  return json;
}

std::string text_of(const Json& value) {
  if (value.is_number()) return number_text(value.get<double>(), 6);
  return value.is_string() ? value.get<std::string>() : value.is_null() ? "none" : "something else";
}

// What differs, each with a remedy.
std::vector<std::string> differences(const std::string& file, const Json& known,
                                     const RunIdentity& identity) {
  const Json own = identity_json(identity);
  const auto value = [](const Json& json, const char* key) {
    return json.contains(key) ? json[key] : Json();
  };
  std::vector<std::string> defects;
  const auto compare = [&](const char* key, const std::string& what, const std::string& remedy) {
    const Json there = value(known, key), here = value(own, key);
    if (there != here) defects.push_back(file + ": is of a run " + what + text_of(there) + "; " + remedy);
  };
  if (value(known, "scene") != value(own, "scene"))
    defects.push_back(file + ": is of another scene, or the scene or a file that it names has changed since" +
                      kBeginAnew);
  compare("version", "of coapt ", "this is " + identity.version + kBeginAnew);
  compare("solver", "by the solver ", "this one is by " + identity.solver + ": give the same with --solver");
  compare("tolerance", "to the tolerance ",
          "this one is to " + number_text(identity.tolerance, 6) + ": give the same with --tolerance");
  compare("accuracy_mm", "to an accuracy [mm] of ", "give the same with --accuracy");
  compare("damped_steps", "whose damped steps were ", "give the same with --damped-steps");
  return defects;
}

}  // namespace

std::string scene_fingerprint(const Scene& scene) {
  Json json = read_json(scene.file);
  for (const char* key : {"$schema", "name", "output", "reference"}) json.erase(key);
  if (const auto solver = json.find("solver"); solver != json.end() && solver->is_object())
    for (const char* key : {"type", "tolerance", "max_seconds", "threads", "certificate"}) solver->erase(key);
  Fingerprint result;
  result.add(json.dump(-1, ' ', false, Json::error_handler_t::replace));
  add_named_files(json, scene.file.parent_path(), result);
  return result.digits();
}

std::string named_files_fingerprint(const std::string& scene, const fs::path& folder) {
  Fingerprint result;
  add_named_files(parse_json(scene, folder.string()), folder, result);
  return result.digits();
}

void write_checkpoint(const fs::path& path, const RunIdentity& identity, const RunRecord& record) {
  write_sealed(path, kSeal, {{"run", identity_json(identity)}, {"record", record_json(record)}});
}

RunRecord read_checkpoint(const fs::path& path, const RunIdentity& identity) {
  const std::string file = path.string();
  const Json json = read_sealed(path, kSeal);
  std::vector<std::string> defects;
  RunRecord record;
  try {
    defects = differences(file, json.at("run"), identity);
    if (defects.empty()) record = record_of(json.at("record"));
  } catch (const std::exception& error) {  // of the library, or of a number that is none
    defects = {file + ": does not hold what a checkpoint holds (" + error.what() + ")" + kBeginAnew};
  }
  if (!defects.empty()) throw InputError(std::move(defects));
  return record;
}

}  // namespace coapt
