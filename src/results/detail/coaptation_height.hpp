// How far contact reaches down from the coaptation line. Private to this room.
#pragma once

#include "mesh/seams.hpp"

namespace coapt {

// Places along the line, evenly spaced on each piece.
struct Station {
  Vec3 point, along;  // unit tangent
  size_t piece = 0, stretch = 0;
};
std::vector<Station> stations(const std::vector<Seam>& line, double spacing);

// At each station the greatest distance from the line, measured across it, of the given points that are
// nearest to that station; NaN where there is none. Points beyond the ends of a piece by two spacings do not
// count.
std::vector<double> heights_at(const std::vector<Station>& stations, const std::vector<Vec3>& contact,
                               double spacing);

// The height at each stretch of each piece: that of the nearest station of the piece.
std::vector<std::vector<double>> heights_along(const std::vector<Seam>& line,
                                               const std::vector<Station>& stations,
                                               const std::vector<double>& heights);

// 90th percentile of the finite heights; 0 where there is none.
double ninth_decile(std::vector<double> heights);

}  // namespace coapt
