#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/session.hpp"
#include "cli/solve_checkpoint.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "core/components.hpp"
#include "core/error.hpp"
#include "exchange/valve_doubts.hpp"
#include "formats/json/suggestion.hpp"
#include "formats/json/units.hpp"
#include "results/result_warnings.hpp"
#include "run/branches.hpp"
#include "run/unwritten.hpp"
#include "study/bench/accuracy.hpp"
#include "tuning/first_order.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace coapt::cli {
namespace {

struct SolveArguments {
  std::string scene, folder, solver, accuracy;
  double tolerance = 0, max_seconds = 0;
  int modes = 0, frames = 0;
  std::optional<int> damped_steps, threads;
  bool has_no_report = false, has_sliders = false, has_no_sliders = false;
  BranchSearch branches = {.starts = 0};
  SolveCheckpointArguments checkpoint;
};

// " (other equilibria: 8.16 to 10.20)" for a metric; nothing where there are none.
void print_others(const std::optional<Branches>& branches, const char* metric, const char* format) {
  const BranchRange* range = range_of(branches, metric);
  if (range == nullptr) return;
  std::printf(" (other equilibria: ");
  std::printf(format, range->lowest);
  std::printf(" to ");
  std::printf(format, range->highest);
  std::printf(")");
}

// Freed et al. 1999, of the long-axis view.
constexpr const char* kHealthyProlapse = "healthy: below 2 mm, Freed et al. 1999";

// Prints one metric with its range over the other equilibria, if any were found, and with a remark.
struct MetricPrinter {
  const std::optional<Branches>& branches;

