// Takes the free nodes along with prescribed ones, so that no motion of a boundary tears the mesh.
#pragma once

#include "energy/objective.hpp"

namespace coapt {

// The unknowns after the prescribed coordinates have moved to those of x, with the objective's prescribed
// coordinates still where they were: each coordinate's displacement is the discrete harmonic function
// (cotangent weights on triangles, 1 on lines, and stiff ones between a prescribed and a free feature in
// contact) that takes the prescribed values. Translations are carried exactly, and what is joined to no
// prescribed node stays. Pre: the terms are prepared for positions near q. Cost: one factorisation of a
// scalar Laplacian per coordinate with another set of prescribed nodes.
Vector extended_harmonically(const Objective& objective, const Vector& q, const Points& x);

}  // namespace coapt
