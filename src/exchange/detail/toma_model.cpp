// Leaflets and chords of crimped fibres, as Toma et al. 2016 print their numbers.
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "exchange/detail/law_terms.hpp"
#include "exchange/detail/paper_model.hpp"
#include "formats/json/units.hpp"

#include <algorithm>

namespace coapt::detail {
namespace {

constexpr const char* kTomaPressure = "120 mmHg";
constexpr const char* kFibreYoung = "\"48 MPa\"";

// Section 2.5 prints lengths over the radius of the fibre: H0/r0 and R0/r0. Our keys are H0/R0 and R0/r0.
struct Crimp {
  double wavelength, amplitude;
};
constexpr Crimp kAnterior{14.5, 1.75}, kPosterior{7.0, 1.0}, kStrut{1.35, 5.0}, kMarginal{90.0, 5.0};

// Of the parts that section 2.5 has without printing their numbers: ours.
constexpr const char *kSplay = "0.5", *kSplayOutOfPlane = "0.2", *kSecondPopulation = "0.5",
                     *kYieldStrain = "0.04";

std::vector<std::pair<std::string, std::string>> crimp_keys(const Crimp& crimp) {
  return {{"fibre_young", kFibreYoung},
          {"crimp_ratio", exact_text(crimp.wavelength / crimp.amplitude)},
          {"radius_ratio", exact_text(crimp.amplitude)},
          {"shear_modulus", "\"10 kPa\""},
          {"yield_strain", kYieldStrain}};
}

Material leaflet_law(const Crimp& crimp, double thickness) {
  Material law{"cst_crimped_fibre", crimp_keys(crimp)};
  law.keys.insert(law.keys.end(), {{"splay", kSplay},
                                   {"splay_out_of_plane", kSplayOutOfPlane},
                                   {"second_population", kSecondPopulation},
                                   {"second_angle", "\"90 deg\""},
                                   {"thickness", quoted(exact_text(thickness) + " mm")}});
  return law;
}

void check_toma_parts(const std::string& model, const Valve& valve) {
  std::vector<std::string> defects;
  const std::vector<std::string>& regions = valve.leaflets.region_names;
  for (const char* wanted : {"anterior", "posterior"})
    if (std::find(regions.begin(), regions.end(), wanted) == regions.end())
      defects.push_back(
          model +
          ": needs the leaflets as regions \"anterior\" and \"posterior\", whose fibres differ; "
          "the mesh has no region \"" +
          wanted + "\": name the groups of the OBJ file so");
  if (valve.annulus.size() < 3)
    defects.push_back(
        model +
        ": needs fibre directions, which follow from the annulus; name it as \"annulus\" in the "
        "valve JSON (its vertices in order), or give its curve by --annulus-closed");
  if (valve.chords.chords.empty())
    defects.push_back(model + ": needs chords; give them in the valve JSON, or tips by --papillary");
  if (!defects.empty()) throw InputError(defects);
}

void apply_toma(const PaperModel& model, Valve& valve, ImportOptions& options) {
  check_toma_parts(model.name, valve);
  if (valve.thickness <= 0) valve.thickness = options.default_thickness;
  valve.membranes.clear();
  for (const std::string& region : valve.leaflets.region_names)
    valve.membranes[region] = leaflet_law(region == "anterior" ? kAnterior : kPosterior, valve.thickness);
  valve.cables.clear();
  for (const Chord& chord : valve.chords.chords)
    valve.cables[chord.material] = {"cable_crimped_fibre",
                                    crimp_keys(chord.material == "strut" ? kStrut : kMarginal)};
  valve.annulus_closed.resize(3, 0);
  valve.chords.papillary_closed.resize(3, 0);
  valve.name += ", " + model.title;
  options.pressure = kTomaPressure;
  valve.pressure = quantity_value(kTomaPressure, kPressure);
}

constexpr const char* kTomaNotes = R"(# The valve with the tissue of Toma et al. 2016

Toma, Bloodworth, Einstein, Pierce, Cochran, Yoganathan, Kunzelman: *High-resolution subject-specific mitral valve imaging
and modeling: experimental and computational methods*, Biomech Model Mechanobiol 15:1619 (2016).

## What the paper states, and is here

| what | value | where |
|---|---|---|
| fibre modulus | 48 MPa (4.8e4 kPa) | section 2.5 |
| matrix | shear modulus 10 kPa, in leaflets and chords | section 2.5 |
| crimp of the leaflets | H0/r0 and R0/r0: anterior 14.5 and 1.75, posterior 7.0 and 1.0 (here `crimp_ratio` H0/R0 and `radius_ratio` R0/r0) | section 2.5 |
| crimp of the chords | R0/r0 5.0; H0/r0 1.35 of strut chords, 90 of marginal ones | section 2.5 |
| fibre directions | known along free edge, annulus and chords, across at the trigones; between them Laplace's equation for the tensor of directions | section 2.6, eq. 3 |
| held | annulus and papillary ends, where the open valve has them | section 2.7 |
| pressure | 120 mmHg, of the closed scan | section 2.3 |
| fibres of the leaflets | two populations, dispersed in space by the tensor K; their numbers are below | eq. 1 and 2 |
| healthy closure | 2/3 of the diameter under the anterior leaflet, coaptation 3 to 5 mm, less than 5 ml back: `healthy_closure` in `result.json` | section 2.1 |

## Where it is not followed

| what | the paper | here | why |
|---|---|---|---|
| load | a fluid of particles, pushed by pistons | pressure on the leaflets, at rest | Coapt has no fluid |
| body | three layers of tetrahedra, chords as solids | surface and lines, with the plate's bending stiffness | |
| active fibre stress | a term of eq. 1 | `active_stress` 0 | the paper's valves are excised: nothing in them is active |
| failure of fibres | a fourth parameter of the appendix, left out where failure is not considered | `failure` 0: the stress goes on, results name what is beyond its yield | neither number nor algorithm is printed |
| bulk modulus | 2.8e4 kPa, lowered for the time step | incompressible | the paper calls the true value a thousand times greater |

## What it leaves open, and what was chosen

| what | chosen | reason |
|---|---|---|
| H0/r0 of chords between strut and marginal | 90 | "varied for most chordae": only the two ends are printed |
| leaflets of other names, such as a septal one | the crimp of the posterior leaflet | the paper has a mitral valve |
| thickness | $THICKNESS mm | the valve's; the paper has it from its scan |
| dispersion | `splay` 0.5 rad in the plane, `splay_out_of_plane` 0.2 rad | splay parameters are those of Freed et al. 2005, not printed; fibres lie nearly in the leaflet |
| second population | across the first (`second_angle` 90 deg), half as strong (`second_population` 0.5) | neither direction nor share is printed; biaxial tests find leaflets stiffer along the fibre |
| yield strain | 0.04 of the straight fibre, in leaflets and chords | not printed; tendon is damaged from some 4 % on (Wang 2006, J Biomech 39:1563) |
| tuning to the yield strain | none | `coapt tune-regions` (no `--yield-strain`) does it; the paper's 14 sets of numbers are not printed |
| rest shape | that of the mesh | a scan of an unfixed leaflet is 17.3 % smaller in area than the valve in water, one of a fixed leaflet 4.8 % greater (section 3.1): `rest_scale_fibre` and `rest_scale_cross` 1.0996 and 0.9768 take that back, alike in both directions as only areas are printed |
| the valve itself | the mesh and chords of this folder | the paper's scans are not published |

The printed numbers alone do not hold a valve: across one population that is not dispersed only the matrix of 10 kPa carries, and the leaflets bulge far
into the atrium. A helix of H0/r0 = 1.35 and R0/r0 = 5 is straight at a stretch of 23:
as printed, strut chords carry nothing but their matrix. See docs/papers/toma-2016.md.
)";

std::string toma_notes(const Valve& valve) {
  std::string text = kTomaNotes;
  const std::string mark = "$THICKNESS";
  return text.replace(text.find(mark), mark.size(), number_text(valve.thickness, 4));
}

}  // namespace

PaperModel toma_2016_model() {
  return {"toma-2016", "crimped fibres of Toma et al. 2016", apply_toma, toma_notes};
}

}  // namespace coapt::detail
