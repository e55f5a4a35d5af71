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

std::vector<std::pair<std::string, std::string>> crimp_keys(const Crimp& crimp) {
  return {{"fibre_young", kFibreYoung},
          {"crimp_ratio", exact_text(crimp.wavelength / crimp.amplitude)},
          {"radius_ratio", exact_text(crimp.amplitude)},
          {"shear_modulus", "\"10 kPa\""}};
}

Material leaflet_law(const Crimp& crimp, double thickness) {
  Material law{"cst_crimped_fibre", crimp_keys(crimp)};
  law.keys.emplace_back("thickness", quoted(exact_text(thickness) + " mm"));
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

## Where it is not followed

| what | the paper | here | why |
|---|---|---|---|
| load | a fluid of particles, pushed by pistons | pressure on the leaflets, at rest | Coapt has no fluid |
| body | three layers of tetrahedra, chords as solids | surface and lines, with the plate's bending stiffness | |
| fibre populations | two, eq. 1 | one | the paper prints no direction of the second |
| dispersion | a Gaussian in space, tensor K, eq. 2 | in the plane of the surface (`splay`), set to 0 | its splay parameters are those of its reference Freed et al. 2005, not printed |
| active fibre stress | a term of eq. 1 | none | no number is printed; closed and held |
| yield and failure of fibres | Algorithm 1 of the appendix | none: the stress goes on | no number is printed |
| bulk modulus | 2.8e4 kPa, lowered for the time step | incompressible | the paper calls the true value a thousand times greater |

## What it leaves open, and what was chosen

| what | chosen | reason |
|---|---|---|
| H0/r0 of chords between strut and marginal | 90 | "varied for most chordae": only the two ends are printed |
| leaflets of other names, such as a septal one | the crimp of the posterior leaflet | the paper has a mitral valve |
| thickness | $THICKNESS mm | the valve's; the paper has it from its scan |
| tuning to the yield strain | none | `coapt tune-regions` does it (docs/studies.md); its 14 sets of numbers are not printed |
| the valve itself | the mesh and chords of this folder | the paper's scans are not published |

These numbers do not hold a valve: across fibres that are not dispersed only the matrix of 10 kPa carries, and the leaflets bulge far into the atrium.
A `splay` of the leaflets above 0, such as 0.5, is the remedy nearest to the paper. A helix of H0/r0 = 1.35 and R0/r0 = 5 is straight at a stretch of 23:
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
