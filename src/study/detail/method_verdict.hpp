// What a method's result means beside that of the reference method. Private to this room.
#pragma once

#include "solve/solve_scene.hpp"
#include "study/comparison.hpp"

namespace coapt {

// Fills gap and, in the fields of the method's report, the map of distances. Pre: both have a result.
// Throws InputError where a surface has no area.
void measure_gap(const ComparedMethod& reference, ComparedMethod& method);

// Fills verdict, message and, where it is needed, refined. The models are only used to solve on.
// same_mm: distance up to which two shapes are the same. refining: how newton goes on; none where it is not
// in the build. Pre: the gap is measured where both have a result.
void judge_method(ComparedMethod& reference, ComparedMethod& method, double same_mm,
                  const std::optional<SolveSetup>& refining);

}  // namespace coapt
