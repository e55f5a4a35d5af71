// Solves a scene file with the installed library, as docs/library.md says.
#include <coapt/coapt.hpp>
#include <cstdio>

int main(int, char** argv) {
  const coapt::RunReport run = coapt::solve_scene(argv[1], {.writes = false});
  const coapt::Result& result = run.report.result;
  std::printf("%s, orifice %.2f mm2\n", result.message.c_str(),
              run.report.metrics.orifice_area_mm2.value_or(0));
  return result.status == coapt::Status::Converged ? 0 : 1;
}
