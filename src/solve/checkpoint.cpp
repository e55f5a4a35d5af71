#include "solve/checkpoint.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/checksummed_cbor.hpp"
#include "formats/json/named_files.hpp"
#include "formats/whole_file.hpp"
#include "solve/resumable_record.hpp"

#include <stdexcept>

namespace coapt {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBeginAnew = "solve without --resume to begin anew";
constexpr Seal kSeal = {"coapt checkpoint", "checkpoint of coapt", "3",
                        "; solve without --resume to begin anew"};

void add_named_files(const Json& json, const fs::path& folder, Fingerprint& result) {
  for (const fs::path& file : named_files(json, folder)) result.add(fingerprint(formats::read_whole(file)));
}

Json end_json(const MinimisationEnd& end) {
  return {{"x", numbers_of(end.x.reshaped())},
          {"status", status_name(end.status)},
          {"is_at_rest", end.is_at_rest},
          {"remark", end.remark}};
}

MinimisationEnd end_of(const Json& json) {
  MinimisationEnd end;
  end.x = points_of(json.at("x"));
  end.status = status_of(json.at("status"));
  end.is_at_rest = json.at("is_at_rest").get<bool>();
  end.remark = json.at("remark").get<std::string>();
  return end;
}

Json order_json(const KeptOrder& order) {
  const EliminationOrder& found = order.found();
  return {{"nodes", found.order},
          {"first_columns", found.first},
          {"parents", found.parent},
          {"entries", order.entries()}};
}

// At least `least`.
std::vector<int> counts_of(const Json& json, int least) {
  std::vector<int> counts;
  for (const Json& value : json) counts.push_back(count_of(value.get<double>() - least) + least);
  return counts;
}

KeptOrder order_of(const Json& json) {
  const EliminationOrder found{counts_of(json.at("nodes"), 0), counts_of(json.at("first_columns"), 0),
                               counts_of(json.at("parents"), -1)};
  const auto nodes = static_cast<double>(found.order.size()), entries = json.at("entries").get<double>();
  if (!found.is_consistent() || !(entries >= 0 && entries <= nodes * nodes))
    throw std::domain_error("an order of elimination that is none");
  return {found, entries};
}

Json record_json(const RunRecord& record) {
  Json ends = Json::array();
  for (const MinimisationEnd& end : record.ends) ends.push_back(end_json(end));
  return {{"ends", ends},
          {"order", order_json(record.order)},
          {"iterate", numbers_of(record.iterate)},
          {"iterations", record.iterations},
          {"seconds", record.seconds}};
}

RunRecord record_of(const Json& json) {
  RunRecord record;
  for (const Json& end : json.at("ends")) record.ends.push_back(end_of(end));
  record.order = order_of(json.at("order"));
  record.iterate = vector_of(json.at("iterate"));
  record.iterations = count_of(json.at("iterations").get<double>());
  record.seconds = seconds_of(json.at("seconds").get<double>());
  return record;
}

Identity items(const RunIdentity& run) {
  return {{"scene", run.scene, kBeginAnew, true},
          {"version", "coapt " + run.version, kBeginAnew},
          {"solver", run.solver, "give the same with --solver"},
          {"tolerance", exact_text(run.tolerance), "give the same with --tolerance"},
          {"accuracy in mm", run.accuracy_mm ? exact_text(*run.accuracy_mm) : "",
           "give the same with --accuracy"},
          {"number of damped steps", run.damped_steps > 0 ? std::to_string(run.damped_steps) : "",
           "give the same with --damped-steps"}};
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
  write_record(path, kSeal, items(identity), record_json(record));
}

RunRecord read_checkpoint(const fs::path& path, const RunIdentity& identity) {
  RunRecord record;
  read_record(path, kSeal, items(identity), [&](const Json& json) { record = record_of(json); });
  return record;
}

}  // namespace coapt