  void operator()(const char* label, const std::optional<double>& value, const char* unit, const char* format,
                  const char* metric, const char* remark = "") const {
    if (!value) return;
    std::printf("  %-22s ", label);
    std::printf(format, *value);
    std::printf("%s%s", unit[0] == 0 ? "" : " ", unit);
    print_others(branches, metric, format);
    if (remark[0] != 0) std::printf(" (%s)", remark);
    std::printf("\n");
  }
};

void print_reference(const ReferenceDistance& reference) {
  const DistanceFigures distance = both_directions(reference);
  std::printf("  %-22s mean %.3f, 95 %% %.3f, max %.3f mm", "distance to reference", distance.mean,
              distance.p95, distance.max);
  if (reference.left_out > 0) std::printf(" (undetermined nodes left out: %d)", reference.left_out);
  std::printf("\n");
  if (reference.lines) {
    const DistanceFigures lines = both_directions(reference.lines->there, reference.lines->back);
    std::printf("  %-22s mean %.3f, 95 %% %.3f, max %.3f mm\n", "of coaptation lines", lines.mean, lines.p95,
                lines.max);
  }
  if (!reference.registration) return;
  const AppliedRegistration& registration = *reference.registration;
  std::printf(
      "  %-22s by %s: turned by %.4g degrees, moved by %.4g mm, scale %.6g, overlap %.3g; mean %.3f mm "
      "before\n",
      "reference registered", registration_method_name(registration.found.method),
      registration.found.motion.angle_deg(), registration.translation_mm, registration.found.motion.scale,
      registration.found.overlap,
      both_directions(registration.to_reference_before, registration.from_reference_before).mean);
}

void print_certificate(const Certificate& certificate) {
  std::printf("  %-22s %s\n", "certificate", summary(certificate).c_str());
  if (certificate.stability.smallest.size() == 0) return;
  std::printf("  %-22s", "smallest eigenvalues");
  for (const double value : certificate.stability.smallest) std::printf(" %.4g", value);
  std::printf(" N/mm\n");
}

// A length as the user wrote it, "0.1mm" [mm].
double wanted_accuracy(const std::string& text) {
  try {
    return quantity_value(text, kLength);
  } catch (const InputError& error) {
    throw InputError("--accuracy: " + std::string(error.what()));
  }
}

void print_metrics(const Model& model, const Metrics& m, const std::optional<Branches>& branches) {
  const MetricPrinter print = {branches};
  if (m.orifice_area_mm2 && m.annulus_area_mm2) {
    std::printf("  %-22s %.2f of %.1f mm2", "orifice area", *m.orifice_area_mm2, *m.annulus_area_mm2);
    print_others(branches, "orifice_area_mm2", "%.2f");
    std::printf("\n");
  }
  const std::string coaptation = coaptation_remark(m);
  print("coaptation area", m.coaptation_area_mm2, "mm2", "%.2f", "coaptation_area_mm2", coaptation.c_str());
  if (!m.coaptation_area_mm2 && !coaptation.empty())
    std::printf("  %-22s %s\n", "coaptation area", coaptation.c_str());
  print("coaptation length", m.coaptation_length_mm, "mm", "%.2f", "coaptation_length_mm");
  print("coaptation height", m.coaptation_height_mm, "mm", "%.2f", "coaptation_height_mm");
  print("tenting height", m.tenting_height_mm, "mm", "%.2f", "tenting_height_mm");
  print("prolapse height", m.prolapse_height_mm, "mm", "%.2f", "prolapse_height_mm",
        m.healthy_closure.empty() ? "" : kHealthyProlapse);
  if (model.mesh.triangle_count() > 0) {
    std::printf("  %-22s %.6g mm2 (open: %.6g mm2)", "area", m.leaflet_area_closed_mm2,
                m.leaflet_area_open_mm2);
    print_others(branches, "leaflet_area_closed_mm2", "%.6g");
    std::printf("\n");
  }
  print("greatest strain", m.max_principal_strain, "", "%.4f", "max_principal_strain");
  print("strain on 95 % below", m.p95_principal_strain, "", "%.4f", "p95_principal_strain");
  print("strain on 99 % below", m.p99_principal_strain, "", "%.4f", "p99_principal_strain");
  print("greatest chord force", m.max_chord_force_n, "N", "%.4g", "max_chord_force_n");
  print("greatest chord strain", m.max_chord_strain, "", "%.4f", "max_chord_strain");
  print("greatest displacement", m.max_displacement_mm, "mm", "%.4g", "max_displacement_mm");
}

// Of a mitral valve: figures with their healthy range, and those that are out of it.
void print_healthy(const std::vector<HealthyCriterion>& criteria) {
  const char* label = "healthy closure";
  for (const HealthyCriterion& criterion : criteria) {
    std::printf("  %-22s %s (%s)%s\n", label, figure_in_words(criterion).c_str(),
                range_in_words(criterion).c_str(), criterion.is_met() ? "" : ": not healthy");
    label = "";
  }
}

// What figures do not hold for, before they are read.
void print_undetermined(const Report& report) {
  const UndeterminedNodes nodes = undetermined_nodes(report.result.certificate.free_nodes, report.branches);
  if (nodes.total() == 0) return;
  std::printf("  %-22s %d (%d can move at no cost", "undetermined nodes", nodes.total(), nodes.free);
  if (report.branches && report.branches->converged() > 0)
    std::printf(", %d stand more than %.2g mm elsewhere in other equilibria", nodes.differing,
                report.branches->tolerance_mm);
  std::printf(")\n");
}

// The files of the result but those that one of the sentences about what could not be written names.
std::string written_files(const RunReport& run, const std::vector<std::string>& unwritten) {
  std::vector<std::string> files;
  for (const std::string& file : result_files(run.model, run.report)) {
    const std::string place = (run.folder / file).string() + ":";
    if (std::none_of(unwritten.begin(), unwritten.end(),
                     [&](const std::string& defect) { return defect.starts_with(place); }))
      files.push_back(file);
  }
  return listed(files);
}

void print_findings(const Model& model, const Report& report) {
  const std::optional<Branches>& branches = report.branches;
  const Result& result = report.result;
  const Metrics& m = report.metrics;
  std::printf("%s\n", headline(report).text.c_str());
  for (const std::string& warning : report.warnings) std::printf("  warning: %s\n", warning.c_str());
  if (std::isfinite(result.residual))
    std::printf("  %-22s %.2e (wanted: %g)\n", "residual", result.residual, report.tolerance);
  else
    std::printf("  %-22s not finite (wanted: %g)\n", "residual", report.tolerance);
  if (std::isfinite(result.energy))
    std::printf("  %-22s %.8g mJ\n", "energy", result.energy);
  else
    std::printf("  %-22s not finite\n", "energy");
  print_certificate(result.certificate);
  if (branches) std::printf("  %-22s %s\n", "other equilibria", branches_message(*branches).c_str());
  print_undetermined(report);
  std::printf("  %-22s %d vertices, %d triangles, %zu chords and cables\n", "mesh", model.mesh.vertex_count(),
              model.mesh.triangle_count(), model.lines.size());
  std::printf("  %-22s %s, %d iterations, %ld gradients, %.2f s\n", "solver", report.solver.c_str(),
              result.iterations, result.evaluations.gradient, result.wall_s);
  std::printf("  %-22s %s\n", "pressure", report.pressure_route.c_str());
  print_metrics(model, m, branches);
  print_healthy(m.healthy_closure);
  std::printf("  %-22s %ld (%s)\n", "intersections", m.intersections, m.intersection_checker.c_str());
  if (report.reference) print_reference(*report.reference);
  if (report.accuracy) std::printf("  %-22s %s\n", "error", report.accuracy->message.c_str());
  std::fflush(stdout);
}

// Where nobody reads on, the command ends at its last line, not before its page is complete.
void print_early(const Model& model, const Report& report) {
  const auto kept = std::signal(SIGPIPE, SIG_IGN);
  errno = 0;
  print_findings(model, report);
  if (errno == EPIPE) std::clearerr(stdout);
  std::signal(SIGPIPE, kept);
}

void print_files(const RunReport& run, const std::vector<std::string>& unwritten) {
  std::printf("written to %s (%s)\n", run.folder.string().c_str(), written_files(run, unwritten).c_str());
  std::fflush(stdout);
}

// Before the solve, which may take long, and in the warnings of its result.
std::vector<std::string> told_doubts(const Scene& scene, const SceneGeometry& geometry, const Model& model) {
  std::vector<std::string> doubts = valve_doubts(scene, geometry, model, false);
  for (const std::string& doubt : doubts) std::fprintf(stderr, "coapt: warning: %s\n", doubt.c_str());
  return doubts;
}

// What a checkpoint of this run is recognised by.
RunIdentity identity(const Scene& scene, const RunOptions& options,
                     const std::optional<double>& accuracy_mm) {
  return {version(),
          scene_fingerprint(scene),
          options.solver.empty() ? scene.solver.type : options.solver,
          options.tolerance.value_or(scene.solver.tolerance),
          accuracy_mm,
          options.damped_steps.value_or(scene.solver.continuation.damped_steps)};
}

// What could not be written is said at the end, below all that was found.
int print_unwritten(const std::vector<std::string>& unwritten) {
  for (const std::string& defect : unwritten) std::fprintf(stderr, "coapt: error: %s\n", defect.c_str());
  return kUnwritten;
}

// What was solved, also where its files could not be written.
RunReport solved(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                 const std::optional<double>& accuracy_mm, const Session& session,
                 std::vector<std::string>& unwritten) {
  const auto tell = [&](const AccuracyEstimate& estimate) { show_stage(session, last_mesh(estimate)); };
  try {
    return accuracy_mm ? run_to_accuracy(scene, solvers, *accuracy_mm, options, tell)
                       : run(scene, solvers, options);
  } catch (const UnwrittenRun& error) {
    unwritten = error.defects();
    return std::move(error.run());
  }
}

Report completed(std::vector<std::string>& unwritten, const std::function<Report()>& complete) {
  try {
    return complete();
  } catch (const UnwrittenReport& error) {
    unwritten = error.defects();
    return std::move(error.report());
  }
}

// Returns the exit code.
int solve_as_asked(const SolveArguments& arguments, RunOptions options, Session& session) {
  Scene scene = load_scene(arguments.scene);
  scene.solver.threads = arguments.threads.value_or(scene.solver.threads);
  const OutputFolder output(arguments.folder.empty() ? result_folder(scene)
                                                     : std::filesystem::path(arguments.folder));
  std::vector<std::string> unwritten;
  std::optional<double> accuracy_mm;
  if (!arguments.accuracy.empty()) accuracy_mm = wanted_accuracy(arguments.accuracy);
  options.doubts = told_doubts;
  show_progress(session, options);
  FirstOrderOptions sliders;
  if (arguments.has_sliders) sliders.share = kInfinity;
  const bool has_one_run = arguments.branches.starts == 0 && !accuracy_mm;
  bool is_printed = false;
  if (!arguments.has_no_sliders)
    options.first_order = [&is_printed, has_one_run,
                           make = first_order_of_runs(all_solvers(), options, sliders)](
                              const Scene& of, const Model& model, const Report& found) {
      if (has_one_run) {  // sliders take as long as a small solve
        end_progress();
        print_early(model, found);
        is_printed = true;
      }
      return make(of, model, found);
    };
  SolverTable solvers = all_solvers();
  std::optional<SolveCheckpoint> checkpoint;
  if (arguments.checkpoint.is_wanted()) {
    checkpoint.emplace(arguments.checkpoint, identity(scene, options, accuracy_mm));
    solvers = checkpoint->recorded(solvers);
    options.observer = checkpoint->recorded(options.observer);
  }
  RunReport report = solved(scene, solvers, options, accuracy_mm, session, unwritten);
  RunOptions again = options;
  show_progress(session, again);  // without a checkpoint
  report.report = completed(unwritten, [&] {
    return with_branches(scene, all_solvers(), again, arguments.branches, report.model,
                         std::move(report.report), report.folder);
  });
  end_progress();
  session.document = result_json(report.model, report.report);
  if (!is_printed) print_findings(report.model, report.report);
  print_files(report, unwritten);
  if (checkpoint) checkpoint->finish(arguments.scene, unwritten.empty());
  if (!unwritten.empty()) return print_unwritten(unwritten);
  const bool is_reached = !report.report.accuracy || report.report.accuracy->is_reached;
  const Result& result = report.report.result;
  if (!is_reached || result.status != Status::Converged) return kNotConverged;
  return is_in_doubt(report.report) ? kInDoubt : kConverged;
}

void add_slider_flags(CLI::App& command, SolveArguments& arguments) {
  CLI::Option* without =
      command.add_flag("--no-sliders", arguments.has_no_sliders,
                       "In report.html no sliders of the parameters that matter most, which move shape and "
                       "figures by their first-order response");
  command
      .add_flag("--sliders", arguments.has_sliders,
                "All eight sliders in report.html, also where they take more than half the time of the "
                "solve")
      ->excludes(without)
      ->excludes("--no-report")
      ->excludes("--accuracy");
}

}  // namespace

