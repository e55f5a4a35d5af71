// What of a valve echoes, and how much reaches the probe.
#pragma once

#include "core/random_source.hpp"
#include "image/detail/beam_field.hpp"
#include "image/detail/heart_walls.hpp"
#include "image/phantom.hpp"

#include <complex>
#include <vector>

namespace coapt {

// Streams of random numbers of one seed, so that one more of something changes nothing else.
enum class EchoStream : std::uint64_t { Dropouts, Shadows, Leaflets, Chords, Cells };
RandomSource echo_source(std::uint64_t seed, EchoStream what, int state = 0, std::uint64_t part = 0);

// A spot of the leaflets that lets little through.
struct BrightSpot {
  Vec3 position;      // [mm]
  double radius = 0;  // [mm]
};

struct EchoScene {
  const PhantomValve& valve;
  const PhantomOptions& options;
  const Probe& probe;
  const std::vector<char>& dropouts;  // of each triangle
  const std::vector<BrightSpot>& spots;
  double reference_depth = 0;  // at which a cell has its reference volume [mm]
  int state = 0;
};

// Adds the echoes of blood, walls and what is beyond in every cell.
void add_tissue(const EchoScene& scene, const HeartWalls& walls, BeamField& field);

// Adds those of leaflets and of chords, as points strewn over them.
void add_leaflets(const EchoScene& scene, BeamField& field);
void add_chords(const EchoScene& scene, BeamField& field);

// Weakens what lies behind the spots.
void cast_shadows(const EchoScene& scene, BeamField& field);

}  // namespace coapt
