// One scene solved by several methods, and every result measured with the same yardsticks: against the shape
// that a reference method found, and against a given closed surface.
//
// Methods that look for an equilibrium of the same energy must end in the same shape, or in two that are both
// equilibria; which of the two it is gets said, with the energies. Where the model is another one (springs in
// place of membranes, constraints in place of an energy) the distance is no error of a method but a gap
// between models.
#pragma once

#include "results/reference/reference_distance.hpp"
#include "run/branches.hpp"
#include "run/run.hpp"

#include <functional>
#include <string_view>

namespace coapt {

// What a method works on.
enum class MethodModel {
  Scene,       // the energy of the scene
  Springs,     // that with springs in place of its membranes ("mass-spring"), see mass_spring_scene
  Constraints  // constraints on positions ("xpbd"), unless they are the energy itself
};
std::string_view method_model_name(MethodModel model);  // "scene", "springs", "constraints"

enum class Verdict {
  Reference,        // it is the method that others are compared with
  SameEquilibrium,  // as the reference's, to kSameShape of the extent
  AnotherBranch,    // an equilibrium of the same energy, but not the reference's
  NotConverged,     // this method or the reference stands in no equilibrium
  ModelGap,         // its model is another one than the reference's
  NoReference,      // the reference method failed
  Failed            // there is no result
};
std::string_view verdict_name(Verdict verdict);  // "reference", "same equilibrium", ...

// Shapes are the same when no vertex is farther from itself than this share of the extent.
inline constexpr double kSameShape = 1e-6;

// How far a closed shape lies from that of the reference method.
struct MethodGap {
  std::optional<ReferenceDistance> surfaces;  // none for a scene without a mesh
  VertexDistance same_vertex;                 // of the mesh; of all nodes in a scene without one
  int left_out = 0;  // of these, nodes that one of the two does not determine: in no distance
};

// Both shapes again, after newton went on from them to a smaller residual: what is left of the distance is
// not due to the tolerance.
struct RefinedPair {
  double tolerance = 0;  // that was asked for
  double residual = 0, reference_residual = 0;
  double energy = 0, reference_energy = 0;  // [mJ]
  double largest_mm = 0;                    // same-vertex distance
};

struct ComparedMethod {
  std::string name;
  MethodModel model = MethodModel::Scene;
  std::optional<RunReport> run = {};        // none: it failed
  std::optional<MethodGap> gap = {};        // none for the reference, and where one of the two failed
  std::optional<RefinedPair> refined = {};  // where the tolerance might have kept two shapes apart

  // Of another branch: energy above that of the reference [mJ]. Where the load has no potential, the work
  // that is left over on the straight way from there to here; the two energies are then those of two
  // potentials.
  std::optional<double> energy_above = {};
  Verdict verdict = Verdict::Failed;
  std::string message = {};  // one sentence: the verdict with its figures, or why the method failed
  std::string shares = {};   // with newton, as "energy + contact + factorisation"; all stop by the residual
};

struct Comparison {
  std::string scene_file, scene_title;
  double tolerance = 0;                 // on the residual
  std::string closed_surface;           // file name of the given closed surface; empty: none
  double extent_mm = 0;                 // diagonal of the box around the shape at rest
  std::vector<ComparedMethod> methods;  // the reference first; fewer than wanted where cancelled
  bool is_cancelled = false;
  std::filesystem::path folder;  // empty: nothing was written

  const ComparedMethod& reference() const { return methods.front(); }
  bool has_converged() const;  // every method
};

struct ComparisonOptions {
  std::vector<std::string> methods;  // each once; see known_methods
  std::string reference;             // one of them; empty: "newton" where it is among them, else the first
  std::filesystem::path closed;  // given closed surface, in the unit of the scene's mesh; empty: the scene's
  BranchSearch branches = {.starts = 0};              // around the equilibrium of each method
  std::function<void(const ComparedMethod&)> report;  // called after each method; may be empty
};

// The names of the table.
std::vector<std::string> known_methods(const SolverTable& solvers);

// Every method from the scene's own start, the reference first, each into a folder of its name within that of
// the comparison; closed.vtp of the others carries the distance to the reference's surface,
// `distance_to_reference_method`. run: as for run(), its solver is not used and its time limit is that of
// each method. A method that fails is a row with its message. Throws InputError, before the first solve, for
// bad input: methods, reference and surfaces in one pass, then whatever the scene is refused for, then a
// folder that cannot be written.
Comparison compare_methods(const Scene& scene, const SolverTable& solvers, const ComparisonOptions& options,
                           const RunOptions& run);

}  // namespace coapt
