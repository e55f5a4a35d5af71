#include "exchange/detail/import_source.hpp"

#include "core/error.hpp"
#include "exchange/detail/import_laws.hpp"
#include "exchange/detail/valve_curves.hpp"
#include "formats/file_numbering.hpp"
#include "formats/json/markups.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/lower_extension.hpp"
#include "formats/mesh_io.hpp"
#include "formats/utf8.hpp"
#include "valve/other_files.hpp"
#include "valve/valve_import.hpp"

namespace coapt::detail {
namespace {

// A surface alone: its longest rim is the annulus, and the other one, if there is one, the free edge.
Valve valve_of_mesh(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  MeshFile read = read_mesh(file);
  warnings.insert(warnings.end(), read.warnings.begin(), read.warnings.end());
  Valve valve;
  valve.name = formats::as_utf8(file.stem().string());
  valve.leaflets = std::move(read.mesh);
  choose_annulus(valve, {});
  return valve;
}

}  // namespace

ImportSource read_source(const std::filesystem::path& file, ImportOptions& options,
                         std::vector<std::string>& warnings) {
  if (is_markup_file(file))
    throw InputError(
        file.string() +
        ": points and curves alone are no valve; give its leaflets (a mesh) and this file behind "
        "--annulus-closed or --papillary");
  if (is_model_file(file)) {
    ValveModel model = read_model(file);
    warnings.insert(warnings.end(), model.warnings.begin(), model.warnings.end());
    if (options.model.empty() && options.pressure_model.empty() && model.is_pressure_dead)
      options.pressure_model = "frozen";
    if (options.model.empty() && options.contact.empty() && !model.has_contact) {
      options.contact = "none";
      warnings.push_back(file.string() + ": has no contact, nor has the scene; --contact barrier adds it.");
    }
    apply_membrane_option(options, model.valve);
    return {std::move(model.valve), {}};
  }
  if (formats::lower_extension(file) != ".json") return {valve_of_mesh(file, warnings), file_numbering(file)};
  refuse_scene(read_json(file), file);
  ValveFile read = read_valve(file);
  warnings.insert(warnings.end(), read.warnings.begin(), read.warnings.end());
  for (auto& [region, law] : read.valve.membranes) take_membrane_option(options, true, law);
  return {std::move(read.valve), read.numbering};
}

std::string missing_chords(const std::string& file, const ImportOptions& options, const Valve& valve) {
  const bool is_held = !valve.supports.empty() || !options.held.empty();
  if (!valve.chords.chords.empty() || valve.chords.papillary.cols() > 0 || is_held) return "";
  if (boundary_loops(valve.leaflets.triangles).size() != 2) return "";
  return file +
         ": brings no chords, and nothing else holds its free edge: the leaflets of a mitral or tricuspid "
         "valve "
         "turn over under pressure. `coapt chords " +
         file +
         " -o FOLDER/valve.json --tip X Y Z --tip X Y Z` makes some from the papillary tips [mm], or without "
         "--tip from two that it places itself; then `coapt import FOLDER/valve.json`. Where tips are points "
         "of "
         "3D Slicer, --papillary FILE.mrk.json of this command does.";
}

}  // namespace coapt::detail
