// Which strands a rough valve has, on its smooth surface: before there are vertices. Private to the
// generators.
#pragma once

#include "valve/generators/rough_surface.hpp"

#include <string>
#include <vector>

namespace coapt {

// On the surface.
struct RoughInsertion {
  double u = 0, t = 1;
};

// Insertions that one branch point serves; one alone has none.
using RoughFan = std::vector<RoughInsertion>;

// Fans that hang on one tip: one, or two behind a common branch point.
struct RoughTree {
  int group = 0;         // of tips
  std::string material;  // "marginal", "intermediate" or "basal"
  double area = 0;       // of a strand that ends at a leaflet; others bear several [mm^2]
  std::vector<RoughFan> fans;
};

// Trees of 500 to 1,800 strands in all, in fans of 5 to 20 that overlap: to the margin and the zone beside it
// ("marginal"), to the rough zone ("intermediate") and to the belly ("basal"); one fan in twelve is a single
// strand, a strut.
std::vector<RoughTree> rough_chord_plan(const RoughSurface& surface, RandomSource& random);

}  // namespace coapt
