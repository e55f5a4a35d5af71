// A scene as an equilibrium that is followed while named parameters change.
#pragma once

#include "scene/build/in_memory.hpp"
#include "sensitivity/tracked_equilibrium.hpp"
#include "solve/run_options.hpp"

#include <memory>
#include <string>
#include <vector>

namespace coapt {

class SceneNumbers;
struct NamedChords;

struct TrackedScene {
  Model model;
  Result first;  // of the solve from the scene's own start
  std::unique_ptr<TrackedEquilibrium> equilibrium;
  std::shared_ptr<SceneNumbers> numbers;      // of the scene's terms, while they change
  std::shared_ptr<const NamedChords> chords;  // as they were first
};

// Solves the scene as run() does and takes its equilibrium up; nothing is written. Where the first solve did
// not converge (see its status) the equilibrium starts from where it ended. tracking: its factorisation is
// replaced by that of the scene. Throws InputError as run() does.
TrackedScene track(const Scene& scene, const SolverTable& solvers, const RunOptions& options,
                   TrackingOptions tracking = {});

// The same with what is given. Throws InputError as run() does with it, and for given terms without a
// Hessian: every step and every derivative solves with the exact tangent.
TrackedScene track(const Scene& scene, Given given, const SolverTable& solvers, const RunOptions& options,
                   TrackingOptions tracking = {});

// The same of a shape that is known, 3 x node_count in the coordinates of the input [mm], which is not solved
// again: `first` holds its unknowns alone, and TrackedEquilibrium::solve() judges it.
TrackedScene track_shape(const Scene& scene, const Points& shape, const SolverTable& solvers,
                         const RunOptions& options, TrackingOptions tracking = {});

// The parameter of this name, for TrackedEquilibrium::add():
//   TERM.lengths     rest length of each line of a cable or tether term, by itself [mm]
//   TERM.length      one factor on all of them, first 1
//   GROUP.length     one factor on the rest lengths of the chords of one material or of one papillary tip,
//                    tip_0, tip_1 ...; first 1
//   TERM.stiffness   factor on all moduli of a membrane or cable term, first 1; of a membrane also in bending
//                    terms that take their stiffness from it
//   TERM.thickness   factor on the thickness of a membrane, first 1; in such bending terms its third power
//   TERM.KEY         any other number of an elastic term that is given and not zero, in internal units:
//   poisson,
//                    young, transition_strain, prestress ...; of a list, and for the diameter of a cable, a
//                    factor, first 1
//   TERM.pressure    pressure along the normals [MPa], minus the scene's `value` where it acts on the front
//   TERM.load        factor on all forces of a load_field or of a load_pressure of model frozen, first 1
//   TERM.forces      these forces themselves, x, y, z node after node [N]
//   SET.positions    coordinates of prescribed nodes where they are now, node after node [mm]
//   SET.shift        one displacement of all of them, first 0 [mm]
//   SET.ring         factors on both widths and the height of the ring through them, tilt about the longer
//                    width [rad]; first 1, 1, 1, 0. Its axes are the principal ones of the nodes.
//   SET.rest         coordinates of nodes in the rest shape [mm], for membranes of triangles and hinges; not
//                    where there are springs
// Also by the keys of the scene file: TERM.length_scale is TERM.length (where the scene's is 1), TERM.value
// of a pressure is the scene's, minus TERM.pressure where it acts on the front. Positions are relative to the
// model's origin. Throws InputError for any other name, listing those there are, and for a parameter that the
// term or the nodes do not have. Which of them go together is the equilibrium's to say
// (TrackedEquilibrium::add): TERM.KEY makes the elements anew from the scene and does not go with `stiffness`
// and `thickness` of the same cable, or of any membrane where it is no cable, nor then with SET.rest.
std::unique_ptr<Parameter> make_named_parameter(const std::string& name, const Scene& scene,
                                                const TrackedScene& tracked);

// Every name that may be asked for: of terms by what they are, of sets by whether they are prescribed.
std::vector<std::string> parameter_names(const TrackedScene& tracked);

// Brings Model::lines up to date with the rest lengths of the terms, for metrics and reports.
void take_rest_lengths(Model& model);

}  // namespace coapt
