// The constraints that xpbd moves, from the terms of a scene.
#pragma once

#include "optim/xpbd/body.hpp"
#include "scene/model.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <vector>

namespace coapt {

// What stands for what, by moduli at small strain where a law is not linear:
//   membrane (cst_...)  an edge constraint with Van Gelder's stiffness sum(E' h A)/l^2 for every mesh edge,
//                       and from nu = 1/3 on an area constraint h E (3 nu - 1)/(2 (1 - nu^2) A) for every
//                       triangle, with E' = 4 E/(3 (1 + nu)): together they have E and nu on equilateral
//                       triangles; below nu = 1/3 E' = E and edges alone, whose nu is 1/3. One-sided where
//                       the membrane does not resist compression. A prestress is a film.
//   surface_tension     a film, exact
//   bending             a hinge of the same stiffness and angle at rest
//   cable ..., tether   a line of the same law, exact; slack below its length
//   spring              a line of the same law, exact, both ways where it resists compression
//   contact             vertices and edges kept apart, also from obstacles
// Loads stay terms: the solver asks the objective for their forces.
// Sources: Van Gelder 1998; E' and the area constraint follow from matching the two plane moduli.
// Throws InputError naming every internal term for which there is no constraint.
std::shared_ptr<const XpbdBody> xpbd_body(const Model& model, const std::vector<TermSpec>& terms);

}  // namespace coapt
