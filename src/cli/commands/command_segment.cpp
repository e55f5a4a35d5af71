#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/images/segment_arguments.hpp"
#include "cli/output_folder.hpp"
#include "cli/session.hpp"
#include "formats/json/markups.hpp"
#include "formats/utf8.hpp"
#include "formats/whole_file.hpp"
#include "image/segment/write_segmentation.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>

namespace coapt::cli {
namespace {

void segment_volume(const SegmentArguments& arguments, Session& session) {
  refuse_folder_of(arguments.volume, arguments.output);
  Segmentation found = find_leaflets(arguments, printed_volume(arguments.volume, arguments.frame));
  found.valve.name = formats::as_utf8(std::filesystem::path(arguments.volume).stem().string());
  if (!arguments.papillary.empty()) found.valve.chords.papillary = papillary_points(arguments.papillary);
  const OutputFolder output(arguments.output);
  write_segmentation(arguments.output, found, arguments.volume, arguments.annulus);
  std::printf("written to %s (valve.json, leaflets.obj, leaflets.vtp, segmentation.json%s)\n",
              arguments.output.c_str(), arguments.keeps_evidence ? ", evidence.nrrd" : "");
  session.document = formats::read_whole(output.path() / "segmentation.json");
  std::printf("chords: coapt chords %s/valve.json -o FOLDER/valve.json\n", arguments.output.c_str());
}

}  // namespace

void add_segment_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<SegmentArguments>();
  CLI::App* command = app.add_subcommand(
      "segment", "Find the leaflets in a volume image: mesh, annulus, free edge, thickness, uncertainty");
  add_segment_options(*command, *arguments);
  command->add_option("-o,--output", arguments->output, "Folder to write")->required();
  command->callback([arguments, &session] { segment_volume(*arguments, session); });
}

}  // namespace coapt::cli
