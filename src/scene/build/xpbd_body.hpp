// The constraints that xpbd moves, from the terms of a scene.
#pragma once

#include "scene/build/model.hpp"
#include "scene/file/scene.hpp"
#include "xpbd/body.hpp"

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
//   bending             a hinge of the same stiffness and angle at rest; exact for small angles
//   cable ..., tether   a line of the same law, exact; slack below its length
//   spring              a line of the same law, exact, both ways where it resists compression
//   contact             vertices and edges kept apart, also from obstacles
// Loads stay terms: the solver asks the objective for their forces.
// Sources: Van Gelder 1998; E' and the area constraint follow from matching the two plane moduli.
// The body is exact where only lines and films are left.
// Throws InputError naming every internal term for which there is no constraint.
std::shared_ptr<const XpbdBody> xpbd_body(const Model& model, const std::vector<TermSpec>& terms);

// Whether xpbd looks for an equilibrium of the scene's own energy: its bodies are exact, and the options
// leave stiffness and forces as they are.
bool xpbd_moves_the_scene_itself(const Scene& scene);

// Whether the loads of the scene drive it, and not those of the paper.
bool xpbd_takes_the_loads(const Scene& scene);

}  // namespace coapt
