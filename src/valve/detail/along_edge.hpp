// Where places on the leaflets lie along the free edge, and how far from a rim.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

// How far each vertex of an edge lies along it, and its whole length. It is closed, but has no length between
// neighbours in the list that no triangle joins: there the next leaflet begins.
struct EdgeLengths {
  std::vector<double> along;
  double length = 0;
};
EdgeLengths edge_lengths(const TriangleMesh& mesh, const std::vector<int>& edge);

// The distance of each vertex from the nearest source along mesh edges; infinity where no way leads.
std::vector<double> distances_along_edges(const TriangleMesh& mesh, const std::vector<int>& sources);

// For each vertex the length along the edge, from 0 to its whole, that belongs to it: the edge is laid onto a
// circle by its lengths, and the circle's coordinates go on over the leaflets as harmonic functions with no
// derivative across the annulus; the angle is taken. Unlike the nearest point of the edge it changes
// steadily, also where a leaflet is longer than it is wide, and hardly with the mesh. 0 where no triangle
// leads to the edge. Pre: `lengths` is that of the edge, which is not empty.
std::vector<double> along_edge(const TriangleMesh& mesh, const std::vector<int>& edge,
                               const EdgeLengths& lengths);

}  // namespace coapt
