// Extended position-based dynamics behind the interface of every solver (Macklin et al. 2016; Walczak et al.
// 2019): a preview and a cross-check. It moves masses under constraints of its own and comes to rest in the
// equilibrium of these, which is near that of the scene as far as the constraints stand for its energies.
#pragma once

#include "optim/solver.hpp"
#include "xpbd/body.hpp"

#include <memory>

namespace coapt {

// Of the options: xpbd, xpbd_body and, with XpbdStiffness::Material, masses. Body and masses are asked for
// once the start is known not to be an equilibrium; minimize() throws InputError where they are missing or
// do not have what the options ask for.
//
// What it reports is the truth about the scene: every step is accepted with the objective's own energy and
// residual, and `Converged` is reached by that residual alone. Without it, it ends as
//   Stalled         at rest (no node moves), or after options.xpbd.steps steps; remark() says which
//   NonFinite       the motion has blown up; the last finite state is kept
// Steps keep to the limits of terms that have any (Monitor::step_limit): what is left of a step after a
// collision is not taken, and velocities fall with it. Contact of its own keeps features apart beforehand.
//
// Forces of the kind Scene are those of the objective's loads, exact, at the start of each step; diastole
// turns them round. A body without contact, pressure or annulus needs none of these. Where masses and forces
// come from different worlds (Material with Paper forces, Paper with those of the scene), the pressure p of
// the paper stands for that of the scene on a mean nodal area.
//
// Throws InputError with all defects where an option is out of range.
std::unique_ptr<Solver> make_xpbd(const SolverOptions& options);

// Adds "xpbd".
void add_xpbd_solver(SolverTable& table);

// What is wrong with these options, one text per defect, by the keys of the scene; empty: nothing.
std::vector<std::string> check_xpbd_options(const XpbdOptions& options);

}  // namespace coapt