void add_solve_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<SolveArguments>();
  CLI::App* command = app.add_subcommand("solve", "Solve a scene and write its result folder");
  command->add_option("SCENE", arguments->scene, "Scene file (JSON)")->required();
  command->add_option("-o,--output", arguments->folder,
                      "Result folder (default: the scene's, or `result` beside the scene)");
  command->add_option("--solver", arguments->solver, "Solver (default: the scene's)");
  const auto* tolerance =
      command->add_option("--tolerance", arguments->tolerance, "On the residual (default: the scene's)")
          ->check(positive_defect);
  command->add_option(
      "--accuracy", arguments->accuracy,
      "Choose mesh and tolerance for this error of 95 % of the closed surface, such as 0.1mm: cuts "
      "the triangles into four until two refinements agree and the estimate is small enough; the "
      "error at the farthest point is reported beside it");
  const auto* seconds =
      command
          ->add_option("--max-seconds", arguments->max_seconds, "Stop after this time, keep the best state")
          ->check(positive_defect);
  const auto* modes = command
                          ->add_option("--modes", arguments->modes,
                                       "Smallest eigenvalues in the certificate (default: the scene's)")
                          ->check(CLI::Range(0, 1000));
  const auto* frames = command
                           ->add_option("--frames", arguments->frames,
                                        "Write every N-th iterate as a frame of an animation (frames.pvd)")
                           ->check(CLI::Range(1, 1000000000));
  add_path_option(*command, arguments->damped_steps);
  command
      ->add_option("--threads", arguments->threads,
                   "Threads that share the work, which change nothing but its time; 0: one for each "
                   "processor (default: the scene's)")
      ->check(CLI::Range(0, 256));
  add_branch_options(*command, arguments->branches);
  add_solve_checkpoint_arguments(*command, arguments->checkpoint);
  command->add_flag("--no-report", arguments->has_no_report, "Do not write report.html");
  add_slider_flags(*command, *arguments);
  command->callback([arguments, tolerance, seconds, modes, frames, &session] {
    listen_for_interrupts();
    RunOptions options;
    options.solver = arguments->solver;
    options.folder = arguments->folder;
    if (tolerance->count() > 0) options.tolerance = arguments->tolerance;
    if (seconds->count() > 0) options.max_seconds = arguments->max_seconds;
    options.damped_steps = arguments->damped_steps;
    if (modes->count() > 0) options.modes = arguments->modes;
    if (frames->count() > 0) options.frame_interval = arguments->frames;
    if (arguments->has_no_report) options.writes_page = false;
    options.factorisations = all_factorisations();
    options.checker = intersection_checker();
    session.exit_code = solve_as_asked(*arguments, options, session);
  });
}

}  // namespace coapt::cli
