#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/scene_arguments.hpp"
#include "cli/session.hpp"
#include "exchange/import.hpp"
#include "exchange/valve_models.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace coapt::cli {
namespace {

struct ImportArguments : SceneArguments {
  std::string file, annulus_closed, papillary, papillary_closed, young, chord_young, model;
  std::string bulk = "none";
  bool is_incompressible = false, keeps_mesh = false, takes_any_size = false;
};

std::string import_file(const ImportArguments& arguments) {
  refuse_folder_of(arguments.file, arguments.folder);
  const OutputFolder output(arguments.folder);
  ImportOptions options = import_options(arguments);
  options.keeps_bulk = arguments.bulk == "stated";
  options.repairs = !arguments.keeps_mesh;
  options.takes_any_size = arguments.takes_any_size;
  options.model = arguments.model;
  options.young = arguments.young;
  options.chord_young = arguments.chord_young;
  options.annulus_closed = arguments.annulus_closed;
  options.papillary = arguments.papillary;
  options.papillary_closed = arguments.papillary_closed;
  const std::vector<std::string> warnings = import_valve(arguments.file, arguments.folder, options);
  for (const std::string& warning : warnings) std::printf("warning: %s\n", warning.c_str());
  return announce_scene(arguments.folder, warnings);
}

}  // namespace

void add_import_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<ImportArguments>();
  CLI::App* command = app.add_subcommand(
      "import",
      "Write a scene from a valve JSON, an Abaqus or FEBio model, or a mesh with curves of 3D Slicer");
  command
      ->add_option("FILE", arguments->file,
                   "Valve JSON with its meshes beside it, .inp, .feb, or a mesh (.obj .ply .stl .off .vtp)")
      ->required();
  add_scene_options(*command, *arguments, {"follower", "frozen", "field"});
  CLI::Option* bulk =
      command
          ->add_option("--bulk", arguments->bulk,
                       "Bulk modulus of membrane laws: none, incompressible leaflets, or as stated")
          ->check(CLI::IsMember({"none", "stated"}))
          ->capture_default_str();
  command->add_flag("--incompressible", arguments->is_incompressible, "The same as --bulk none, the default")
      ->excludes(bulk);
  command->add_flag("--no-repair", arguments->keeps_mesh,
                    "Keep slivers of the mesh, which are otherwise flipped, cut off or collapsed");
  command->add_flag(
      "--any-size", arguments->takes_any_size,
      "Take a valve of a size, thickness or pressure that no heart has, which is otherwise refused");
  command->add_option("--young", arguments->young,
                      "Linear leaflets of this modulus (\"1 MPa\") in the place of the laws of the file");
  command->add_option("--chord-young", arguments->chord_young,
                      "Linear chords of this modulus (\"40 MPa\") in the place of the laws of the file");
  command->add_option("--annulus-closed", arguments->annulus_closed,
                      "Closed curve (.mrk.json) to which the annulus moves, matched by its length");
  command->add_option("--papillary", arguments->papillary,
                      "Points (.mrk.json): papillary tips for a valve without chords, tied to the free edge");
  command->add_option("--papillary-closed", arguments->papillary_closed,
                      "Points (.mrk.json) to which the papillary tips move, in their order");
  command
      ->add_option("--model", arguments->model,
                   "Tissue, chords, load or method of a published model in the place of the file's")
      ->check(CLI::IsMember(valve_model_names()))
      ->excludes("--membrane");
  command->callback([arguments, &session] { session.document = import_file(*arguments); });
}

}  // namespace coapt::cli
