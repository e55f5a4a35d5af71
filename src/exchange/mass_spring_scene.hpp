// A scene with springs in place of its membranes, as mass-spring methods see it.
#pragma once

#include "scene/file/scene.hpp"

namespace coapt {

// Every membrane (cst_*) becomes a term `spring` of the same name on the same triangles, with the stiffness
// of Van Gelder (1998); bending is left out; all else stays. Bilinear and orthotropic membranes (Hammer et
// al. 2008, 2011) keep their curves, those of other laws the modulus that they have at small strain. Springs
// have no Poisson's ratio of their own (1/3 on equilateral triangles). They go slack where the membrane
// wrinkles and resist where it resists. The solver becomes `mass-spring`, the rest of its settings stay.
// Throws InputError with all that springs cannot be: neither membrane nor springs in the scene, a prestress,
// a nonlinear law whose numbers differ from triangle to triangle, a window at the knees that does. Reads the
// scene's files only for a nonlinear law.
Scene mass_spring_scene(const Scene& scene);

// Whether no membrane is in the scene, so that nothing in it but the solver would change.
bool has_springs_alone(const Scene& scene);

}  // namespace coapt
