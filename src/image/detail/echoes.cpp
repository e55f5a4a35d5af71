#include "image/detail/echoes.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace coapt {
namespace {

// Amplitudes of a volume of tissue in the root mean square, relative to blood: 30, 22 and 12 dB.
constexpr double kLeafletEcho = 31.6;
constexpr double kWallEcho = 12.6;
constexpr double kOutsideEcho = 4;
constexpr double kChordEcho = 31.6;
constexpr double kSpotEcho = 3;        // of a bright spot, times that of the leaflet
constexpr double kDropoutEcho = 0.03;  // of a patch of dropout, times that of the leaflet
constexpr double kGrazingEcho = 0.4;   // of a leaflet along the beam, times that of one across it
constexpr double kPointsPerCell = 2;   // scatterers of leaflets and chords in the volume of a cell
constexpr int kLeastPoints = 4;        // of a triangle or chord
constexpr double kShadowEcho = 0.08;   // of what lies behind a spot, times what it would be

// Circular complex Gaussian of unit mean square.
std::complex<float> gaussian(RandomSource& random) {
  const double modulus = std::sqrt(-std::log(1 - random.unit())),
               phase = 2 * std::numbers::pi * random.unit();
  return {static_cast<float>(modulus * std::cos(phase)), static_cast<float>(modulus * std::sin(phase))};
}

Vec3 place_on(const TriangleMesh& surface, int t, RandomSource& random) {
  const Eigen::Vector3i corners = surface.triangles.col(t);
  double u = random.unit(), v = random.unit();
  if (u + v > 1) u = 1 - u, v = 1 - v;
  return (1 - u - v) * surface.vertices.col(corners[0]) + u * surface.vertices.col(corners[1]) +
         v * surface.vertices.col(corners[2]);
}

// Of the field's cells at the reference depth [mm3].
double cell_volume(const EchoScene& scene, const BeamField& field) {
  const Vec3 step = field.beam(Vec3::Ones()) - field.beam(Vec3::Zero());
  return step.prod() * scene.reference_depth * scene.reference_depth;
}

// Echo of a volume at a depth, of tissue that echoes as blood: the receiver makes up for what is lost on the
// way.
double point_echo(const EchoScene& scene, double volume, double cell, double depth) {
  return std::sqrt(volume / cell) * scene.reference_depth / depth;
}

int point_count(double volume, double cell) {
  return std::max(kLeastPoints, static_cast<int>(std::ceil(kPointsPerCell * volume / cell)));
}

double spot_factor(const EchoScene& scene, const Vec3& position) {
  for (const BrightSpot& spot : scene.spots)
    if ((position - spot.position).norm() < spot.radius) return kSpotEcho;
  return 1;
}

}  // namespace

RandomSource echo_source(std::uint64_t seed, EchoStream what, int state, std::uint64_t part) {
  return RandomSource(
      seed, (static_cast<std::uint64_t>(what) << 56) + (static_cast<std::uint64_t>(state) << 48) + part);
}

void add_tissue(const EchoScene& scene, const HeartWalls& walls, BeamField& field) {
  const auto [azimuths, elevations, depths] = field.size();
  for (int a = 0; a < azimuths; ++a)
    for (int e = 0; e < elevations; ++e) {
      RandomSource random =
          echo_source(scene.options.seed, EchoStream::Cells, scene.state,
                      static_cast<std::uint64_t>(a) * static_cast<std::uint64_t>(elevations) +
                          static_cast<std::uint64_t>(e));
      const Vec3 along = scene.probe.position_of(field.beam(Vec3(a, e, 0)));
      const Vec3 direction = (along - scene.probe.position).normalized();
      for (int d = 0; d < depths; ++d) {
        // The scatterer stands anywhere in its cell, which blurs no border by more than the spread does.
        const double depth = field.beam(Vec3(a, e, d + random.unit() - 0.5)).z();
        const Tissue tissue = walls.at(scene.probe.position + depth * direction);
        const double echo = tissue == Tissue::Blood ? 1 : tissue == Tissue::Wall ? kWallEcho : kOutsideEcho;
        field.at(a, e, d) += static_cast<float>(echo) * gaussian(random);
      }
    }
}

void add_leaflets(const EchoScene& scene, BeamField& field) {
  const TriangleMesh& surface = scene.valve.surface;
  const double thickness = scene.options.thickness, cell = cell_volume(scene, field);
  RandomSource random = echo_source(scene.options.seed, EchoStream::Leaflets, scene.state);
  for (int t = 0; t < surface.triangle_count(); ++t) {
    const Vec3 area = area_vector(surface.vertices, surface.triangles.col(t));
    if (!(area.norm() > 0)) continue;
    const Vec3 normal = area.normalized();
    const double volume = area.norm() * thickness;
    const int count = point_count(volume, cell);
    const double patch = scene.dropouts[static_cast<std::size_t>(t)] ? kDropoutEcho : 1;
    for (int k = 0; k < count; ++k) {
      const Vec3 at = place_on(surface, t, random) + thickness * (random.unit() - 0.5) * normal;
      const Vec3 beam = scene.probe.beam_of(at);
      const double across = std::abs(normal.dot((at - scene.probe.position).normalized()));
      const double echo = kLeafletEcho * patch * (kGrazingEcho + (1 - kGrazingEcho) * across) *
                          (patch == 1 ? spot_factor(scene, at) : 1) *
                          point_echo(scene, volume / count, cell, beam.z());
      field.add(field.cell(beam), static_cast<float>(echo) * gaussian(random));
    }
  }
}

void add_chords(const EchoScene& scene, BeamField& field) {
  RandomSource random = echo_source(scene.options.seed, EchoStream::Chords, scene.state);
  const double cell = cell_volume(scene, field);
  for (std::size_t line = 0; line < scene.valve.line_radii.size(); ++line) {
    const auto first = static_cast<Eigen::Index>(2 * line);
    const Vec3 from = scene.valve.line_ends.col(first), along = scene.valve.line_ends.col(first + 1) - from;
    const double radius = scene.valve.line_radii[line];
    const double volume = std::numbers::pi * radius * radius * along.norm();
    const int count = std::max(point_count(volume, cell), static_cast<int>(along.norm() / 0.2));
    if (!(volume > 0)) continue;
    for (int k = 0; k < count; ++k) {
      const Vec3 beam = scene.probe.beam_of(from + random.unit() * along);
      const double echo = kChordEcho * point_echo(scene, volume / count, cell, beam.z());
      field.add(field.cell(beam), static_cast<float>(echo) * gaussian(random));
    }
  }
}

void cast_shadows(const EchoScene& scene, BeamField& field) {
  const auto [azimuths, elevations, depths] = field.size();
  for (int a = 0; a < azimuths; ++a)
    for (int e = 0; e < elevations; ++e) {
      for (const BrightSpot& spot : scene.spots) {
        const Vec3 middle = scene.probe.beam_of(spot.position), here = field.beam(Vec3(a, e, 0));
        const double aside =
            std::hypot(here.x() - middle.x(), here.y() - middle.y()) * middle.z() / spot.radius;
        if (aside >= 1) continue;
        const auto factor =
            static_cast<float>(kShadowEcho + (1 - kShadowEcho) * aside * aside * aside * aside);
        const double behind = field.cell(Vec3(0, 0, middle.z() + scene.options.thickness)).z();
        for (int d = std::max(0, static_cast<int>(std::ceil(behind))); d < depths; ++d)
          field.at(a, e, d) *= factor;
      }
    }
}

}  // namespace coapt
