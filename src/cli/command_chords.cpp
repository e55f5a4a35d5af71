#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "core/error.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/lower_extension.hpp"
#include "formats/mesh_io.hpp"
#include "formats/utf8.hpp"
#include "mesh/mesh_check.hpp"
#include "valve/generators/leaflet_chords.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace coapt::cli {
namespace {

namespace fs = std::filesystem;

struct ChordsArguments {
  std::string input, output;
  std::vector<std::array<double, 3>> tips, closed_tips;
  std::vector<std::string> zones = {"free_edge"};
  LeafletChordOptions options;
};

Points points_of(const std::vector<std::array<double, 3>>& list) {
  Points points(3, static_cast<Eigen::Index>(list.size()));
  for (size_t k = 0; k < list.size(); ++k)
    points.col(static_cast<Eigen::Index>(k)) = Vec3(list[k][0], list[k][1], list[k][2]);
  return points;
}

// The valve without its chords: from a valve JSON, or a mesh alone. mm.
Valve read_input(const ChordsArguments& arguments) {
  Valve valve;
  std::vector<std::string> warnings;
  if (formats::lower_extension(arguments.input) == ".json") {
    ValveFile file = read_valve(arguments.input);
    valve = std::move(file.valve);
    warnings = std::move(file.warnings);
  } else {
    MeshFile file = read_mesh(arguments.input);
    valve.leaflets = std::move(file.mesh);
    valve.name = formats::as_utf8(fs::path(arguments.input).stem().string());
    warnings = std::move(file.warnings);
  }
  for (const std::string& warning : warnings) std::printf("warning: %s\n", warning.c_str());
  if (valve.leaflets.triangle_count() == 0)
    throw InputError(arguments.input + ": leaflets: missing; chords need a mesh to end on");
  std::vector<std::string> defects;
  for (const MeshDefect& defect : check_mesh(valve.leaflets, {.orientation_matters = false}))
    if (defect.severity == Severity::Error) defects.push_back(arguments.input + ": " + defect.message);
  if (!defects.empty()) throw InputError(defects);
  ChordNetwork tips;
  tips.papillary = valve.chords.papillary;
  tips.papillary_closed = valve.chords.papillary_closed;
  valve.chords = std::move(tips);
  if (!arguments.tips.empty()) {
    valve.chords.papillary = points_of(arguments.tips);
    valve.chords.papillary_closed = points_of(arguments.closed_tips);
  } else if (!arguments.closed_tips.empty()) {
    valve.chords.papillary_closed = points_of(arguments.closed_tips);
  }
  if (valve.chords.papillary.cols() == 0)
    throw InputError(arguments.input +
                     ": names no papillary points; give them as --tip X Y Z, once for each");
  return valve;
}

// The meshes are written beside the JSON: neither may take the place of the other or of what was read.
void check_output(const ChordsArguments& arguments) {
  if (formats::lower_extension(arguments.output) != ".json")
    throw InputError(arguments.output +
                     ": is to be a valve JSON, beside which the mesh is written as "
                     "leaflets.obj; give it a name that ends in .json");
  const fs::path folder = fs::absolute(arguments.output).parent_path();
  refuse_folder_of(arguments.input, folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
}

void make_chords(ChordsArguments& arguments) {
  check_output(arguments);
  arguments.options.zones.clear();
  for (const std::string& zone : arguments.zones) arguments.options.zones.push_back(chord_zone(zone));
  Valve valve = read_input(arguments);
  try {
    find_rims(valve);
    valve.chords = leaflet_chords(valve, arguments.options);
  } catch (const InputError& error) {
    throw error.within(arguments.input);
  }
  write_valve(arguments.output, valve);
  const auto& chords = valve.chords.chords;
  const auto taut = std::count_if(chords.begin(), chords.end(), [&](const Chord& chord) {
    const auto at = [&](const ChordEnd& end) -> Vec3 {
      if (end.kind == ChordEnd::Kind::Leaflet) return valve.leaflets.vertices.col(end.index);
      return end.kind == ChordEnd::Kind::Papillary ? valve.chords.papillary.col(end.index)
                                                   : valve.chords.junctions.col(end.index);
    };
    return (at(chord.from) - at(chord.to)).norm() > (1 + 1e-9) * chord.rest_length;
  });
  std::printf(
      "written: %s\n         %zu chords, %d branch points; %ld chords pull in the open valve\n"
      "next:    coapt import %s -o FOLDER\n",
      arguments.output.c_str(), chords.size(), static_cast<int>(valve.chords.junctions.cols()),
      static_cast<long>(taut), arguments.output.c_str());
}

}  // namespace

void add_chords_command(CLI::App& app, int& /*exit_code*/) {
  const auto arguments = std::make_shared<ChordsArguments>();
  LeafletChordOptions& options = arguments->options;
  CLI::App* command = app.add_subcommand(
      "chords", "Make chords where an image shows none: a valve JSON with leaflets, rims, tips and chords");
  command->add_option("INPUT", arguments->input, "Valve JSON (its chords are replaced), or a mesh in mm")
      ->required();
  command
      ->add_option("-o,--output", arguments->output, "Valve JSON to write, in another folder than the input")
      ->required();
  command
      ->add_option("--tip", arguments->tips,
                   "Papillary tip X Y Z [mm], once for each; default: those of the JSON")
      ->take_all();
  command
      ->add_option("--closed-tip", arguments->closed_tips,
                   "The same in the closed valve, for all tips or none")
      ->take_all();
  command->add_option("--zones", arguments->zones, "Where chords end: some of free_edge, rough, basal")
      ->check(CLI::IsMember(chord_zone_names()))
      ->capture_default_str();
  command->add_option("--count", options.count, "Chords of each zone that leave the tips")
      ->capture_default_str();
  command->add_option("--levels", options.levels, "1: straight chords, 2: trunks with fans, ...")
      ->capture_default_str();
  command->add_option("--branches", options.branches, "Branches at each branch point")->capture_default_str();
  command->add_option("--scale", options.scale, "Factor on all rest lengths")->capture_default_str();
  command
      ->add_option("--depth", options.depth, "Of the ends below the annulus plane in the closed valve [mm]")
      ->capture_default_str();
  command->add_option(
      "--level-areas", options.level_areas,
      "Cross-section of one chord at each level [mm2]; default: by zone, shared out at branch points");
  command->add_option("--seed", options.seed, "0: equal steps; any other shifts the ends")
      ->capture_default_str();
  command->callback([arguments] { make_chords(*arguments); });
}

}  // namespace coapt::cli
