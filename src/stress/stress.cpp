#include "stress/stress.hpp"

#include "core/error.hpp"
#include "core/timing.hpp"
#include "formats/json/suggestion.hpp"
#include "stress/scenes/built_in.hpp"
#include "stress/subject.hpp"

#include <algorithm>

namespace coapt {
namespace {

void append(std::vector<StressRow>& rows, std::vector<StressRow> more) {
  std::move(more.begin(), more.end(), std::back_inserter(rows));
}

std::vector<StressRow> subject_rows(const SubjectPointer& subject) {
  std::vector<StressRow> rows;
  for (const auto& family :
       {frame_rows, number_rows, start_rows, promise_rows, collision_rows, failure_rows, interrupt_rows,
        repetition_rows, thread_rows, input_rows, descent_rows, derivative_rows, size_rows})
    append(rows, family(subject));
  for (StressRow& row : rows) row.shown = [subject] { return own_solve(*subject); };
  return rows;
}

std::vector<std::string> ids_of(const std::vector<StressRow>& rows) {
  std::vector<std::string> ids;
  for (const StressRow& row : rows)
    if (std::find(ids.begin(), ids.end(), row.id) == ids.end()) ids.push_back(row.id);
  return ids;
}

// Those that were asked for, by the order of the matrix. Throws InputError.
std::vector<StressRow> chosen(std::vector<StressRow> rows, const StressOptions& options) {
  const std::vector<std::string> known = ids_of(rows);
  std::vector<std::string> defects;
  for (const std::string& id : options.rows)
    if (std::find(known.begin(), known.end(), id) == known.end())
      defects.push_back("--rows: no row \"" + id + "\" here" + suggestion(id, known) +
                        "; there are: " + listed(known));
  if (!defects.empty()) throw InputError(defects);
  const auto is_left_out = [&](const StressRow& row) {
    const bool is_named = options.rows.empty() ||
                          std::find(options.rows.begin(), options.rows.end(), row.id) != options.rows.end();
    return !is_named || (options.is_quick && !row.is_quick);
  };
  rows.erase(std::remove_if(rows.begin(), rows.end(), is_left_out), rows.end());
  if (rows.empty())
    throw InputError("--quick: leaves none of the rows that --rows names; leave one of them out");
  const auto number = [](const StressRow& row) {
    return row.id.size() > 1 ? std::stoi(row.id.substr(1)) : 0;
  };
  std::stable_sort(rows.begin(), rows.end(), [&](const StressRow& a, const StressRow& b) {
    return a.id[0] != b.id[0] ? a.id[0] > b.id[0] : number(a) < number(b);
  });
  return rows;
}

struct Topic {
  std::string_view id, text;
};
constexpr Topic kTopics[] = {{"S1", "units"},
                             {"S2", "far from zero"},
                             {"S3", "loads"},
                             {"S4", "ratios of stiffness"},
                             {"S5", "single lines"},
                             {"S6", "slivers"},
                             {"S7", "point of view"},
                             {"S8", "nothing to do"},
                             {"S9", "starts, saddles"},
                             {"S10", "no equilibrium"},
                             {"S11", "kinks"},
                             {"S12", "snap-through"},
                             {"S13", "degenerate contact"},
                             {"S14", "tunnelling"},
                             {"S15", "collision detection"},
                             {"S16", "failing evaluations"},
                             {"S17", "interrupts"},
                             {"S18", "repetition"},
                             {"S19", "threads"},
                             {"S20", "bad input"},
                             {"S21", "descent"},
                             {"S22", "there and back"},
                             {"S23", "derivatives"},
                             {"S24", "size"},
                             {"S25", "extreme numbers"},
                             {"S26", "large contact"},
                             {"P", "balance"},
                             {"H3", "other methods"}};

std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
  return all;
}

StressOutcome outcome_of_row(const StressRow& row) {
  try {
    return row.run();
  } catch (const InputError& error) {
    return {StressVerdict::NotApplicable, {}, {}, "refused: " + joined(error.defects())};
  } catch (const std::exception& error) {
    return {StressVerdict::Fail, {}, {}, std::string("exception: ") + error.what()};
  }
}

}  // namespace

