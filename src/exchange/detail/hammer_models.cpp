// The springs of Hammer et al. 2008 and 2011.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "exchange/detail/law_terms.hpp"
#include "exchange/detail/paper_model.hpp"
#include "formats/json/units.hpp"

namespace coapt::detail {
namespace {

struct SpringSheet {
  double thickness;  // [mm]
  const char *chord_young, *pressure;
  Material law;  // without the thickness
};

void set_springs(const PaperModel& model, SpringSheet sheet, Valve& valve, ImportOptions& options) {
  name_whole_leaflets(valve);
  sheet.law.keys.emplace_back("thickness", quoted(exact_text(sheet.thickness) + " mm"));
  valve.membranes.clear();
  for (const std::string& region : valve.leaflets.region_names) valve.membranes[region] = sheet.law;
  valve.cables.clear();
  valve.thickness = sheet.thickness;
  valve.name += ", " + model.title;
  options.chord_young = sheet.chord_young;
  options.pressure = sheet.pressure;
  valve.pressure = quantity_value(sheet.pressure, kPressure);
  options.bends = false;
}

void apply_hammer_2008(const PaperModel& model, Valve& valve, ImportOptions& options) {
  set_springs(model,
              {1,
               "40 MPa",
               "13 kPa",
               {"spring",
                {{"young_pre", "\"100 kPa\""}, {"young_post", "\"6 MPa\""}, {"transition_strain", "0.25"}}}},
              valve, options);
}

void apply_hammer_2011(const PaperModel& model, Valve& valve, ImportOptions& options) {
  if (valve.annulus.size() < 3)
    throw InputError(model.name +
                     ": needs fibre directions, which follow from the annulus; name it as \"annulus\" in the "
                     "valve JSON (its vertices in order), or give its curve by --annulus-closed");
  set_springs(model,
              {1,
               "40 MPa",
               "120 mmHg",
               {"spring",
                {{"fibre_young_pre", "\"0.5 MPa\""},
                 {"fibre_young_post", "\"6 MPa\""},
                 {"fibre_transition", "0.15"},
                 {"cross_young_pre", "\"0.2 MPa\""},
                 {"cross_young_post", "\"2 MPa\""},
                 {"cross_transition", "0.25"}}}},
              valve, options);
}

constexpr const char* kNotes2008 = R"(# The valve with the model of Hammer et al. 2008

Hammer, Vasilyev, Perrin, del Nido, Howe: *Fast image-based model of mitral valve closure for surgical planning* (2008).

## What the paper states, and is here

| what | value | where |
|---|---|---|
| leaflets | triangle edges as springs that carry tension only, no bending; stiffness E h (area of the triangles at an edge) / length^2 | section 2.3.1, eq. 1 |
| thickness | 1 mm | section 2.3.1 |
| stress-strain curve | bilinear: 100 kPa, from 25 % strain on 6 MPa | Table 1 |
| chords | linear, 40 MPa, tension only | Table 1 |
| pressure | 13 kPa (100 mmHg), on the leaflets as they lie | Table 1 |
| annulus and papillary points | go to their places in the closed valve | section 2.3.4 |

## Where it is not followed

| what | the paper | here | why |
|---|---|---|---|
| self-collision | vertices that come near get forces that make collisions inelastic (section 2.3.5) | `contact_barrier` | that rule lets facets through: vertices alone are looked at. `"collisions": "inelastic"` in `solver.dynamics` is their rule; a run that ends with intersections is not called converged |
| motion | second-order backward differences with conjugate gradients, about 4,000 steps (eq. 3 to 5) | `newton` along a damped path, to the same equilibrium | `--solver dynamic` moves in time; `"linear_solver": "conjugate_gradients"` in `solver.dynamics` is theirs |
| start | a quasi-static solve with the free edge held, then the loads (section 2.3.4) | prescribed motion and loads grow together | a barrier allows no jump of the annulus |

## What it leaves open, and what was chosen

| what | chosen | reason |
|---|---|---|
| cross-section of the chords (from its reference 11) | that of the valve's chords | a chord's stiffness is 40 MPa times its area over its length |
| density, damping, time step | those of `solver.dynamic` | they do not change the equilibrium |
| Poisson's ratio | none: springs have about 1/3 by themselves | Van Gelder 1998 |
| the valve itself | the mesh, annulus motion and chords of this folder | the paper's scans are not published |
)";

constexpr const char* kNotes2011 = R"(# The valve with the model of Hammer et al. 2011

Hammer, del Nido, Howe: *Anisotropic mass-spring method accurately simulates mitral valve closure from image-based
models* (2011).

## What the paper states, and is here

| what | value | where |
|---|---|---|
| leaflets | triangle edges as springs; one bilinear curve along the fibres (circumferential), another across (radial) | section 2 |
| chords | linear, of one diameter, tension only | section 2 |
| pressure | 120 mmHg on the ventricular side of all triangles | section 2 |
| annulus | goes to its place in the closed valve while the papillary ends are held | section 2 |
| meshes | 600 to 700 triangles; cut into 4 and 16 as well | Table 1 |

## Where it is not followed

| what | the paper | here | why |
|---|---|---|---|
| self-contact | a penalty force that balances the force which brings two triangles together, without friction (section 2) | `contact_barrier` | a balanced force keeps facets apart only while nothing else moves them; `"collisions": "balanced"` in `solver.dynamics` is that rule between vertices and facets |
| motion | semi-implicit, with steps of adaptive size | `newton` along a damped path, to the same equilibrium | `--solver mass-spring` is theirs, with annulus and pressure together |
| papillary points | held while the annulus moves | they go where the valve's data say, together with the annulus | a valve without closed papillary points holds them |

## What it leaves open, and what was chosen

| what | chosen | reason |
|---|---|---|
| the six numbers of the two curves | fibre 0.5 and 6 MPa, knee at 15 %; across 0.2 and 2 MPa, knee at 25 % | they are fitted to its reference 7, whose numbers it does not repeat; these are those of docs/studies.md |
| thickness | 1 mm | Hammer et al. 2008 |
| modulus of the chords | 40 MPa | Hammer et al. 2008, Table 1 |
| diameter of the chords | that of the valve's chords | not stated |
| fibre directions | from annulus, free edge and chords (Toma et al. 2016, docs/theory.md) | "circumferential" needs a field; the paper gives none |
| the valve itself | the mesh, annulus motion and chords of this folder | the paper's scans are not published |
)";

}  // namespace

PaperModel hammer_2008_model() {
  return {"hammer-2008", "springs of Hammer et al. 2008", apply_hammer_2008,
          [](const Valve&) { return std::string(kNotes2008); }};
}

PaperModel hammer_2011_model() {
  return {"hammer-2011", "springs after Hammer et al. 2011", apply_hammer_2011,
          [](const Valve&) { return std::string(kNotes2011); }};
}

}  // namespace coapt::detail
