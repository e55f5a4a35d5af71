#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/scene_arguments.hpp"
#include "cli/session.hpp"
#include "cli/shape_scenes.hpp"
#include "core/error.hpp"
#include "exchange/import.hpp"
#include "exchange/valve_models.hpp"
#include "formats/json/closed_curve.hpp"
#include "formats/json/markups.hpp"
#include "formats/whole_file.hpp"
#include "valve/generators/mitral.hpp"
#include "valve/generators/rough_valve.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace coapt::cli {
namespace {

struct GenerateArguments : SceneArguments {
  std::string what;
  int triangles = 2500;
  unsigned seed = 0, rough = 0;
  std::string annulus, papillary, model, preset = "closed";
  std::vector<double> anterior, ventricle;  // three numbers, or none
  std::vector<std::string> given;           // options on the command line
};

std::optional<Vec3> position_of(const std::vector<double>& numbers) {
  if (numbers.empty()) return std::nullopt;
  return Vec3(numbers.data());
}

Valve generated_mitral(const GenerateArguments& arguments) {
  const MitralOptions options{
      .triangles = arguments.triangles, .seed = arguments.seed, .preset = mitral_preset(arguments.preset)};
  if (arguments.annulus.empty()) return mitral_valve(options);
  MeasuredMitral measured;
  measured.name = arguments.annulus;
  measured.annulus = read_closed_curve(arguments.annulus);
  measured.sides = {position_of(arguments.anterior), position_of(arguments.ventricle)};
  if (!arguments.papillary.empty()) measured.papillary = papillary_points(arguments.papillary);
  return mitral_valve(options, measured);
}

// Options that say more of a measured annulus than there is.
void check_measured(const GenerateArguments& arguments) {
  const bool has_sides =
      !arguments.anterior.empty() || !arguments.ventricle.empty() || !arguments.papillary.empty();
  if (arguments.what != "mitral" && (has_sides || !arguments.annulus.empty()))
    throw InputError("--annulus, --papillary, --anterior and --ventricle belong to the shape mitral");
  if (arguments.annulus.empty() && has_sides)
    throw InputError("--papillary, --anterior and --ventricle need --annulus FILE");
}

bool is_given(const GenerateArguments& arguments, const char* option) {
  return std::find(arguments.given.begin(), arguments.given.end(), option) != arguments.given.end();
}

void write_shape(const GenerateArguments& arguments) {
  std::vector<std::string> defects;
  const std::vector<std::string> shapes = shape_names();
  const bool is_known = std::find(shapes.begin(), shapes.end(), arguments.what) != shapes.end();
  for (const char* option : {"--seed", "--membrane", "--model", "--preset"})
    if (is_known && is_given(arguments, option))
      defects.push_back(std::string(option) + ": belongs to the shape mitral; a " + arguments.what +
                        " has no such choice");
  if (!defects.empty()) throw InputError(defects);
  ShapeOptions options{.contact = arguments.contact, .pressure = arguments.pressure};
  if (is_given(arguments, "--triangles")) options.triangles = arguments.triangles;
  write_shape_scene(arguments.what, options, arguments.folder);
}

void write_rough(const GenerateArguments& arguments) {
  std::vector<std::string> defects;
  const bool is_mitral = arguments.what == "mitral";
  if (!is_mitral && arguments.what != "tricuspid")
    defects.push_back("--rough: belongs to the shapes mitral and tricuspid; there is no rough " +
                      arguments.what);
  for (const char* option : {"--seed", "--model", "--membrane", "--annulus", "--preset"})
    if (is_given(arguments, option))
      defects.push_back(std::string(option) + ": has no meaning beside --rough, which draws the whole valve");
  if (!defects.empty()) throw InputError(defects);
  const Valve valve =
      rough_valve({.kind = is_mitral ? RoughKind::Mitral : RoughKind::Tricuspid,
                   .seed = arguments.rough,
                   .triangles = is_given(arguments, "--triangles") ? arguments.triangles : 0});
  write_valve_scene(valve, arguments.folder, import_options(arguments));
}

void write_mitral(const GenerateArguments& arguments) {
  if (arguments.model.starts_with("hammer") && is_given(arguments, "--membrane"))
    throw InputError(
        "generate mitral: --membrane has no meaning beside --model, which says what the leaflets are; leave "
        "one out");
  Valve valve = generated_mitral(arguments);
  ImportOptions options = import_options(arguments);
  apply_membrane_option(options, valve);
  if (!arguments.model.empty()) apply_valve_model(arguments.model, valve, options);
  write_valve_scene(valve, arguments.folder, options);
}

// What the files that a shape is made of hold in the folder; of a shape that was generated there before.
std::map<std::string, std::string> generated_files(const std::filesystem::path& folder) {
  std::map<std::string, std::string> files;
  std::error_code error;
  for (const char* name : {"scene.json", "valve.json", "leaflets.obj", "closed_reference.obj", "mesh.obj",
                           "chain.json", "README.md"})
    if (std::filesystem::is_regular_file(folder / name, error))
      files.emplace(name, formats::read_whole(folder / name));
  return files;
}

// Of each file that held something else before.
std::vector<std::string> replaced_files(const std::map<std::string, std::string>& before,
                                        const std::filesystem::path& folder) {
  const std::map<std::string, std::string> now = generated_files(folder);
  std::vector<std::string> warnings;
  for (const auto& [name, content] : before)
    if (const auto found = now.find(name); found != now.end() && found->second != content)
      warnings.push_back((folder / name).string() + ": was there with other content, and is replaced");
  return warnings;
}

std::string generate(const GenerateArguments& arguments) {
  check_measured(arguments);
  const OutputFolder output(arguments.folder);
  const std::map<std::string, std::string> before = generated_files(output.path());
  if (is_given(arguments, "--rough")) {
    write_rough(arguments);
  } else if (arguments.what == "tricuspid") {
    throw InputError("generate tricuspid: there are only rough ones; say which with --rough SEED");
  } else if (arguments.what == "mitral") {
    write_mitral(arguments);
  } else {
    write_shape(arguments);
  }
  const std::vector<std::string> warnings = replaced_files(before, output.path());
  for (const std::string& warning : warnings) std::fprintf(stderr, "coapt: warning: %s\n", warning.c_str());
  return announce_scene(arguments.folder, warnings);
}

}  // namespace

