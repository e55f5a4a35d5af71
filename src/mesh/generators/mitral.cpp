#include "mesh/generators/mitral.hpp"

#include "core/error.hpp"
#include "mesh/generators/mitral_chords.hpp"
#include "mesh/generators/mitral_mesh.hpp"

#include <string>
#include <utility>
#include <vector>

namespace coapt {

Valve mitral_valve(const MitralOptions& options) {
  Valve valve = mitral_valve(mitral_dimensions(options.seed), options.triangles, options.branches);
  if (options.seed != 0) valve.name += ", seed " + std::to_string(options.seed);
  return valve;
}

Valve mitral_valve(const MitralDimensions& dimensions, int triangles, int branches) {
  constexpr double kSystolicPressure = 0.0159986842;  // 120 mmHg [MPa]
  std::vector<std::string> defects;
  if (triangles < 100)
    defects.push_back("mitral valve: triangles is " + std::to_string(triangles) + ": ask for at least 100");
  if (branches < 2 || branches > 5)
    defects.push_back("mitral valve: branches is " + std::to_string(branches) + ": give 2 to 5");
  if (!defects.empty()) throw InputError(defects);

  const MitralShape shape = mitral_shape(dimensions);
  MitralMesh mesh = mitral_mesh(shape, triangles);
  Valve valve;
  valve.name = "parametric mitral valve";
  valve.chords = mitral_chords(shape, mesh, branches);
  valve.annulus_closed.resize(3, static_cast<int>(mesh.annulus.size()));
  for (size_t i = 0; i < mesh.annulus.size(); ++i)
    valve.annulus_closed.col(static_cast<int>(i)) =
        mitral_closed_point(shape, mesh.coordinates(0, mesh.annulus[i]), 0);
  valve.leaflets = std::move(mesh.leaflets);
  valve.annulus = std::move(mesh.annulus);
  valve.free_edge = std::move(mesh.free_edge);
  valve.commissures = std::move(mesh.commissures);
  valve.pressure = kSystolicPressure;
  valve.thickness = dimensions.thickness;
  return valve;
}

}  // namespace coapt
