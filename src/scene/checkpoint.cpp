// A line of text, `coapt checkpoint FORMAT CHECKSUM`, then CBOR (RFC 8949).
#include "scene/checkpoint.hpp"

#include "core/error.hpp"
#include "mesh/formats/durable_file.hpp"
#include "mesh/formats/whole_file.hpp"
#include "scene/detail/read_json.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string_view>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMagic = "coapt checkpoint ";
constexpr std::string_view kFormat = "1";
constexpr const char* kBeginAnew = "; solve without --resume to begin anew";

// FNV-1a, 64 bits (Fowler, Noll and Vo): tells files apart, and finds damage that nobody intended.
class Fingerprint {
 public:
  void add(std::string_view bytes) {
    for (const char byte : bytes) hash_ = (hash_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  }
  std::string digits() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
    return text;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

std::string fingerprint(std::string_view bytes) {
  Fingerprint result;
  result.add(bytes);
  return result.digits();
}

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
  record.iterations = json.at("iterations").get<long>();
  record.seconds = json.at("seconds").get<double>();
  return record;
}

Json identity_json(const RunIdentity& identity) {
  Json json = {{"version", identity.version},
               {"scene", identity.scene},
               {"solver", identity.solver},
               {"tolerance", identity.tolerance}};
  if (identity.accuracy_mm) json["accuracy_mm"] = *identity.accuracy_mm;
  return json;
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::string text_of(const Json& value) {
  if (value.is_number()) return number_text(value.get<double>());
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
          "this one is to " + number_text(identity.tolerance) + ": give the same with --tolerance");
  compare("accuracy_mm", "to an accuracy [mm] of ", "give the same with --accuracy");
  return defects;
}

// The bytes after the line of text.
std::string_view checked_body(const std::string& file, std::string_view bytes) {
  const size_t end = bytes.find('\n');
  if (!bytes.starts_with(kMagic) || end == std::string_view::npos)
    throw InputError(file + ": is no checkpoint of coapt; name the file that was given to --checkpoint");
  const std::string_view line = bytes.substr(kMagic.size(), end - kMagic.size()),
                         body = bytes.substr(end + 1);
  const size_t space = line.find(' ');
  if (line.substr(0, space) != kFormat)
    throw InputError(file + ": is a checkpoint of format " +
                     std::string(line.substr(0, space).substr(0, 20)) + ", this version reads format " +
                     std::string(kFormat) + kBeginAnew);
  if (space == std::string_view::npos || line.substr(space + 1) != fingerprint(body))
    throw InputError(file + ": is damaged or cut off" + kBeginAnew);
  return body;
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

void write_checkpoint(const fs::path& path, const RunIdentity& identity, const RunRecord& record) {
  const Json json = {{"run", identity_json(identity)}, {"record", record_json(record)}};
  std::string body;
  Json::to_cbor(json, body);
  formats::write_durable(path,
                         std::string(kMagic) + std::string(kFormat) + " " + fingerprint(body) + "\n" + body);
}

RunRecord read_checkpoint(const fs::path& path, const RunIdentity& identity) {
  const std::string bytes = formats::read_whole(path), file = path.string();
  const std::string_view body = checked_body(file, bytes);
  std::vector<std::string> defects;
  RunRecord record;
  try {
    const Json json = Json::from_cbor(body);
    defects = differences(file, json.at("run"), identity);
    if (defects.empty()) record = record_of(json.at("record"));
  } catch (const std::exception& error) {  // of the library, or of a number that is none
    defects = {file + ": does not hold what a checkpoint holds (" + error.what() + ")" + kBeginAnew};
  }
  if (!defects.empty()) throw InputError(std::move(defects));
  return record;
}

}  // namespace coapt
