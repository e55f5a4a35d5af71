// A hanging chain as a chord network: the discrete form of the catenary.
#pragma once

#include "formats/valve.hpp"

namespace coapt {

// `links` equal links between two anchors. The anchors are the network's papillary points 0 and 1, the
// inner nodes its junctions 0 ... links-2, in order from `from` to `to`; chord i is the i-th link.
// Each link has the rest length total_length/links and the cross-section `area` [length^2]; level 0.
// The start shape is a parabola below the straight line (towards -z) that is as long as the chain, its
// nodes at equal steps along it: every link starts near its rest length. A chain no longer than the span,
// or one that hangs straight down, starts on the straight line between the anchors, links at equal steps.
// Throws InputError for fewer than 2 links, a length or area that is not positive, or anchors that coincide.
ChordNetwork chain(const Vec3& from, const Vec3& to, int links, double total_length, double area);

}  // namespace coapt
