// A valve moved by position-based dynamics as Walczak et al. 2019 print it.
#include "exchange/detail/paper_model.hpp"

namespace coapt::detail {
namespace {

constexpr const char* kWalczakSolver = R"({
    // The paper's constraints, masses and flow field move the valve; moduli and pressure above are those
    // of its energy, which the result states, and of other solvers (--solver newton).
    "type": "xpbd", "xpbd": { "model": "walczak-2019" }
  })";

void apply_walczak(const PaperModel& model, Valve& valve, ImportOptions& options) {
  valve.name += ", " + model.title;
  options.solver = kWalczakSolver;
  if (options.contact.empty()) options.contact = "facet";
}

constexpr const char* kWalczakNotes = R"(# The valve with the method of Walczak et al. 2019

Walczak, Georgii, Tautz, Neugebauer, Wamala, Suendermann, Falk, Hennemuth: *Using Position-Based Dynamics for Simulating the
Mitral Valve in a Decision Support System* (2019).

## What the paper states, and is here

| what | value | where |
|---|---|---|
| method | extended position-based dynamics; explicit forces, then constraints, without damping | eq. 8 to 10 |
| leaflets | stretching, shearing and bending of edges, and areas: squared area less the squared area at rest, share 1 | eq. 11 to 14, table 1 |
| chords and contact | constraints without compliance | eq. 15, section 3.3 |
| clips (`interventions`) | the same, of zero length | section 3.8 |
| forces | of a flow field along the normals, and of the heart | eq. 16 to 19, table 1 |
| numbers | all of table 1, as defaults of `model: walczak-2019` | table 1 |

## Where it is not followed

| what | the paper | here | why |
|---|---|---|---|
| contact | vertices against triangles | the same; edges may cross | `--contact barrier`, or `contact_features: vertices_and_edges`, prevents that at the price of a slower step |
| verdict | stops by eye | never *converged*: the residual of the scene's energy is stated | the constraints' energies are not the scene's |

## What it leaves open, and what was chosen

| what | chosen | reason |
|---|---|---|
| rule of convergence | moves below 0.01 mm a step (root mean square) for 50 steps | none is given |
| sign of the flow | to the atrium in systole | its normal of the annulus plane points to the tips, and table 1 has w with both signs |
| hinges | fold by an angle without sign | eq. 12 has an arc cosine |
| time of the annulus' motion | 2 s | none is given |
| tips and chord lengths | those of this folder | `coapt chords` without `--tip` applies the paper's heuristic (section 3.5) |

What comes of it beside the paper's own table: docs/papers/walczak-2019.md.
)";

}  // namespace

PaperModel walczak_2019_model() {
  return {"walczak-2019", "moved after Walczak et al. 2019", apply_walczak,
          [](const Valve&) { return std::string(kWalczakNotes); }};
}

}  // namespace coapt::detail
