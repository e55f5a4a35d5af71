// How far two shapes lie apart, in three figures.
#pragma once

namespace coapt {

struct DistanceFigures {
  double mean = 0, p95 = 0, max = 0;  // [mm]
};

}  // namespace coapt
