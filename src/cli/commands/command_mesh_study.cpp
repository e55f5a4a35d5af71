#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "formats/whole_file.hpp"
#include "results/standing.hpp"
#include "study/mesh_study.hpp"

#include <cstdio>
#include <memory>

namespace coapt::cli {
namespace {

struct MeshStudyArguments : StudyArguments {
  int levels = 2;
};

void study(const MeshStudyArguments& arguments, Session& session) {
  listen_for_interrupts();
  const Scene scene = load_scene(arguments.scene);
  const OutputFolder output(
      arguments.folder_for(scene, {"mesh_study.json", "mesh_study.csv", "closed_*.obj"}));
  const std::filesystem::path& folder = output.path();
  RowPrinter print;
  const MeshStudy found = study_mesh(
      scene, all_solvers(), arguments.levels, arguments.options(session), [&](const MeshLevel& level) {
        end_progress();
        print(chosen(level_table({&level, 1}), {"triangles", "status", "residual", "iterations", "wall_s",
                                                "cpu_s", "mean_to_previous_mm", "p95_to_previous_mm", "order",
                                                "orifice_area_mm2", "intersections"}));
        if (!level.doubts.empty())
          std::fputs(wrapped("in doubt: " + joined_doubts(level.doubts), 6).c_str(), stdout);
      });
  write_mesh_study(folder, found);
  session.document = formats::read_whole(folder / "mesh_study.json");
  std::printf("written to %s (mesh_study.json, mesh_study.csv, closed_*.obj)\n", folder.string().c_str());
  std::vector<std::vector<std::string>> doubts;
  for (const MeshLevel& level : found.levels) doubts.push_back(level.doubts);
  session.exit_code = exit_code_of(found.has_converged(), doubts);
}

}  // namespace

void add_mesh_study_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<MeshStudyArguments>();
  CLI::App* command = app.add_subcommand(
      "mesh-study", "How far the solution moves under uniform 1:4 refinement of the mesh, again and again");
  add_study_arguments(*command, *arguments);
  command
      ->add_option("--levels", arguments->levels,
                   "How often the mesh is cut (default: 2, 16 times the triangles)")
      ->check(CLI::Range(1, 5));
  command->callback([arguments, &session] { study(*arguments, session); });
}

}  // namespace coapt::cli
