// A mitral valve generated and closed under 120 mmHg, by the library alone. What scripts/demo runs.
//   closed_valve FOLDER
#include "exchange/import.hpp"
#include "results/result_warnings.hpp"
#include "run/solve_scene_file.hpp"
#include "valve/generators/mitral.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

namespace {

// Whether it is an equilibrium that nothing is to be said against, and closed.
bool is_closed(const coapt::Report& report) {
  return report.result.status == coapt::Status::Converged && report.warnings.empty() &&
         report.metrics.orifice_area_mm2.value_or(1e3) < 1;
}

bool close_valve(const std::filesystem::path& folder) {
  coapt::write_valve_scene(coapt::mitral_valve({.triangles = 2500}), folder);
  coapt::RunOptions options;
  options.folder = folder / "result";
  const coapt::RunReport run = coapt::solve_scene(folder / "scene.json", options);
  const coapt::Metrics& metrics = run.report.metrics;
  std::printf("%s\n", coapt::headline(run.report).text.c_str());
  for (const std::string& warning : run.report.warnings) std::printf("  warning: %s\n", warning.c_str());
  std::printf("  orifice %.2f of %.1f mm2, coaptation %.2f mm2, greatest strain %.4f, %.1f s\n",
              metrics.orifice_area_mm2.value_or(0), metrics.annulus_area_mm2.value_or(0),
              metrics.coaptation_area_mm2.value_or(0), metrics.max_principal_strain.value_or(0),
              run.report.result.wall_s);
  return is_closed(run.report);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: closed_valve FOLDER\n");
    return 2;
  }
  try {
    return close_valve(argv[1]) ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "closed_valve: %s\n", error.what());
    return 2;
  }
}
