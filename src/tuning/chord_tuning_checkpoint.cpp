#include "core/components.hpp"
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/checksummed_cbor.hpp"
#include "formats/whole_file.hpp"
#include "solve/checkpoint.hpp"
#include "tuning/chord_tuning.hpp"
#include "tuning/chord_tuning_goal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace coapt {
namespace {

constexpr const char* kBeginAnew = "; tune without --resume to begin anew";
constexpr Seal kSeal = {"coapt tuning", "checkpoint of a tuning", "1", kBeginAnew};

std::vector<double> numbers(const Eigen::Ref<const Vector>& values) { return {values.begin(), values.end()}; }

Vector vector_of(const Json& json) {
  const auto values = json.get<std::vector<double>>();
  Vector vector = Eigen::Map<const Vector>(values.data(), std::ssize(values));
  if (!vector.allFinite()) throw std::domain_error("numbers that are not finite");
  return vector;
}

constexpr std::array kStatuses = {Status::Converged, Status::IterationLimit,   Status::TimeLimit,
                                  Status::Stalled,   Status::LineSearchFailed, Status::NonFinite,
                                  Status::Cancelled, Status::NoEquilibrium};

Json trial_json(const TuningTrial& trial) {
  Json json = {{"value", numbers(trial.value)}, {"status", status_name(trial.status)},
               {"metrics", trial.metrics},      {"iterations", trial.iterations},
               {"is_best", trial.is_best},      {"is_aided", trial.is_aided},
               {"seconds", trial.seconds}};
  if (std::isfinite(trial.cost)) json["cost"] = trial.cost;
  if (std::isfinite(trial.misfit)) json["misfit"] = trial.misfit;
  if (trial.lost_branch)
    json["lost_branch"] = {trial.lost_branch->distance, trial.lost_branch->jump,
                           trial.lost_branch->negative_before, trial.lost_branch->negative_after};
  return json;
}

TuningTrial trial_of(const Json& json) {
  TuningTrial trial;
  trial.value = vector_of(json.at("value"));
  const auto name = json.at("status").get<std::string>();
  const auto* status = std::find_if(kStatuses.begin(), kStatuses.end(),
                                    [&](Status known) { return status_name(known) == name; });
  if (status == kStatuses.end()) throw std::domain_error("the status \"" + name + "\"");
  trial.status = *status;
  trial.metrics = json.at("metrics").get<std::vector<double>>();
  trial.iterations = count_of(json.at("iterations").get<double>());
  trial.is_best = json.at("is_best").get<bool>();
  trial.is_aided = json.at("is_aided").get<bool>();
  trial.seconds = seconds_of(json.at("seconds").get<double>());
  trial.cost = json.value("cost", kInfinity);
  trial.misfit = json.value("misfit", kNaN);
  if (const auto lost = json.find("lost_branch"); lost != json.end())
    trial.lost_branch = LostBranch{lost->at(0).get<double>(), lost->at(1).get<double>(),
                                   count_of(lost->at(2).get<double>()), count_of(lost->at(3).get<double>())};
  return trial;
}

}  // namespace

std::map<std::string, std::string> chord_tuning_identity(const Scene& scene,
                                                         const ChordTuningOptions& options,
                                                         const RunOptions& run) {
  std::string only, target;
  for (const std::string& name : options.only) only += name + "\n";
  const std::filesystem::path file =
      options.target.empty() ? scene.closed_surface.value_or(std::filesystem::path()) : options.target;
  if (distance_weight_of(options) > 0 && !file.empty())
    target = fingerprint(formats::read_whole(file)) + " times " + number_text(options.target_scale, 17);
  return {{"version", version()},
          {"scene", scene_fingerprint(scene)},
          {"damped steps", std::to_string(run.damped_steps.value_or(scene.solver.continuation.damped_steps))},
          {"tolerance", number_text(run.tolerance.value_or(scene.solver.tolerance), 17)},
          {"target", target},
          {"distance weight", number_text(distance_weight_of(options), 17)},
          {"orifice weight", number_text(options.orifice_weight, 17)},
          {"force weight", number_text(options.force_weight, 17)},
          {"change weight", number_text(change_weight_of(options), 17)},
          {"sides", std::to_string(static_cast<int>(options.sides))},
          {"groups", std::to_string(static_cast<int>(options.grouping)) + " " + only},
          {"bounds", number_text(options.lowest, 17) + ".." + number_text(options.highest, 17)}};
}

void write_chord_tuning_checkpoint(const std::filesystem::path& path,
                                   const std::map<std::string, std::string>& identity,
                                   const ChordTuningRecord& record) {
  Json history = Json::array();
  for (const TuningTrial& trial : record.tuning.history) history.push_back(trial_json(trial));
  write_sealed(path, kSeal,
               {{"tuning", identity},
                {"value", numbers(record.tuning.value)},
                {"q", numbers(record.tuning.q)},
                {"x_before", numbers(record.x_before.reshaped())},
                {"seconds", record.tuning.seconds},
                {"history", history}});
}

ChordTuningRecord read_chord_tuning_checkpoint(const std::filesystem::path& path,
                                               const std::map<std::string, std::string>& identity) {
  const std::string file = path.string();
  const Json json = read_sealed(path, kSeal);
  std::vector<std::string> defects;
  ChordTuningRecord record;
  try {
    const auto known = json.at("tuning").get<std::map<std::string, std::string>>();
    for (const auto& [key, value] : identity)
      if (const auto there = known.find(key); there == known.end() || there->second != value)
        defects.push_back(file + ": is of a tuning with another " + key +
                          "; give the same as then, or tune without --resume to begin anew");
    if (!defects.empty()) throw InputError(defects);
    record.tuning.value = vector_of(json.at("value"));
    record.tuning.q = vector_of(json.at("q"));
    const Vector x = vector_of(json.at("x_before"));
    if (x.size() % 3 != 0) throw std::domain_error("positions that are none");
    record.x_before = x.reshaped(3, x.size() / 3);
    record.tuning.seconds = seconds_of(json.at("seconds").get<double>());
    for (const Json& trial : json.at("history")) record.tuning.history.push_back(trial_of(trial));
    if (record.tuning.history.empty()) throw std::domain_error("no trial");
    for (const TuningTrial& trial : record.tuning.history)
      if (trial.value.size() != record.tuning.value.size())
        throw std::domain_error("numbers that do not fit");
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {  // of the library, or of a number that is none
    throw InputError(file + ": does not hold what a checkpoint of a tuning holds (" + error.what() + ")" +
                     kBeginAnew);
  }
  return record;
}

}  // namespace coapt
