#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "cli/worker_pool.hpp"
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "run/replaced_inputs.hpp"
#include "study/parameter_study.hpp"
#include "study/point_shapes.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <thread>

namespace coapt::cli {
namespace {

struct ParameterStudyArguments : StudyArguments {
  std::vector<std::string> sweeps;
  std::string metric = "orifice_area_mm2";
  int processes = 0;
  bool is_greatest_best = false, starts_over = false;
};

std::string settings_text(const ParameterStudyArguments& arguments) {
  const std::string steps =
      arguments.damped_steps ? ", damped steps " + std::to_string(*arguments.damped_steps) : "";
  return "tolerance " + number_text(arguments.tolerance, 17) + ", seconds " +
         number_text(arguments.max_seconds, 17) + ", solver " + arguments.solver + steps;
}

// In a process of its own: solves the point into its folder.
int solve_point(const StudyPoint& point, const std::filesystem::path& scene,
                const std::filesystem::path& folder, const ParameterStudyArguments& arguments) {
  RunOptions options = arguments.options({.is_quiet = true});
  options.folder = folder;
  options.first_order = {};  // of many points: their page compares them
  try {
    Scene of_point = parse_scene(point.scene, scene);
    if (of_point.solver.threads == 0) of_point.solver.threads = 1;  // the processes share the processors
    const RunReport solved = run(of_point, all_solvers(), options);
    if (solved.report.result.status == Status::Cancelled) return kNotConverged;  // to be solved again
    write_point(folder, point_result(point, solved));
    return solved.report.result.status == Status::Converged ? kConverged : kNotConverged;
  } catch (const InputError& error) {
    prepare_result_folder(folder);
    write_point(folder, refused_point(point, error.what()));
    return kBadInput;
  }
}

// "pressure.value = 80 mmHg  " of each value of the point.
std::string values_text(const PointResult& result, const ParameterStudy& study) {
  std::string text;
  for (size_t k = 0; k < study.sweeps.size(); ++k)
    text += study.sweeps[k].path + " = " + result.values[k] + "  ";
  return text;
}

void print_point(const PointResult& result, const ParameterStudy& study, size_t finished) {
  std::printf("  %zu of %zu  %s", finished, study.point_count, values_text(result, study).c_str());
  if (const auto value = result.metric(study.metric)) std::printf("%s %.6g  ", study.metric.c_str(), *value);
  if (!result.has_converged())
    std::printf("%s: %s", result.status.c_str(), result.message.c_str());
  else if (!result.doubts.empty())
    std::printf("in doubt: %s", joined_doubts(result.doubts).c_str());
  std::printf("\n");
  std::fflush(stdout);
}

// Where nothing else is printed.
void tell_refused(const PointResult& result, const ParameterStudy& study) {
  if (result.status == "refused")
    std::fprintf(stderr, "coapt: error: %s%s\n", values_text(result, study).c_str(), result.message.c_str());
}

void print_ranking(const ParameterStudy& study) {
  std::vector<std::string> columns{"rank"};
  for (const Sweep& sweep : study.sweeps) columns.push_back(sweep.path);
  columns.insert(columns.end(), {study.metric, "status"});
  Table table = chosen(point_table(study), columns);
  const std::vector<size_t> order = ranked(study);
  for (size_t k = 0; k < order.size(); ++k)
    table.rows[k].back() = shown_status(standing(study.results[order[k]]));
  print_table(table);
}

void print_study(const ParameterStudy& study, const std::filesystem::path& folder) {
  print_ranking(study);
  if (study.results.size() < study.point_count)
    std::printf("%zu points are missing; the same command goes on with them\n",
                study.point_count - study.results.size());
  std::printf("written to %s (study.json, study.csv, study.html and a folder for each point)\n",
              folder.string().c_str());
}

std::vector<std::vector<std::string>> doubts_of(const ParameterStudy& study) {
  std::vector<std::vector<std::string>> doubts;
  for (const PointResult& result : study.results) doubts.push_back(result.doubts);
  return doubts;
}

std::filesystem::path study_folder(const ParameterStudyArguments& arguments, const Scene& first) {
  std::filesystem::path folder =
      arguments.folder.empty() ? result_folder(first) / "study" : std::filesystem::path(arguments.folder);
  refuse_replaced_inputs(first, folder, {"study.json", "study.csv", "study.html"});
  return folder;
}

void run_study(const ParameterStudyArguments& arguments, Session& session) {
  listen_for_interrupts();
  const std::filesystem::path scene = arguments.scene;
  ParameterStudy study;
  study.scene_file = scene.filename().string();
  study.metric = arguments.metric;
  study.is_greatest_best = arguments.is_greatest_best;
  for (const std::string& text : arguments.sweeps) study.sweeps.push_back(parse_sweep(text));
  check_metric(arguments.metric);
  const std::vector<StudyPoint> points = study_points(scene, study.sweeps, settings_text(arguments));
  study.point_count = points.size();
  const Scene first = parse_scene(points.front().scene, scene);
  study.scene_title = scene_title(first);
  const std::filesystem::path folder = study_folder(arguments, first);
  const OutputFolder output(folder);

  std::vector<std::optional<PointResult>> results(points.size());
  std::vector<size_t> open;
  for (const StudyPoint& point : points) {
    const std::filesystem::path place = point_folder(folder, point.number);
    if (!arguments.starts_over) results[point.number] = read_point(place, point);
    if (!results[point.number]) open.push_back(point.number);
  }
  const size_t before = points.size() - open.size();
  if (before > 0) std::printf("%zu of %zu points are there already\n", before, points.size());
  size_t finished = before;
  PoolCallbacks callbacks;
  const auto show_progress = make_job_progress(session, "points", open.size());
  callbacks.stops = [&] {
    show_progress(finished - before);
    return is_interrupted();
  };
  callbacks.work = [&](size_t job) {
    const StudyPoint& point = points[open[job]];
    return solve_point(point, scene, point_folder(folder, point.number), arguments);
  };
  callbacks.finished = [&](size_t job, int code) {
    const StudyPoint& point = points[open[job]];
    results[point.number] = read_point(point_folder(folder, point.number), point);
    if (!results[point.number]) {
      if (!is_interrupted())
        std::fprintf(stderr, "coapt: point %zu ended without a result (exit code %d)\n", point.number, code);
      return;
    }
    ++finished;
    end_progress();
    if (session.is_quiet) tell_refused(*results[point.number], study);
    print_point(*results[point.number], study, finished);
  };
  const int cores = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  run_jobs(open.size(), arguments.processes > 0 ? arguments.processes : cores, callbacks);

  for (std::optional<PointResult>& result : results)
    if (result) study.results.push_back(std::move(*result));
  if (has_shape_view()) study.shapes = point_shapes(scene, points, study.results, study.sweeps, folder);
  write_parameter_study(folder, study);
  session.document = parameter_study_json(study);
  print_study(study, folder);
  session.exit_code = exit_code_of(study.has_converged(), doubts_of(study));
}

}  // namespace

void add_study_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<ParameterStudyArguments>();
  CLI::App* command = app.add_subcommand(
      "study", "A scene at every point of a grid of values, in parallel processes, and the points ranked");
  add_study_arguments(*command, *arguments);
  command
      ->add_option(
          "--sweep", arguments->sweeps,
          "KEY=a..b[:n] or KEY=a,b,c, such as ring.size=26..34mm:5; KEY is NAME.KEY of an intervention "
          "or a term, or a path in the file, terms[1].young. Several make a grid")
      ->required()
      ->allow_extra_args(false);
  command->add_option("--rank-by", arguments->metric, "Metric of result.json that ranks the points")
      ->capture_default_str();
  command->add_flag("--greatest", arguments->is_greatest_best,
                    "The greatest is the best, instead of the least");
  command
      ->add_option("-j,--processes", arguments->processes, "Processes at a time (default: one for each core)")
      ->check(CLI::Range(1, 4096));
  command->add_flag("--start-over", arguments->starts_over, "Solve finished points again");
  command->callback([arguments, &session] { run_study(*arguments, session); });
}

}  // namespace coapt::cli
