#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "core/error.hpp"
#include "formats/text.hpp"
#include "study/bench/benchmark_report.hpp"
#include "study/bench/benchmark_summary.hpp"

#include <cstdio>
#include <memory>

namespace coapt::cli {
namespace {

struct BenchArguments : StudyArguments {
  std::string methods = "newton,lbfgs,dynamic", tolerances = "1e-2,1e-4,1e-6,1e-8", reference, closed;
  int levels = 1, repeats = 3;
  double truth_seconds = 0;  // 0: not given
  BranchSearch branches = {.starts = 0};
};

std::vector<double> tolerance_list(const std::string& text) {
  std::vector<double> tolerances;
  std::vector<std::string> defects;
  for (const std::string& word : comma_list(text)) {
    double number = 0;
    if (const auto reason = formats::read_number(word, number))
      defects.push_back("--tolerances: " + *reason + "; give numbers with commas between them, 1e-2,1e-6");
    tolerances.push_back(number);
  }
  if (!defects.empty()) throw InputError(defects);
  return tolerances;
}

void print_summary(const Benchmark& bench) {
  std::printf("\n");
  print_table(chosen(run_table(bench, bench.runs),
                     {"method", "mesh", "tolerance", "status", "algebraic_max_mm", "discretisation_mm",
                      "method_mm", "mean_to_closed_mm", "total_mm", "cpu_median_s", "peak_memory_mb"}));
  for (const BenchRun& run : bench.runs)
    if (run.status != Status::Converged)
      std::printf("  %s on %s to %g stopped early: %s\n", bench.methods[run.method].name.c_str(),
                  mesh_text(bench.meshes[run.mesh]).c_str(), run.tolerance, run.message.c_str());
  for (const BenchEnd& end : bench.ends)
    if (!end.failure.empty())
      std::printf("  %s failed: %s\n", bench.methods[end.method].name.c_str(), end.failure.c_str());
  std::printf("\nmedian wall time to an accuracy\n");
  print_table(times_table(bench));
  std::printf("\n");
  for (const std::string& missing : missing_equilibria(bench))
    std::printf("  warning: %s\n", missing.c_str());
  if (const std::string doubted = doubts_of_shown(bench); !doubted.empty())
    std::printf("  %s\n", doubted.c_str());
  for (const std::string& other : other_equilibria(bench)) std::printf("  %s\n", other.c_str());
  for (const BenchMesh& mesh : bench.meshes)
    if (mesh.order) std::printf("  observed order at %s: %.2f\n", mesh_text(mesh).c_str(), *mesh.order);
  for (size_t method = 0; method < bench.methods.size(); ++method)
    if (const auto found = growth(bench, method))
      std::printf("  %s: CPU time grows with triangles^%.2f (tolerance %g)\n",
                  bench.methods[method].name.c_str(), found->exponent, found->tolerance);
  for (const double mm : kTotalAccuracies) std::printf("%s\n", recommendation(bench, mm).c_str());
}

void bench_scene(const BenchArguments& arguments, Session& session) {
  listen_for_interrupts();
  const Scene scene = load_scene(arguments.scene);
  RunOptions run = arguments.options(session);
  const OutputFolder output(arguments.folder_for(scene, {"bench.json", "bench.csv", "bench.html"}));
  run.folder = output.path();
  BenchOptions options;
  options.methods = comma_list(arguments.methods);
  options.reference = arguments.reference;
  options.tolerances = tolerance_list(arguments.tolerances);
  options.levels = arguments.levels;
  options.repeats = arguments.repeats;
  options.closed = arguments.closed;
  options.branches = arguments.branches;
  if (arguments.truth_seconds > 0) options.truth_seconds = arguments.truth_seconds;
  RowPrinter print;
  options.report = [&](const Benchmark& bench, const BenchRun& done) {
    end_progress();
    print(chosen(run_table(bench, {&done, 1}),
                 {"method", "mesh", "tolerance", "status", "wall_median_s", "iterations"}));
  };
  const Benchmark found = run_benchmark(scene, all_solvers(), options, run);
  end_progress();
  write_benchmark(found.folder, found);
  session.document = benchmark_json(found);
  print_summary(found);
  std::printf("written to %s (bench.json, bench.csv, bench.html)\n", found.folder.string().c_str());
  session.exit_code = exit_code_of(found.has_converged(),
                                   {found.shown ? found.shown->standing.doubts : std::vector<std::string>()});
}

}  // namespace

void add_bench_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<BenchArguments>();
  CLI::App* command = app.add_subcommand(
      "bench",
      "Error against run time: methods, tolerances and meshes on one scene, and what to take for it");
  command->add_option("SCENE", arguments->scene, "Scene file (JSON)")->required();
  command->add_option("-o,--output", arguments->folder,
                      "Folder of the files (default: the scene's result folder)");
  command->add_option("--methods", arguments->methods,
                      "Names of solvers with commas between them; mass-spring puts springs in the place of "
                      "membranes (default: "
                      "newton,lbfgs,dynamic)");
  command->add_option("--tolerances", arguments->tolerances,
                      "On the residual, with commas between them (default: 1e-2,1e-4,1e-6,1e-8)");
  command
      ->add_option("--levels", arguments->levels,
                   "How often the mesh is refined 1:4 and benchmarked again (default: 1); one more is solved "
                   "once")
      ->check(CLI::Range(0, 4));
  command->add_option("--repeats", arguments->repeats, "Of each run, for its time (default: 3)")
      ->check(CLI::Range(1, 1000));
  command->add_option("--reference", arguments->reference,
                      "That of the methods which the others are compared with (default: newton, else the "
                      "first)");
  command->add_option("--closed", arguments->closed,
                      "Given closed surface, in the unit of the scene's mesh (default: the scene's)");
  command->add_option("--max-seconds", arguments->max_seconds, "Of each solve (default: the scene's)")
      ->check(positive_defect);
  command
      ->add_option(
          "--truth-seconds", arguments->truth_seconds,
          "Of each solve that errors are measured to: on the finest mesh, and on to 1e-12 (default: as "
          "--max-seconds)")
      ->check(positive_defect);
  add_path_option(*command, arguments->damped_steps);
  add_branch_options(*command, arguments->branches);
  command->callback([arguments, &session] { bench_scene(*arguments, session); });
}

}  // namespace coapt::cli
