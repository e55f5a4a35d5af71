// What both keepers of contact in xpbd take from a body. Private to this folder.
#pragma once

#include "energy/contact/contact_surface.hpp"
#include "xpbd/body.hpp"

namespace coapt {

// The positions of a pair's nodes.
inline PairCorners pair_corners(const Points& x, const std::array<int, 4>& nodes) {
  PairCorners c;
  for (int k = 0; k < 4; ++k) c.col(k) = x.col(nodes[static_cast<size_t>(k)]);
  return c;
}

// The features of the membrane and of its obstacles.
inline ContactSurface contact_surface(const XpbdBody& body) {
  Triangles all(3, body.triangles.cols() + body.obstacles.cols());
  all << body.triangles, body.obstacles;
  return {body.rest, all, static_cast<int>(body.triangles.cols()), body.excluded};
}

}  // namespace coapt
