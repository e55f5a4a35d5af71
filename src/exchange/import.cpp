#include "exchange/import.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "exchange/detail/import_laws.hpp"
#include "exchange/detail/import_repair.hpp"
#include "exchange/detail/import_source.hpp"
#include "exchange/detail/law_doubts.hpp"
#include "exchange/detail/law_terms.hpp"
#include "exchange/detail/valve_curves.hpp"
#include "exchange/valve_doubts.hpp"
#include "exchange/valve_models.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/units.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/lower_extension.hpp"
#include "formats/whole_file.hpp"
#include "scene/build/build.hpp"
#include "valve/valve_check.hpp"
#include "valve/valve_import.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr const char* kUsualPressure = "120 mmHg";

// From here on a cascade of meshes saves more than it costs: half the time over eight rough valves of 6,000
// triangles. It would take half at 2,500 too, but 5 of 16 valves close in another shape than by their own
// path there (docs/decisions/019).
constexpr int kCascadeTriangles = 3000;

// Of a damped path, which leads to one shape in 136 of 144 solves in other orders and frames and by another
// method (docs/decisions/019): fewer steps let small changes decide on more valves.
constexpr int kDampedSteps = 20;

using detail::law_terms;
using detail::quoted;

void check_options(const ImportOptions& options) {
  std::vector<std::string> defects;
  const auto check = [&](const char* option, const std::string& text) {
    try {
      if (quantity_value(text, kPressure) <= 0) defects.push_back(std::string(option) + ": must be positive");
    } catch (const InputError& error) {
      defects.push_back(std::string(option) + ": " + error.what());
    }
  };
  if (!options.young.empty()) check("young", options.young);
  if (!options.chord_young.empty()) check("chord_young", options.chord_young);
  if (!options.pressure.empty()) check("pressure", options.pressure);
  const std::string& model = options.pressure_model;
  if (!model.empty() && model != "follower" && model != "frozen" && model != "field")
    defects.push_back("pressure model: read \"" + model +
                      "\"; a valve's free edge moves, so it takes one of follower, frozen, field");
  if (!options.contact.empty() && options.contact != "none" && options.contact != "barrier" &&
      options.contact != "facet")
    defects.push_back("contact: read \"" + options.contact + "\"; expected one of none, barrier, facet");
  if (!defects.empty()) throw InputError(defects);
}

// A pressure whose number of mmHg is whole is better read in mmHg.
std::string pressure_text(const Valve& valve, const ImportOptions& options) {
  if (!options.pressure.empty()) return options.pressure;
  if (valve.pressure <= 0) return kUsualPressure;
  const double mmhg = std::round(valve.pressure / quantity_value("1 mmHg", kPressure));
  std::string text = exact_text(mmhg) + " mmHg";
  constexpr double kSame = 1e-6;  // sources differ in the seventh digit of 1 mmHg
  if (mmhg > 0 && std::abs(quantity_value(text, kPressure) / valve.pressure - 1) < kSame) return text;
  return exact_text(valve.pressure) + " MPa";
}

// What a field load points to: the commissures, or the longest chord of the annulus from its first vertex.
std::string line_set(const Valve& valve) { return valve.commissures.size() >= 2 ? "commissures" : "annulus"; }

std::string load_text(const Valve& valve, const ImportOptions& options) {
  const std::string pressure = quoted(pressure_text(valve, options));
  if (options.pressure_model == "field") {
    return "    // Forces toward the line through the commissures, as large as the pressure on the open "
           "leaflets.\n"
           "    { \"type\": \"load_field\", \"toward_line\": " +
           quoted(line_set(valve)) + ", \"pressure\": " + pressure + " }";
  }
  return "    // Acts on the side that the normals point to.\n"
         "    { \"type\": \"load_pressure\", \"value\": " +
         pressure +
         ", \"model\": " + quoted(options.pressure_model.empty() ? "follower" : options.pressure_model) +
         ", \"side\": \"front\" }";
}

std::string listed_text(const std::vector<std::string>& entries) {
  std::string text;
  for (const std::string& entry : entries) text += (text.empty() ? "\n" : ",\n") + entry;
  return "[" + text + "\n  ]";
}

std::string support_text(const Support& support) {
  std::vector<std::string> axes;
  for (size_t c = 0; c < 3; ++c)
    if (support.axes[c]) axes.push_back(std::string(1, "xyz"[c]));
  std::string text = "    { \"nodes\": " + quoted(support.name) +
                     ", \"fix\": " + (axes.size() == 3 ? "true" : json_text(Json(axes)));
  if (support.closed.cols() > 0) text += ", \"move_to\": " + quoted(support.name + "_closed");
  return text + " }";
}

