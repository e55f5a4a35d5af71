// How far two layers lie apart that were found in different ways in the same image.
#pragma once

#include "mesh/triangle_mesh.hpp"

#include <vector>

namespace coapt {

// A layer as one way found it.
struct FoundRoute {
  TriangleMesh mesh;
  std::vector<int> free_edge;  // closed loop of vertices
  Vector deviation;            // standard deviation of each vertex along its normal [mm]
  double edge_deviation = 0;   // of the free edge along the leaflet [mm]
};

struct RouteAgreement {
  Vector distances;            // of each vertex of the first layer from the second [mm]
  double mean = 0, p95 = 0;    // over the area, both ways: their mean, the greater of their percentiles [mm]
  double free_edge = 0;        // mean distance of the edges, both ways [mm]
  double area_difference = 0;  // of the second layer, as a share of the area of the first
  double apart_share = 0;      // of the first layer's area: farther apart than both deviations allow
  bool has_edges_apart = false;  // on average by more than both deviations of the edges allow
};

// Allowed is twice the root of the sum of the squared deviations. Throws InputError where one has no
// triangle.
RouteAgreement agreement_of(const FoundRoute& first, const FoundRoute& second);

}  // namespace coapt