std::string_view stress_verdict_name(StressVerdict verdict) {
  switch (verdict) {
    case StressVerdict::Pass:
      return "pass";
    case StressVerdict::OtherBranch:
      return "branch";
    case StressVerdict::Stall:
      return "stall";
    case StressVerdict::Fail:
      return "fail";
    case StressVerdict::NotApplicable:
      return "n/a";
  }
  return "";
}

std::string_view stress_topic(std::string_view id) {
  for (const Topic& topic : kTopics)
    if (topic.id == id) return topic.text;
  return "";
}

int StressMatrix::count(StressVerdict verdict) const {
  return static_cast<int>(std::count_if(results.begin(), results.end(), [&](const StressResult& result) {
    return result.outcome.verdict == verdict;
  }));
}

std::vector<StressRow> stress_rows(const Scene& scene, const StressOptions& options) {
  const auto subject = std::make_shared<StressSubject>();
  subject->name = scene.file.filename().string();
  subject->bench = StressRunner(options);
  subject->scene = stress_scene(scene);
  subject->bench.check(*subject->scene);
  return chosen(subject_rows(subject), options);
}

std::vector<StressRow> stress_rows(const StressOptions& options) {
  constexpr double kSameShape = 1e-8;  // over the extent, at the tolerance of the built-in valve
  const StressRunner bench(options);
  std::vector<StressRow> rows;
  for (const auto& family :
       {load_rows, line_rows, sheet_rows, no_equilibrium_rows, degenerate_rows, folded_rows, tunnelling_rows})
    for (const BuiltRow& row : family()) rows.push_back(row_of(bench, row));
  append(rows, collision_query_rows());
  for (const auto& family : {bad_input_rows, random_scene_rows, large_scene_rows, coincident_rows})
    append(rows, family(bench));
  for (const bool has_contact : {false, true}) {
    const auto subject = std::make_shared<StressSubject>();
    subject->name = has_contact ? "valve with contact" : "valve";
    subject->bench = bench;
    subject->make = [folder = options.folder / "scenes", has_contact] {
      return built_in_valve(folder, has_contact);
    };
    subject->same_shape = kSameShape;
    subject->same_history = true;
    std::vector<StressRow> more = subject_rows(subject);
    // What takes time with contact shows it without: of the quick ones the promises alone.
    if (has_contact)
      for (StressRow& row : more) row.is_quick = row.is_quick && (row.id == "S13" || row.id == "S18");
    append(rows, std::move(more));
  }
  const auto large = std::make_shared<StressSubject>();
  large->name = "large valve";
  large->bench = bench;
  large->make = [folder = options.folder / "scenes"] { return large_valve(folder); };
  append(rows, thread_rows(large));
  return chosen(std::move(rows), options);
}

StressMatrix run_stress(const std::vector<StressRow>& rows, const StressOptions& options) {
  StressMatrix matrix;
  matrix.row_seconds = options.row_seconds;
  for (const StressRow& row : rows) {
    StressResult result{row, {}};
    const double wall = wall_seconds(), cpu = cpu_seconds();
    result.outcome = outcome_of_row(row);
    result.wall_s = wall_seconds() - wall;
    result.cpu_s = cpu_seconds() - cpu;
    matrix.is_cancelled = options.is_cancelled && options.is_cancelled();
    if (matrix.is_cancelled) break;
    matrix.results.push_back(std::move(result));
    if (options.report) options.report(matrix.results.back());
  }
  // The last that was solved: of the built-in scenes the valve with contact.
  for (auto row = rows.rbegin(); row != rows.rend() && !matrix.shown; ++row)
    if (row->shown) matrix.shown = row->shown();
  return matrix;
}

}  // namespace coapt
