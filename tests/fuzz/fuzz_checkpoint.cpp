// What a run leaves for a later one: checkpoints of solves and of tunings, points of a study. Every input is
// read as each of them: as a whole file, and for checkpoints also as what stands behind a good checksum.
#include "core/error.hpp"
#include "formats/json/checksummed_cbor.hpp"
#include "fuzz/fuzz_target.hpp"
#include "solve/checkpoint.hpp"
#include "study/parameter_study.hpp"
#include "tuning/chord_tuning.hpp"

#include <cmath>

namespace coapt::fuzz {
namespace {

// Those of the seeds.
const RunIdentity& run_identity() {
  static const RunIdentity identity{"1", "scene", "newton", 1e-8, {}};
  return identity;
}

void judge(const RunRecord& record) {
  for (const MinimisationEnd& end : record.ends) require(end.x.allFinite(), "positions of a run are finite");
  require(record.iterate.allFinite(), "the last iterate is finite");
  require(record.order.found().is_consistent(), "an order of elimination is one");
  require(std::isfinite(record.order.entries()), "a factor has a number of entries");
  require(record.iterations >= 0, "iterates are counted");
  require(std::isfinite(record.seconds) && record.seconds >= 0, "a run took a time");
}

void judge(const ChordTuningRecord& record) {
  const TuningRecord& tuning = record.tuning;
  require(tuning.value.allFinite() && tuning.q.allFinite(), "values and unknowns of a tuning are finite");
  require(record.x_before.allFinite(), "positions of a tuning are finite");
  require(!tuning.history.empty(), "a tuning has tried something");
  for (const TuningTrial& trial : tuning.history)
    require(trial.value.size() == tuning.value.size() && trial.value.allFinite(),
            "every trial has all values");
  require(std::isfinite(tuning.seconds) && tuning.seconds >= 0, "a tuning took a time");
}

// kind: and format.
std::string sealed(const std::string& kind, std::string_view body) {
  return kind + " " + fingerprint(body) + "\n" + std::string(body);
}

}  // namespace

void run_target(std::string_view bytes) {
  static const Scratch scratch;
  const auto run = [](const std::filesystem::path& file) { judge(read_checkpoint(file, run_identity())); };
  const auto tuning = [](const std::filesystem::path& file) {
    judge(read_chord_tuning_checkpoint(file, {{"version", "1"}}));
  };
  const std::vector<std::function<void()>> readers = {
      [&] { run(scratch.write("checkpoint", bytes)); },
      [&] { run(scratch.write("checkpoint", sealed("coapt checkpoint 3", bytes))); },
      [&] { tuning(scratch.write("checkpoint", bytes)); },
      [&] { tuning(scratch.write("checkpoint", sealed("coapt tuning 2", bytes))); },
      [&] {
        StudyPoint point;
        point.key = "key";
        const auto file = scratch.write("point.json", bytes);
        if (!read_point(file.parent_path(), point)) throw InputError("input: no point");
      }};
  try_each(readers, "a checkpoint nor a point");
}

}  // namespace coapt::fuzz
