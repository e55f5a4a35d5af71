#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/progress.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "study/mesh_study.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <memory>

namespace coapt::cli {
namespace {

struct MeshStudyArguments : StudyArguments {
  int levels = 2;
};

void print_level_header() {
  std::printf("  %9s %10s %10s %10s  %26s %6s %10s\n", "triangles", "iterations", "s", "CPU s",
              "to the level before (95 %)", "order", "orifice");
}

void print_row(const MeshLevel& level) {
  std::printf("  %9d %10d %10.2f %10.2f", level.triangles, level.iterations, level.wall_s, level.cpu_s);
  if (level.to_previous)
    std::printf("  %14.4f (%.4f) mm", level.to_previous->mean, level.to_previous->p95);
  else
    std::printf("  %26s", "-");
  std::printf(level.order ? " %6.2f" : "      -", level.order.value_or(0));
  if (level.orifice_area_mm2) std::printf(" %6.2f mm2", *level.orifice_area_mm2);
  if (level.intersections > 0) std::printf("  %ld intersections", level.intersections);
  if (level.status != Status::Converged)
    std::printf("  %s, residual %.1e", std::string(status_name(level.status)).c_str(), level.residual);
  std::printf("\n");
  std::fflush(stdout);
}

void study(const MeshStudyArguments& arguments, int& exit_code) {
  listen_for_interrupts();
  const Scene scene = load_scene(arguments.scene);
  const std::filesystem::path folder = arguments.prepared_folder(scene);
  bool has_header = false;
  const MeshStudy found =
      study_mesh(scene, all_solvers(), arguments.levels, arguments.options(), [&](const MeshLevel& level) {
        end_progress();
        if (!has_header) print_level_header();
        has_header = true;
        print_row(level);
      });
  write_mesh_study(folder, found);
  std::printf("written to %s (mesh_study.json, mesh_study.csv, closed_*.obj)\n", folder.string().c_str());
  exit_code = found.has_converged() ? kConverged : kNotConverged;
}

}  // namespace

void add_mesh_study_command(CLI::App& app, int& exit_code) {
  const auto arguments = std::make_shared<MeshStudyArguments>();
  CLI::App* command = app.add_subcommand(
      "mesh-study", "How far the solution moves under uniform 1:4 refinement of the mesh, again and again");
  add_study_arguments(*command, *arguments);
  command
      ->add_option("--levels", arguments->levels,
                   "How often the mesh is cut (default: 2, 16 times the triangles)")
      ->check(CLI::Range(1, 5));
  command->callback([arguments, &exit_code] { study(*arguments, exit_code); });
}

}  // namespace coapt::cli
