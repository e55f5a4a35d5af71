#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/session.hpp"
#include "cli/written_document.hpp"
#include "core/error.hpp"
#include "formats/file_numbering.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/lower_extension.hpp"
#include "formats/mesh_io.hpp"
#include "formats/utf8.hpp"
#include "mesh/mesh_check.hpp"
#include "valve/generators/leaflet_chords.hpp"
#include "valve/other_files.hpp"
#include "valve/valve_check.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace coapt::cli {
namespace {

namespace fs = std::filesystem;

struct ChordsArguments {
  std::string input, output, lengths;
  bool leaves_tips_out = false;
  std::vector<std::string> insertions;  // one text of numbers for each group
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

// "3,17,25" as numbers of vertices.
std::vector<int> numbers_of(const std::string& text) {
  std::vector<int> numbers;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    int number = 0;
    const char *begin = word.data(), *end = begin + word.size();
    if (const auto [rest, error] = std::from_chars(begin, end, number); error != std::errc() || rest != end)
      throw InputError("--insertions: read \"" + word + "\" in \"" + text +
                       "\"; give numbers of vertices, from 0 on, with commas between them");
    numbers.push_back(number);
  }
  return numbers;
}

// The valve without its chords: from a valve JSON, or a mesh alone. mm.
Valve read_input(const ChordsArguments& arguments, std::vector<std::string>& warnings) {
  Valve valve;
  Numbering numbering = file_numbering(arguments.input);
  if (formats::lower_extension(arguments.input) == ".json") {
    refuse_scene(read_json(arguments.input), arguments.input);
    ValveFile file = read_valve(arguments.input);
    valve = std::move(file.valve);
    numbering = file.numbering;
    warnings = std::move(file.warnings);
  } else {
    MeshFile file = read_mesh(arguments.input);
    valve.leaflets = std::move(file.mesh);
    valve.name = formats::as_utf8(fs::path(arguments.input).stem().string());
    warnings = std::move(file.warnings);
  }
  for (const std::string& doubt : size_doubts(valve)) warnings.push_back(arguments.input + ": " + doubt);
  for (const std::string& warning : warnings) std::printf("warning: %s\n", warning.c_str());
  if (valve.leaflets.triangle_count() == 0)
    throw InputError(arguments.input + ": leaflets: missing; chords need a mesh to end on");
  std::vector<std::string> defects;
  for (const MeshDefect& defect :
       check_mesh(valve.leaflets, {.orientation_matters = false, .numbering = numbering}))
    if (defect.severity == Severity::Error) defects.push_back(arguments.input + ": " + defect.message);
  if (!defects.empty()) throw InputError(defects);
  ChordNetwork tips;
  if (!arguments.leaves_tips_out) {
    tips.papillary = valve.chords.papillary;
    tips.papillary_closed = valve.chords.papillary_closed;
  }
  valve.chords = std::move(tips);
  if (!arguments.tips.empty()) {
    valve.chords.papillary = points_of(arguments.tips);
    valve.chords.papillary_closed = points_of(arguments.closed_tips);
  } else if (!arguments.closed_tips.empty()) {
    valve.chords.papillary_closed = points_of(arguments.closed_tips);
  }
  if (valve.chords.papillary.cols() == 0 && valve.chords.papillary_closed.cols() > 0)
    throw InputError(arguments.input +
                     ": names closed papillary points and no open ones; give these as --tip X Y Z, once for "
                     "each");
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
}

// What was not known and has been chosen.
void say_tips(const Valve& valve, ChordLengths lengths) {
  std::printf(
      "tips:    not known; two are placed by the centroids of the insertions, as far below them as they are\n"
      "         below the annulus plane (Walczak et al. 2019); --tip X Y Z, once for each, gives others\n");
  for (int tip = 0; tip < valve.chords.papillary.cols(); ++tip) {
    const Vec3 at = valve.chords.papillary.col(tip);
    const auto& chords = valve.chords.chords;
    const auto count = std::count_if(chords.begin(), chords.end(), [&](const Chord& chord) {
      return chord.from.kind == ChordEnd::Kind::Papillary && chord.from.index == tip;
    });
    std::printf("         tip %d at %.2f %.2f %.2f mm, with %ld chords\n", tip, at[0], at[1], at[2],
                static_cast<long>(count));
  }
  std::printf("lengths: %s\n",
              lengths == ChordLengths::Sum
                  ? "distance of the insertion from the annulus plane and from the tip, summed"
              : lengths == ChordLengths::ToPlane
                  ? "distance of the tip from where the insertion is expected on the plane"
                  : "distance of the tip from where the insertion is expected, free edges below the plane");
}

void choose_lengths(ChordsArguments& arguments, bool has_tips) {
  if (arguments.lengths.empty())
    arguments.lengths = !has_tips && arguments.options.levels == 1 ? "sum" : "coapted";
  arguments.options.lengths = chord_lengths(arguments.lengths);
}

std::string make_chords(ChordsArguments& arguments) {
  check_output(arguments);
  const OutputFolder output(fs::absolute(arguments.output).parent_path());
  for (const std::string& group : arguments.insertions)
    arguments.options.insertions.push_back(numbers_of(group));
  arguments.options.zones.clear();
  for (const std::string& zone : arguments.zones) arguments.options.zones.push_back(chord_zone(zone));
  std::vector<std::string> warnings;
  Valve valve = read_input(arguments, warnings);
  const bool has_tips = valve.chords.papillary.cols() > 0;
  choose_lengths(arguments, has_tips);
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
  if (!has_tips) say_tips(valve, arguments.options.lengths);
  std::printf(
      "written: %s\n         %zu chords, %d branch points; %ld chords pull in the open valve\n"
      "next:    coapt import %s -o FOLDER\n",
      arguments.output.c_str(), chords.size(), static_cast<int>(valve.chords.junctions.cols()),
      static_cast<long>(taut), arguments.output.c_str());
  return written_document({arguments.output}, warnings);
}

}  // namespace

void add_chords_command(CLI::App& app, Session& session) {
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
                   "Papillary tip X Y Z [mm], once for each; default: those of the JSON, or else two "
                   "placed by the insertions (Walczak et al. 2019)")
      ->take_all();
  command
      ->add_option("--closed-tip", arguments->closed_tips,
                   "The same in the closed valve, for all tips or none")
      ->take_all();
  command->add_flag("--unseen-tips", arguments->leaves_tips_out,
                    "Leave out the tips of the JSON: two are placed by the insertions");
  CLI::Option* zones =
      command->add_option("--zones", arguments->zones, "Where chords end: some of free_edge, rough, basal")
          ->check(CLI::IsMember(chord_zone_names()))
          ->capture_default_str();
  CLI::Option* count =
      command->add_option("--count", options.count, "Chords of each zone that leave the tips")
          ->capture_default_str();
  command
      ->add_option(
          "--insertions", arguments->insertions,
          "Vertices (from 0 on, \"3,17,25\") at which chords end, in the place of zones; once, or once for "
          "each tip")
      ->excludes(zones)
      ->excludes(count)
      ->take_all();
  command
      ->add_option(
          "--lengths", arguments->lengths,
          "Rest lengths: from the tip to the insertion's place in the closed valve, on the annulus "
          "plane or, with `coapted`, free edges as far below as leaflets hang where they meet; or the "
          "sum of its distances from plane and tip (default: coapted; sum for straight chords from "
          "tips that are not known)")
      ->check(CLI::IsMember({"coapted", "plane", "sum"}));
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
  command->callback([arguments, &session] { session.document = make_chords(*arguments); });
}

}  // namespace coapt::cli
