#include "core/components.hpp"
#include "core/number_text.hpp"
#include "formats/whole_file.hpp"
#include "solve/checkpoint.hpp"
#include "solve/resumable_record.hpp"
#include "tuning/chord_tuning.hpp"
#include "tuning/chord_tuning_goal.hpp"

#include <cmath>
#include <stdexcept>

namespace coapt {
namespace {

constexpr Seal kSeal = {"coapt tuning", "checkpoint of a tuning", "2",
                        "; tune without --resume to begin anew"};

Json trial_json(const TuningTrial& trial) {
  Json json = {{"value", numbers_of(trial.value)}, {"status", status_name(trial.status)},
               {"metrics", trial.metrics},         {"iterations", trial.iterations},
               {"is_best", trial.is_best},         {"is_aided", trial.is_aided},
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
  trial.status = status_of(json.at("status"));
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

Identity chord_tuning_identity(const Scene& scene, const ChordTuningOptions& options, const RunOptions& run) {
  std::string only, target;
  for (const std::string& name : options.only) only += " " + name;
  const std::filesystem::path file =
      options.target.empty() ? scene.closed_surface.value_or(std::filesystem::path()) : options.target;
  if (distance_weight_of(options) > 0 && !file.empty())
    target = fingerprint(formats::read_whole(file)) + " times " + exact_text(options.target_scale);
  Identity identity = {{"scene", scene_fingerprint(scene), {}, true},
                       {"version", "coapt " + version()},
                       {"number of damped steps",
                        std::to_string(run.damped_steps.value_or(scene.solver.continuation.damped_steps))},
                       {"tolerance", exact_text(run.tolerance.value_or(scene.solver.tolerance))},
                       {"target", target, {}, true},
                       {"distance weight", exact_text(distance_weight_of(options))},
                       {"orifice weight", exact_text(options.orifice_weight)},
                       {"force weight", exact_text(options.force_weight)},
                       {"change weight", exact_text(change_weight_of(options))},
                       {"choice of sides", std::to_string(static_cast<int>(options.sides))},
                       {"choice of groups", std::to_string(static_cast<int>(options.grouping)) + only},
                       {"pair of bounds", exact_text(options.lowest) + " to " + exact_text(options.highest)}};
  for (IdentityItem& item : identity)
    item.remedy = "give the same as then, or tune without --resume to begin anew";
  return identity;
}

void write_chord_tuning_checkpoint(const std::filesystem::path& path, const Identity& identity,
                                   const ChordTuningRecord& record) {
  Json history = Json::array();
  for (const TuningTrial& trial : record.tuning.history) history.push_back(trial_json(trial));
  write_record(path, kSeal, identity,
               {{"value", numbers_of(record.tuning.value)},
                {"q", numbers_of(record.tuning.q)},
                {"x_before", numbers_of(record.x_before.reshaped())},
                {"seconds", record.tuning.seconds},
                {"history", history}});
}

ChordTuningRecord read_chord_tuning_checkpoint(const std::filesystem::path& path, const Identity& identity) {
  ChordTuningRecord record;
  read_record(path, kSeal, identity, [&](const Json& json) {
    record.tuning.value = vector_of(json.at("value"));
    record.tuning.q = vector_of(json.at("q"));
    record.x_before = points_of(json.at("x_before"));
    record.tuning.seconds = seconds_of(json.at("seconds").get<double>());
    for (const Json& trial : json.at("history")) record.tuning.history.push_back(trial_of(trial));
    if (record.tuning.history.empty()) throw std::domain_error("no trial");
    for (const TuningTrial& trial : record.tuning.history)
      if (trial.value.size() != record.tuning.value.size())
        throw std::domain_error("numbers that do not fit");
  });
  return record;
}

}  // namespace coapt
