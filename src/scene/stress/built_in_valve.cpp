#include "mesh/generators/mitral.hpp"
#include "scene/import.hpp"
#include "scene/stress/built_in.hpp"

namespace coapt {

StressScene built_in_valve(const std::filesystem::path& folder, bool has_contact) {
  constexpr int kTriangles = 300;
  const std::filesystem::path path = folder / (has_contact ? "valve_with_contact" : "valve");
  ImportOptions options;
  options.contact = has_contact ? "barrier" : "none";
  options.tolerance = 1e-10;
  write_valve_scene(mitral_valve({.triangles = kTriangles}), path, options);
  return stress_scene(load_scene(path / "scene.json"));
}

}  // namespace coapt