std::string boundary_text(const Valve& valve, const ImportOptions& options) {
  std::vector<std::string> entries;
  if (!valve.annulus.empty())
    entries.push_back(valve.annulus_closed.cols() > 0
                          ? "    { \"nodes\": \"annulus\", \"move_to\": \"annulus_closed\" }"
                          : "    { \"nodes\": \"annulus\", \"fix\": true }");
  // Tips are nodes of the chords' network, and without chords there is none.
  if (valve.chords.papillary.cols() > 0 && !valve.chords.chords.empty())
    entries.push_back(valve.chords.papillary_closed.cols() > 0
                          ? "    { \"nodes\": \"papillary\", \"move_to\": \"papillary_closed\" }"
                          : "    { \"nodes\": \"papillary\", \"fix\": true }");
  if (!options.held.empty())
    entries.push_back("    // " + options.held_remark + "\n    { \"nodes\": " + options.held +
                      ", \"fix\": true }");
  for (const Support& support : valve.supports) entries.push_back(support_text(support));
  return listed_text(entries);
}

std::string contact_of(const ImportOptions& options) {
  return options.contact.empty() ? "barrier" : options.contact;
}

std::string terms_text(const Valve& valve, const ImportOptions& options) {
  std::vector<std::string> terms = law_terms(valve, options);
  terms.push_back(load_text(valve, options));
  const std::string contact = contact_of(options);
  const bool has_range = contact == "facet" && !options.contact_range.empty();
  if (contact != "none")
    terms.push_back("    { \"type\": \"contact_" + contact + "\"" +
                    (has_range ? ", \"range\": " + quoted(options.contact_range) : "") + " }");
  return listed_text(terms);
}

std::string solver_text(const Valve& valve, const ImportOptions& options) {
  if (!options.solver.empty()) return "  \"solver\": " + options.solver;
  const std::string newton =
      "  \"solver\": { \"type\": \"newton\", \"tolerance\": " + exact_text(options.tolerance);
  const std::string cascade =
      valve.leaflets.triangle_count() < kCascadeTriangles ? "" : ", \"cascade\": true";
  if (contact_of(options) == "none" && !detail::resists_compression(options, valve))
    return "  // Without contact and where leaflets wrinkle, loads and motion come at once: of 60 valves "
           "that\n"
           "  // converge either way 59 closed in the shape of the damped path, which --damped-steps 20\n"
           "  // follows; the 51 of less than 3,000 triangles took 0.36 of its iterations.\n" +
           newton + cascade + " }";
  return "  // Loads and motion grow together along a damped path: up to three times the time of a solve\n"
         "  // at once, but of 36 valves, in other orders of vertices, turned and by another method, 136 of\n"
         "  // 144 solves came within 1e-5 mm of the first shape. --damped-steps 0 solves at once.\n" +
         newton + ", \"continuation\": { \"damped_steps\": " + std::to_string(kDampedSteps) + " }" + cascade +
         " }";
}

std::string scene_text(const Valve& valve, const ImportOptions& options) {
  std::string text = "{ // lengths in mm unless a unit is written\n";
  text += "  \"name\": " + quoted(valve.name.empty() ? "valve" : valve.name) + ",\n";
  text += "  \"mesh\": { \"file\": \"leaflets.obj\", \"sets\": \"valve.json\" },\n";
  text += "  \"boundary\": " + boundary_text(valve, options) + ",\n";
  text += "  \"terms\": " + terms_text(valve, options) + ",\n";
  text += solver_text(valve, options);
  if (valve.closed_reference) text += ",\n  \"reference\": { \"closed_surface\": \"closed_reference.obj\" }";
  return text + "\n}\n";
}

void append(std::vector<std::string>& list, const std::vector<std::string>& more) {
  list.insert(list.end(), more.begin(), more.end());
}

void apply_model(const std::string& file, Valve& valve, ImportOptions& options) {
  if (!options.young.empty() || !options.chord_young.empty())
    throw InputError(
        "import: --young and --chord-young have no meaning beside --model, which says what leaflets and "
        "chords are; leave one out");
  try {
    apply_valve_model(options.model, valve, options);
  } catch (const InputError& error) {
    throw error.within(file);
  }
}

// What the file does not state and the scene must have.
void complete_valve(const std::string& file, const ImportOptions& options, Valve& valve,
                    std::vector<std::string>& warnings) {
  if (!options.keeps_bulk) detail::leave_bulk_out(file, valve, warnings);
  detail::take_moduli(options, valve);
  if (detail::complete_thickness(options, valve))
    warnings.push_back(file + ": states no leaflet thickness; the scene has " +
                       exact_text(options.default_thickness) + " mm.");
  if (valve.pressure == 0 && options.pressure.empty())
    warnings.push_back(file + ": states no pressure; the scene has " + kUsualPressure + ".");
}

