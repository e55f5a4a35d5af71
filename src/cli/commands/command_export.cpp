#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/session.hpp"
#include "cli/written_document.hpp"
#include "core/error.hpp"
#include "exchange/export.hpp"
#include "formats/json/markups.hpp"

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace coapt::cli {

void add_export_command(CLI::App& app, Session& session) {
  struct Arguments {
    std::string from, out, what = "annulus";
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand(
      "export",
      "Write a scene as a FEBio model, its mesh, or its annulus and papillary points for 3D Slicer");
  command->add_option("SCENE", arguments->from, "Scene file (JSON), or a mesh to convert")->required();
  command
      ->add_option("-o,--output", arguments->out,
                   "File to write; its extension says what: .feb, .obj, .ply, .stl, .off, .vtp or .mrk.json")
      ->required();
  CLI::Option* points =
      command
          ->add_option(
              "--points", arguments->what,
              "Which points go into a .mrk.json: a set of nodes, or with _closed behind it where they go")
          ->capture_default_str();
  command->callback([arguments, points, &session] {
    if (points->count() > 0 && !is_markup_file(arguments->out))
      throw InputError("--points: chooses the points of a .mrk.json, which " + arguments->out +
                       " is not; leave it out");
    const std::vector<std::string> warnings = export_file(arguments->from, arguments->out, arguments->what);
    for (const std::string& warning : warnings) std::printf("warning: %s\n", warning.c_str());
    std::printf("written: %s\n", arguments->out.c_str());
    session.document = written_document({arguments->out}, warnings);
  });
}

}  // namespace coapt::cli
