#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "core/error.hpp"
#include "formats/json/json_text.hpp"
#include "stress/stress_report.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <spawn.h>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace coapt::cli {
namespace {

struct StressArguments {
  std::string scene, folder, rows;
  double row_seconds = 20;
  bool is_quick = false, lists = false;
};

void print_list(const std::vector<StressRow>& rows) {
  const auto topic = [](const StressRow& row) { return stress_topic(row.id); };
  const auto quick = [](const StressRow& row) { return row.is_quick ? "yes" : ""; };
  print_table(table_of<StressRow>(rows, {{text_column("row"), &StressRow::id},
                                         {text_column("topic"), topic},
                                         {text_column("scene"), &StressRow::scene},
                                         {text_column("what is varied"), &StressRow::name},
                                         {text_column("quick"), quick}}));
}

std::string list_document(const std::vector<StressRow>& rows) {
  OrderedJson list = OrderedJson::array();
  for (const StressRow& row : rows)
    list.push_back({{"row", row.id},
                    {"topic", stress_topic(row.id)},
                    {"scene", row.scene},
                    {"name", row.name},
                    {"quick", row.is_quick}});
  return json_text(OrderedJson{{"rows", list}}, 2) + "\n";
}

void print_result(const StressResult& result, RowPrinter& print) {
  print(chosen(stress_table({&result, 1}),
               {"id", "scene", "name", "verdict", "figure", "limit", "iterations", "wall_s"}));
  if (result.outcome.verdict == StressVerdict::Pass) return;
  std::printf("       %s\n", result.outcome.message.c_str());
  std::fflush(stdout);
}

// Where the files go: `-o`, else the scene's result folder, else a folder here.
std::filesystem::path folder_of(const StressArguments& arguments, const std::optional<Scene>& scene) {
  if (!arguments.folder.empty()) return arguments.folder;
  return scene ? result_folder(*scene) : std::filesystem::path("stress");
}

// This very command, in a process of its own.
void solve_apart(const std::filesystem::path& scene, const std::filesystem::path& folder, double seconds) {
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string(),
                    limit = std::to_string(seconds);
  const char* words[] = {program.c_str(), "solve",         scene.c_str(), "-o",
                         folder.c_str(),  "--max-seconds", limit.c_str(), nullptr};
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  const int error =
      posix_spawn(&process, program.c_str(), &quiet, nullptr, const_cast<char* const*>(words), environ);
  posix_spawn_file_actions_destroy(&quiet);
  if (error != 0) throw std::runtime_error(std::string("no process can be started: ") + std::strerror(error));
  while (waitpid(process, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void stress(const StressArguments& arguments, Session& session) {
  listen_for_interrupts();
  std::optional<Scene> scene;
  if (!arguments.scene.empty()) scene = load_scene(arguments.scene);
  StressOptions options;
  if (!arguments.rows.empty()) options.rows = comma_list(arguments.rows);
  options.is_quick = arguments.is_quick;
  options.row_seconds = arguments.row_seconds;
  options.folder = folder_of(arguments, scene);
  options.solvers = all_solvers();
  options.factorisations = all_factorisations();
  options.checker = intersection_checker();
  options.is_cancelled = is_interrupted;
  options.solve_apart = solve_apart;
  RowPrinter print;
  options.report = [&](const StressResult& result) { print_result(result, print); };
  const std::vector<StressRow> rows = scene ? stress_rows(*scene, options) : stress_rows(options);
  if (arguments.lists) {
    session.document = list_document(rows);
    print_list(rows);
    return;
  }
  const OutputFolder output(options.folder);
  StressMatrix matrix = run_stress(rows, options);
  if (scene) {
    matrix.scene_file = scene->file.filename().string();
    matrix.scene_title = scene_title(*scene);
  }
  write_stress(options.folder, matrix);
  session.document = stress_json(matrix);
  std::printf("%s\nwritten to %s (stress.json, stress.csv, stress.html%s)\n", stress_summary(matrix).c_str(),
              options.folder.string().c_str(), scene ? "" : ", and the scenes");
  session.exit_code = matrix.holds() ? kConverged : kNotConverged;
}

}  // namespace

void add_stress_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<StressArguments>();
  CLI::App* command = app.add_subcommand(
      "stress",
      "Stability matrix: scenes at the end of what they can be asked for, and whether the answer holds");
  command->add_option("SCENE", arguments->scene, "Scene file (JSON); without one the built-in scenes");
  command->add_option("-o,--output", arguments->folder,
                      "Folder of the files (default: the scene's result folder; without a scene: stress)");
  command->add_option("--rows", arguments->rows,
                      "Ids of rows with commas between them: S1,S4 (default: all)");
  command->add_option("--time-limit", arguments->row_seconds, "Of each solve, in seconds (default: 20)")
      ->check(positive_defect);
  command->add_flag("--quick", arguments->is_quick, "Only the rows that take next to no time");
  command->add_flag("--list", arguments->lists, "List the rows and run none");
  command->callback([arguments, &session] { stress(*arguments, session); });
}

}  // namespace coapt::cli