void add_generate_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<GenerateArguments>();
  CLI::App* command =
      app.add_subcommand("generate", "Write a valve or a simple shape with a scene that is ready to solve");
  std::string shapes = "mitral, tricuspid (with --rough)";
  for (const std::string& name : shape_names()) shapes += ", " + name;
  command->add_option("SHAPE", arguments->what, shapes)->required();
  command
      ->add_option("--triangles", arguments->triangles,
                   "Wanted number of triangles; not of the catenary, which has none")
      ->check(CLI::Range(1, 10'000'000))
      ->capture_default_str();
  command
      ->add_option("--seed", arguments->seed, "Mitral: 0 is the mean valve, any other draws its dimensions")
      ->capture_default_str();
  command
      ->add_option("--preset", arguments->preset,
                   "Mitral: a valve within published ranges that closes, or the softer one with fewer chords "
                   "that tables of the documentation were made on")
      ->check(CLI::IsMember({"closed", "benchmark"}))
      ->capture_default_str();
  command->add_option(
      "--rough", arguments->rough,
      "Mitral and tricuspid: draw the whole valve, uneven in every way: slivers, slack and short "
      "chords, tissue, motion, pressure, and 300 to 20000 triangles unless they are given");
  command
      ->add_option("--model", arguments->model,
                   "Mitral: tissue, chords and load of a published model, with a README.md of what it says")
      ->check(CLI::IsMember(valve_model_names()));
  command->add_option(
      "--annulus", arguments->annulus,
      "Mitral: closed curve (.mrk.json, or three numbers a line, mm) that the annulus follows");
  command->add_option("--papillary", arguments->papillary,
                      "With --annulus: papillary tips, the lists of points of a .mrk.json");
  command
      ->add_option("--anterior", arguments->anterior,
                   "With --annulus: X Y Z on its anterior side (default: the flattened side)")
      ->expected(3);
  command
      ->add_option("--ventricle", arguments->ventricle,
                   "With --annulus: X Y Z on the side of the ventricle (default: by tips or saddle)")
      ->expected(3);
  add_scene_options(*command, *arguments, {"follower", "frozen", "volume", "field"});
  command->callback([arguments, command, &session] {
    for (const CLI::Option* option : command->get_options())
      if (option->count() > 0) arguments->given.push_back(option->get_name());
    session.document = generate(*arguments);
  });
}

}  // namespace coapt::cli
