// Films of constant tension whose size nothing but pressure and tension decides.
#pragma once

#include "energy/objective.hpp"

#include <optional>

namespace coapt {

struct FreeFilms {
  bool has_pressure = false;
  // Each part grown or shrunk about its centre until pressure and tension do the same work in that; empty
  // where pressure does none, or works with tension.
  Points balanced;
};

// Empty unless all terms are films and pressure with a potential, and what is prescribed lets each connected
// part grow: none of its nodes, one, or symmetry planes, all its coordinates prescribed along an axis being
// the same. In a growth by the factor s tension does the work 2 T s ds and pressure W s^2 ds, T the energy of
// the film: they balance at s = 2 T/W, where the second derivative of the energy is -2 T. So every
// equilibrium is a saddle or a maximum, and without pressure there is none. x: 3 x node_count.
std::optional<FreeFilms> free_films(const Objective& objective, const Points& x);

// Such films made rounder, each part about its centre, for a start that is far from a sphere.
Points rounded_films(const Objective& objective, const Points& x);

// Films that supports hold, tension alone acting on them, spanned anew between the supports: a start that
// depends on them and on how triangles are joined only. Empty for all else, and where what is spanned goes on
// shrinking.
std::optional<Points> spanned_films(const Objective& objective, const Points& x);

}  // namespace coapt
