#include "exchange/import.hpp"
#include "stress/scenes/built_in.hpp"
#include "valve/generators/mitral.hpp"

namespace coapt {
namespace {

StressScene written_valve(const std::filesystem::path& folder, int triangles, const std::string& contact) {
  ImportOptions options;
  options.contact = contact;
  options.tolerance = 1e-10;
  write_valve_scene(mitral_valve({.triangles = triangles, .preset = MitralPreset::Benchmark}), folder,
                    options);
  return stress_scene(load_scene(folder / "scene.json"));
}

}  // namespace

StressScene built_in_valve(const std::filesystem::path& folder, bool has_contact) {
  return written_valve(folder / (has_contact ? "valve_with_contact" : "valve"), 300,
                       has_contact ? "barrier" : "none");
}

StressScene large_valve(const std::filesystem::path& folder) {
  return written_valve(folder / "large_valve", 5200, "none");
}

}  // namespace coapt
