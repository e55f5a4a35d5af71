#include "scene/import.hpp"

#include "core/error.hpp"
#include "scene/detail/read_json.hpp"
#include "scene/units.hpp"
#include "scene/valve_json.hpp"

#include <charconv>
#include <cmath>

namespace coapt {
namespace {

constexpr const char* kUsualPressure = "120 mmHg";

// The shortest digits that read back as the same number.
std::string digits(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

std::string quoted(const std::string& text) { return Json(text).dump(); }

void check_options(const ImportOptions& options) {
  std::vector<std::string> defects;
  const auto check = [&](const char* option, const std::string& text) {
    try {
      if (quantity_value(text, kPressure) <= 0) defects.push_back(std::string(option) + ": must be positive");
    } catch (const InputError& error) {
      defects.push_back(std::string(option) + ": " + error.what());
    }
  };
  check("young", options.young);
  check("chord_young", options.chord_young);
  if (!options.pressure.empty()) check("pressure", options.pressure);
  const std::string& model = options.pressure_model;
  if (model != "follower" && model != "frozen" && model != "field")
    defects.push_back("pressure model: read \"" + model +
                      "\"; a valve's free edge moves, so it takes one of follower, frozen, field");
  if (options.contact != "none" && options.contact != "barrier" && options.contact != "facet")
    defects.push_back("contact: read \"" + options.contact + "\"; expected one of none, barrier, facet");
  if (options.membrane != "tension_field" && options.membrane != "stvk")
    defects.push_back("membrane: read \"" + options.membrane + "\"; expected one of tension_field, stvk");
  if (!defects.empty()) throw InputError(defects);
}

// A pressure whose number of mmHg is whole is better read in mmHg.
std::string pressure_text(const Valve& valve, const ImportOptions& options) {
  if (!options.pressure.empty()) return options.pressure;
  if (valve.pressure <= 0) return kUsualPressure;
  const double mmhg = std::round(valve.pressure / quantity_value("1 mmHg", kPressure));
  const std::string text = digits(mmhg) + " mmHg";
  constexpr double kSame = 1e-6;  // sources differ in the seventh digit of 1 mmHg
  if (mmhg > 0 && std::abs(quantity_value(text, kPressure) / valve.pressure - 1) < kSame) return text;
  return digits(valve.pressure) + " MPa";
}

// The line that a field load points to: the commissures, or the longest chord of the annulus from its
// first vertex, which needs no name.
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
         pressure + ", \"model\": " + quoted(options.pressure_model) + ", \"side\": \"front\" }";
}

std::string boundary_text(const Valve& valve) {
  std::vector<std::string> entries;
  if (!valve.annulus.empty())
    entries.push_back(valve.annulus_closed.cols() > 0
                          ? "    { \"nodes\": \"annulus\", \"move_to\": \"annulus_closed\" }"
                          : "    { \"nodes\": \"annulus\", \"fix\": true }");
  if (valve.chords.papillary.cols() > 0)
    entries.push_back(valve.chords.papillary_closed.cols() > 0
                          ? "    { \"nodes\": \"papillary\", \"move_to\": \"papillary_closed\" }"
                          : "    { \"nodes\": \"papillary\", \"fix\": true }");
  std::string text;
  for (const std::string& entry : entries) text += (text.empty() ? "\n" : ",\n") + entry;
  return "[" + text + "\n  ]";
}

std::string terms_text(const Valve& valve, const ImportOptions& options) {
  const double thickness = valve.thickness > 0 ? valve.thickness : options.default_thickness;
  std::vector<std::string> terms;
  const bool relaxes = options.membrane == "tension_field";
  terms.push_back("    { \"type\": " + quoted("cst_" + options.membrane) +
                  ", \"name\": \"leaflets\", \"young\": " + quoted(options.young) +
                  ", \"poisson\": " + digits(options.poisson) +
                  ",\n      \"thickness\": " + quoted(digits(thickness) + " mm") + " }");
  if (relaxes)
    terms.push_back(
        "    // Plate stiffness of the same sheet: it decides how the wrinkled parts lie.\n"
        "    { \"type\": \"bending\" }");
  if (!valve.chords.chords.empty())
    terms.push_back(
        "    // Tension only; rest lengths and cross-sections come from the network.\n"
        "    { \"type\": \"cable\", \"name\": \"chords\", \"network\": \"valve.json\", \"young\": " +
        quoted(options.chord_young) + " }");
  terms.push_back(load_text(valve, options));
  if (options.contact != "none") terms.push_back("    { \"type\": \"contact_" + options.contact + "\" }");
  std::string text;
  for (const std::string& term : terms) text += (text.empty() ? "\n" : ",\n") + term;
  return "[" + text + "\n  ]";
}

std::string scene_text(const Valve& valve, const ImportOptions& options) {
  std::string text = "{ // lengths in mm unless a unit is written\n";
  text += "  \"name\": " + quoted(valve.name.empty() ? "valve" : valve.name) + ",\n";
  text += "  \"mesh\": { \"file\": \"leaflets.obj\", \"sets\": \"valve.json\" },\n";
  text += "  \"boundary\": " + boundary_text(valve) + ",\n";
  text += "  \"terms\": " + terms_text(valve, options) + ",\n";
  text += "  \"solver\": { \"type\": \"newton\", \"tolerance\": " + digits(options.tolerance) + " }";
  if (valve.closed_reference) text += ",\n  \"reference\": { \"closed_surface\": \"closed_reference.obj\" }";
  return text + "\n}\n";
}

}  // namespace

void write_valve_scene(const Valve& valve, const std::filesystem::path& out_dir,
                       const ImportOptions& options) {
  check_options(options);
  if (valve.leaflets.triangle_count() == 0) throw InputError(valve.name + ": the valve has no leaflets");
  std::error_code error;
  std::filesystem::create_directories(out_dir, error);
  if (error) throw InputError(out_dir.string() + ": cannot be made: " + error.message());
  write_valve(out_dir / "valve.json", valve);
  write_text(out_dir / "scene.json", scene_text(valve, options));
}

std::vector<std::string> import_valve(const std::filesystem::path& valve_json,
                                      const std::filesystem::path& out_dir, const ImportOptions& options) {
  ValveFile file = read_valve(valve_json);
  if (file.valve.leaflets.triangle_count() == 0)
    throw InputError(valve_json.string() + ": leaflets: missing; it must name the mesh file beside it");
  std::vector<std::string> warnings = std::move(file.warnings);
  if (file.valve.thickness == 0)
    warnings.push_back(valve_json.string() + ": states no leaflet thickness; the scene has " +
                       digits(options.default_thickness) + " mm.");
  if (file.valve.pressure == 0 && options.pressure.empty())
    warnings.push_back(valve_json.string() + ": states no pressure; the scene has " + kUsualPressure + ".");
  if (file.valve.annulus.empty())
    warnings.push_back(valve_json.string() + ": names no annulus; nothing holds the leaflets' rim.");
  write_valve_scene(file.valve, out_dir, options);
  return warnings;
}

}  // namespace coapt
