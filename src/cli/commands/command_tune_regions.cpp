#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "cli/study_options.hpp"
#include "core/error.hpp"
#include "formats/whole_file.hpp"
#include "results/standing.hpp"
#include "tuning/region_tuning.hpp"

#include <cstdio>
#include <memory>
#include <utility>

namespace coapt::cli {
namespace {

struct TuneRegionsArguments : StudyArguments {
  std::string regions = "14";
  RegionTuningOptions tuning;
  double orifice = 0, yield_strain = 0;
};

void print_state(const char* label, const TuningState& state) {
  std::printf("  %-22s greatest chord strain %.4f, %d chords beyond yield", label, state.max_chord_strain,
              state.strained_chords);
  if (state.strained_facets > 0) std::printf(", %d facets", state.strained_facets);
  if (state.orifice_area_mm2) std::printf(", orifice %.2f mm2", *state.orifice_area_mm2);
  std::printf("\n");
  std::fflush(stdout);
}

void tune(const TuneRegionsArguments& arguments, Session& session) {
  listen_for_interrupts();
  const Scene scene = load_scene(arguments.scene);
  RegionTuningOptions options = arguments.tuning;
  options.regions = arguments.regions == "mesh" ? 0 : std::stoi(arguments.regions);
  if (arguments.yield_strain > 0) options.yield_strain = arguments.yield_strain;
  if (arguments.orifice > 0) options.orifice_limit_mm2 = arguments.orifice;
  options.report = [](int round, const TuningState& state) {
    end_progress();
    print_state(("iteration " + std::to_string(round)).c_str(), state);
  };
  const OutputFolder output(
      arguments.folder_for(scene, {"region_tuning.json", "region_tuning.csv", "triangle_factors.csv"}));
  const std::filesystem::path& folder = output.path();
  const RegionTuning found = tune_regions(scene, all_solvers(), options, arguments.options(session));
  end_progress();
  std::printf("%s\n", found.message.c_str());
  print_state("before", found.before);
  print_state("after", found.after);
  for (const auto& [name, state] : {std::pair("before", &found.before), std::pair("after", &found.after)})
    if (!state->doubts.empty())
      std::printf("  %s in doubt: %s\n", name, joined_doubts(state->doubts).c_str());
  if (found.orifice_limit_mm2) std::printf("  %-22s %.2f mm2\n", "orifice at most", *found.orifice_limit_mm2);
  std::printf("  %-22s %d (%d not converged) in %d iterations, %.2f s\n", "solves", found.solves,
              found.failed_solves, found.rounds, found.wall_s);
  print_table(factor_table(found));
  write_region_tuning(folder, found);
  session.document = formats::read_whole(folder / "region_tuning.json");
  std::printf("written to %s (region_tuning.json, region_tuning.csv, triangle_factors.csv)\n",
              folder.string().c_str());
  session.exit_code = exit_code_of(found.is_reached, {found.after.doubts});
}

std::string regions_defect(const std::string& text) {
  const bool is_number =
      !text.empty() && text.size() < 5 && text.find_first_not_of("0123456789") == std::string::npos;
  if (text == "mesh" || (is_number && std::stoi(text) > 0)) return "";
  return "expected a number above 0, or \"mesh\" for the regions of the mesh";
}

}  // namespace

void add_tune_regions_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<TuneRegionsArguments>();
  CLI::App* command = app.add_subcommand(
      "tune-regions", "Stiffness of each leaflet region with which no chord exceeds its yield strain");
  add_study_arguments(*command, *arguments);
  RegionTuningOptions& tuning = arguments->tuning;
  command
      ->add_option(
          "--yield-strain", arguments->yield_strain,
          "That no chord may exceed (default: chords and leaflets each by the yield_strain of their term)")
      ->check(positive_defect);
  command
      ->add_option("--regions", arguments->regions,
                   "How many to split the leaflets into, or \"mesh\" for those of the mesh (default: 14)")
      ->check(regions_defect);
  CLI::Option* zones = command->add_option("--zones", tuning.zones, "From annulus to free edge (default: 2)")
                           ->check(CLI::Range(1, 10));
  command
      ->add_option("--orifice", arguments->orifice,
                   "Greatest orifice [mm2] (default: 2 % of the annulus area)")
      ->check(positive_defect);
  command->add_flag("--chord-sections", tuning.tunes_chords, "Tune the cross-sections of the chords too");
  command
      ->add_option("--greatest-factor", tuning.greatest_factor,
                   "On a stiffness; its inverse is the least (default: 10)")
      ->check(positive_defect)
      ->check(CLI::Range(1.001, 1e6));
  command->callback([arguments, zones, &session] {
    if (zones->count() > 0 && arguments->regions == "mesh")
      throw InputError("--zones: --regions mesh takes the regions of the mesh as they are; leave one out");
    tune(*arguments, session);
  });
}

}  // namespace coapt::cli
