// How far along the free edge the places inside of the leaflets belong.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

// For each vertex the length along the edge, from 0 to `length`, that belongs to it: the edge is laid onto a
// circle by its lengths (`along`, of its vertices in order), and the circle's coordinates go on over the
// leaflets as harmonic functions that do not change across the annulus; the angle is taken. Unlike the
// nearest point of the edge it changes steadily, also where a leaflet is longer than it is wide, and hardly
// with the mesh. 0 where no triangle leads to the edge. Pre: edge and along have the same size, is not empty.
std::vector<double> along_edge(const TriangleMesh& mesh, const std::vector<int>& edge,
                               const std::vector<double>& along, double length);

}  // namespace coapt