// What closes a valve presses on the side that the normals point to, whatever the sign of a number.
void refuse_negative_pressure(const std::string& file, const ImportOptions& options, const Valve& valve) {
  if (!(valve.pressure < 0) || !options.pressure.empty()) return;
  throw InputError(file + ": pressure.value: is negative (" + exact_text(valve.pressure) +
                   " MPa); give the size of the pressure, which acts on the side that the normals of the "
                   "triangles point to, and turn the triangles over where that is the wrong one; --pressure "
                   "gives another");
}

// Sizes of a valve that only a misread unit explains, and how to insist.
void refuse_sizes(const std::string& file, const Valve& valve) {
  std::vector<std::string> defects;
  for (const std::string& doubt : size_doubts(valve))
    defects.push_back(file + ": " + doubt + " --any-size imports it as it is.");
  if (!defects.empty()) throw InputError(defects);
}

// The valve with the laws of its scene, and whether this can be built at all.
void judge_scene(const Scene& scene, const Valve& valve, const std::string& file, Numbering numbering,
                 bool is_valve, std::vector<std::string>& warnings) {
  append(warnings, valve_doubts(valve, file, numbering, detail::chord_limits(scene)));
  try {
    const Model model = build(scene);
    if (!is_valve) return;
    for (const std::string& doubt : detail::law_doubts(scene, model)) warnings.push_back(file + ": " + doubt);
  } catch (const InputError& error) {
    for (const std::string& defect : error.defects())
      warnings.push_back("the scene cannot be solved as it is: " + defect);
  }
}

}  // namespace

std::optional<LinearLeaflets> linear_leaflets(const std::string& name) {
  if (name == "tension_field") return LinearLeaflets::TensionField;
  if (name == "stvk") return LinearLeaflets::ResistsCompression;
  if (name == "spring") return LinearLeaflets::Springs;
  return std::nullopt;
}

void write_valve_scene(const Valve& valve, const std::filesystem::path& out_dir,
                       const ImportOptions& options) {
  check_options(options);
  if (valve.leaflets.triangle_count() == 0) throw InputError(valve.name + ": the valve has no leaflets");
  std::error_code error;
  std::filesystem::create_directories(out_dir, error);
  if (error) throw InputError(out_dir.string() + ": cannot be made: " + error.message());
  write_valve(out_dir / "valve.json", valve);
  formats::write_whole(out_dir / "scene.json", scene_text(valve, options));
  if (!options.notes.empty()) formats::write_whole(out_dir / "README.md", options.notes);
}

std::vector<std::string> import_valve(const std::filesystem::path& file, const std::filesystem::path& out_dir,
                                      const ImportOptions& given) {
  ImportOptions options = given;
  std::vector<std::string> warnings;
  detail::ImportSource source = detail::read_source(file, options, warnings);
  Valve& valve = source.valve;
  if (valve.leaflets.triangle_count() == 0)
    throw InputError(file.string() + ": leaflets: missing; it must name the mesh file beside it");
  // Any mesh has a longest rim; an annulus has been named.
  const bool is_bare_mesh = !is_model_file(file) && formats::lower_extension(file) != ".json";
  bool is_valve = !is_bare_mesh && !valve.annulus.empty();
  detail::apply_curves(options, file.string(), valve, warnings);
  is_valve |=
      !valve.chords.chords.empty() || valve.chords.papillary.cols() > 0 || !options.annulus_closed.empty();
  refuse_negative_pressure(file.string(), options, valve);
  if (options.model.empty()) complete_valve(file.string(), options, valve, warnings);
  if (valve.annulus.empty() && valve.supports.empty())
    warnings.push_back(file.string() + ": names no annulus; nothing holds the leaflets' rim.");
  const auto loaded = [&] {
    Valve under_pressure = valve;
    under_pressure.pressure = quantity_value(pressure_text(valve, options), kPressure);
    return under_pressure;
  };
  if (is_valve && !options.takes_any_size) refuse_sizes(file.string(), loaded());
  const MeshRepair repair = detail::judge_leaflets(options, file.string(), source.numbering, valve, warnings);
  if (!options.model.empty()) apply_model(file.string(), valve, options);  // of the repaired mesh
  if (const std::string missing = detail::missing_chords(file.string(), options, valve); !missing.empty())
    warnings.push_back(missing);
  write_valve_scene(valve, out_dir, options);
  detail::write_repairs(out_dir / "repairs.csv", repair);
  Valve judged = loaded();
  if (!is_valve) judged.annulus.clear();  // a rim of any surface, whose side nobody knows
  judge_scene(load_scene(out_dir / "scene.json"), judged, file.string(), source.numbering, is_valve,
              warnings);
  return warnings;
}

}  // namespace coapt
