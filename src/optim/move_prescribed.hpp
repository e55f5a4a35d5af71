// Prescribed nodes that go to new positions, with the free ones carried along.
#pragma once

#include "optim/solver.hpp"

#include <string>

namespace coapt {

// Of the whole prescribed motion, the least that a step must make: less is no progress.
constexpr double kLeastMotion = 1e-4;

struct Move {
  double reached = 0;          // of the prescribed motion
  bool is_overloaded = false;  // the energy, not a collision, was in the way of the rest
};

// Moves the prescribed nodes from where they are at `from` towards `to`, parameters of the motion, the free
// ones carried along, as far as no collision is in the way and the energy stays finite.
Move move_prescribed(const MotionPath& motion, double from, double to, Objective& objective, Vector& q);

// Names of the parts of a motion that by themselves cannot go on from `at`, where the prescribed nodes are,
// by twice the least step.
std::string blocked_parts(const MotionPath& motion, double at, Objective& objective, const Vector& q);

// Whether a solver can begin there: a law that stiffens exponentially overflows where a sliver is stretched.
bool is_finite(Objective& objective, const Vector& q);

}  // namespace coapt
