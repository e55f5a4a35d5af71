#include "valve/generators/rough_valve.hpp"

#include "core/error.hpp"
#include "mesh/distance/intersections.hpp"
#include "valve/generators/rough_chords.hpp"
#include "valve/generators/rough_mesh.hpp"
#include "valve/generators/rough_tissue.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace coapt {
namespace {

constexpr int kLeastTriangles = 250;
constexpr double kMmHg = 133.322368e-6;  // [MPa]

// What is drawn apart, so that more draws of one part change no other.
constexpr std::uint64_t kGeneral = 0, kShape = 1, kChords = 2, kTissue = 3, kTriangles = 4;

RandomSource stream(const RoughOptions& options, std::uint64_t part) {
  return RandomSource(options.seed, part + (options.kind == RoughKind::Mitral ? 0 : 1000));
}

int triangles_of(const RoughOptions& options, RandomSource& random) {
  const int drawn = static_cast<int>(std::lround(random.log_between(300, 20000)));
  return options.triangles == 0 ? drawn : options.triangles;
}

// A mesh that does not run through itself: the surface does not, and finer triangles follow it; a few of the
// coarsest meshes need another try.
RoughMesh separate_mesh(const RoughSurface& surface, int triangles, const RoughOptions& options) {
  constexpr int kTries = 20;
  for (std::uint64_t attempt = 0; attempt < kTries; ++attempt) {
    RandomSource random = stream(options, kTriangles + attempt);
    RoughMesh mesh = rough_mesh(surface, triangles, random);
    if (intersections(mesh.leaflets.vertices, mesh.leaflets.triangles).empty()) return mesh;
  }
  throw std::logic_error("rough valve, seed " + std::to_string(options.seed) +
                         ": every mesh runs through itself");
}

}  // namespace

Valve rough_valve(const RoughOptions& options) {
  if (options.triangles != 0 && options.triangles < kLeastTriangles)
    throw InputError("rough valve: triangles is " + std::to_string(options.triangles) +
                     ": ask for at least " + std::to_string(kLeastTriangles));
  const bool is_mitral = options.kind == RoughKind::Mitral;
  RandomSource general = stream(options, kGeneral), shape = stream(options, kShape),
               trees = stream(options, kChords), tissue = stream(options, kTissue);
  const int triangles = triangles_of(options, general);
  const double mmhg = std::round(is_mitral ? general.between(60, 150) : general.between(15, 45));
  const RoughSurface surface = rough_surface(options.kind, shape);
  RoughMesh mesh = separate_mesh(surface, triangles, options);

  Valve valve;
  valve.name = std::string("rough ") + (is_mitral ? "mitral" : "tricuspid") + " valve, seed " +
               std::to_string(options.seed);
  valve.pressure = mmhg * kMmHg;
  valve.chords = rough_chords(surface, mesh, trees);
  valve.annulus_closed.resize(3, static_cast<int>(mesh.annulus.size()));
  for (size_t i = 0; i < mesh.annulus.size(); ++i)
    valve.annulus_closed.col(static_cast<int>(i)) = surface.closed(mesh.coordinates(0, mesh.annulus[i]), 0);
  valve.leaflets = std::move(mesh.leaflets);
  valve.annulus = std::move(mesh.annulus);
  valve.free_edge = std::move(mesh.free_edge);
  valve.commissures = std::move(mesh.commissures);
  draw_tissue(tissue, valve);
  return valve;
}

}  // namespace coapt
