// Tissue of rough valves at random, as strong as the pressure asks for.
#pragma once

#include "core/random_source.hpp"
#include "formats/valve.hpp"

namespace coapt {

// Draws thickness (0.4 to 1.2 mm), a law for each region of valve.leaflets and one for each material of
// valve.chords: linear, exponential (with or without a bulk modulus) or orthotropic leaflets; linear, Ogden
// or toe chords. The constants of a law are drawn so that tensions of a closed valve, 6 and 12 mm times
// valve.pressure (a sphere's and a tube's of 12 mm radius), are borne at moderate stretch: below 1.35
// and 1.5. Pre: valve.pressure > 0.
void draw_tissue(RandomSource& random, Valve& valve);

// Tension per length of an exponential sheet without volume change, at rest `thickness` [mm] thick, stretched
// equally both ways, or by l1 with nothing across [N/mm]. Law: psi of cst_exponential, c0 and c1 in MPa.
struct ExponentialSheet {
  double c0, c1, c2, thickness;
  double biaxial(double stretch) const;
  double uniaxial(double stretch) const;
};

}  // namespace coapt
