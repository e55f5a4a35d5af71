// An ultrasound-like volume image of a valve, with its truth: speckle, point spread in sector geometry,
// shadows, dropout, walls and chords (docs/image.md). What it is made of is known, which no patient's image
// is.
#pragma once

#include "image/volume.hpp"
#include "mesh/triangle_mesh.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace coapt {

// One state of a valve, in LPS [mm].
struct PhantomValve {
  TriangleMesh surface;             // middle surface of the leaflets
  std::vector<int> annulus;         // ordered closed loop of its vertices, at least three
  Vec3 upstream = Vec3::UnitZ();    // unit vector from the ventricle to the atrium; see upstream_direction()
  Points line_ends = Points(3, 0);  // of chords, two columns for each [mm]
  std::vector<double> line_radii;   // of each chord [mm]
  std::vector<int> on_wall = {};    // triangles that lie on the wall of the ventricle
};

// Across the annulus, away from the leaflets of the open valve. A flat membrane has the side of its normals
// for it. Pre: at least three vertices of the annulus, not all on a line.
Vec3 upstream_direction(const TriangleMesh& open, const std::vector<int>& annulus);

struct PhantomOptions {
  double voxel = 0.5;                 // edge length [mm]
  double axial = 0.6, lateral = 0.9;  // standard deviations of the spread of amplitudes along and across the
                                      // beam, across at the depth of the annulus; it grows with depth [mm]
  std::optional<Vec3> probe;   // where the beams start [mm]; empty: upstream of the annulus, on its axis
  double probe_distance = 60;  // from the centre of the annulus where `probe` is empty [mm]
  double thickness = 1;        // of the leaflets [mm]
  double wall = 6;             // thickness of the walls [mm]
  double margin = 6;           // of the volume around the valve [mm]
  double dropout = 0.15;       // share of the leaflets' area that gives hardly any echo, 0 to 0.9
  int shadows = 2;             // behind bright spots of the leaflets
  double sector = 90;          // opening of the beams in both directions [degrees]
  double dynamic_range = 50;   // from black to white [dB]
  std::uint64_t seed = 0;
};

enum PhantomLabel : int {
  kLabelOutside,
  kLabelAtrium,
  kLabelVentricle,
  kLabelLeaflet,
  kLabelWall,
  kLabelChord
};

// What stays with the leaflets from state to state.
struct PhantomPattern {
  struct Spot {
    int triangle = 0;
    Vec3 weights;       // of its corners, sum 1
    double radius = 0;  // [mm]
  };
  std::vector<char> dropouts;  // of each triangle: whether it gives hardly any echo
  std::vector<Spot> spots;     // bright, with a shadow behind
};

// Patches of dropout of 1.5 to 4 mm, until they cover the share, and spots of 1 to 2.5 mm, strewn over the
// open leaflets. Throws InputError for leaflets without area.
PhantomPattern phantom_pattern(const TriangleMesh& open, const PhantomOptions& options);

struct Phantom {
  Volume image;     // 0 to 255, whole numbers; 0 beyond the sector
  Volume envelope;  // amplitudes before the logarithm, that of blood 1 in the mean square
  Volume labels;    // PhantomLabel of each voxel's centre
};

// Where the beams start: as the options say, else upstream of the annulus on its axis [mm].
Vec3 probe_position(const PhantomValve& valve, const PhantomOptions& options);

// A grid of voxels around all states, its last axis along the beam through the centre of the first one's
// annulus. Throws InputError for options without meaning, more than 5e8 voxels, and a probe that is not
// before the grid.
Volume phantom_grid(const std::vector<PhantomValve>& states, const PhantomOptions& options);

// The image of one state on this grid, whose probe is that of the grid: options.probe must say it where the
// annulus moves. The same input gives the same numbers, whatever the clock and the number of processors.
// `state` numbers the states of one series: their speckle is independent, as blood moves on. Throws
// InputError for an annulus that does not go around its centre, and for a grid finer than 2e8 cells of the
// beams.
Phantom make_phantom(const PhantomValve& valve, const PhantomPattern& pattern, const Volume& grid,
                     const PhantomOptions& options, int state = 0);

// The rims of the leaflets that are not on the annulus, as ordered vertices; a closed one does not repeat its
// first.
struct FreeRim {
  std::vector<int> vertices;
  bool is_closed = false;
};
std::vector<FreeRim> free_rims(const TriangleMesh& surface, const std::vector<int>& annulus);

}  // namespace coapt
