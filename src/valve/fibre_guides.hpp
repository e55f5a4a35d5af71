// The fibre directions that a mesh itself tells, as far as anatomy is known.
#pragma once

#include "valve/fibre_field.hpp"

#include <vector>

namespace coapt {

// A chord's end on the leaflets.
struct FibrePull {
  int vertex = 0;
  Vec3 direction = Vec3::Zero();  // from the vertex to the other end of the chord, of any length
  double weight = 1;              // its cross-section, say; only ratios at one vertex count
};

// Along every boundary edge.
std::vector<FibreGuide> boundary_guides(const TriangleMesh& mesh);

// Collagen of a valve leaflet after Toma et al. 2016: along the boundary (the free edges); along the annulus,
// but across it (radial) within kRadialShare of its length from a trigone, and free from there to
// kAlongShare; at chord insertions inside the leaflet the chord's direction in the surface (of several their
// weighted sum), unless it is nearly normal to it. annulus: ordered closed loop of vertices, whose neighbours
// an edge joins or not (gaps are passed over). trigones: some of its vertices, may be empty. Throws
// InputError for trigones that are not on the annulus.
std::vector<FibreGuide> valve_guides(const TriangleMesh& mesh, const std::vector<int>& annulus,
                                     const std::vector<int>& trigones, const std::vector<FibrePull>& pulls);

inline constexpr double kRadialShare = 0.03, kAlongShare = 0.08;

// Vertices of the annulus at which two regions meet: where trigones are not named.
std::vector<int> region_meetings(const TriangleMesh& mesh, const std::vector<int>& annulus);

}  // namespace coapt
