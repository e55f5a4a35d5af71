#include "valve/generators/rough_tissue.hpp"

#include "core/number_text.hpp"
#include "formats/tissue_laws.hpp"

#include <charconv>
#include <cmath>
#include <set>

namespace coapt {
namespace {

using formats::length_text;
using formats::pressure_text;

constexpr double kSphere = 6, kTube = 12;  // tension over pressure [mm]

// Three digits: as tables of laws have them.
double rounded(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, 2).ptr;
  std::from_chars(text, end, value);
  return value;
}

double first_derivative(const ExponentialSheet& sheet, double j) {
  return 0.5 * sheet.c0 + sheet.c1 * sheet.c2 * j * std::exp(sheet.c2 * j * j);
}

Material linear_leaflet(double pressure, double thickness, RandomSource& random) {
  const double poisson = rounded(random.between(0.3, 0.48)), strain = random.log_between(0.02, 0.12);
  const double young = rounded((1 - poisson) * kSphere * pressure / (strain * thickness));
  return {"cst_tension_field", {{"young", pressure_text(young)}, {"poisson", exact_text(poisson)}}};
}

// c0 and c2 as in measured tricuspid leaflets and a little around them (Mathur et al. 2022: 1 kPa, 4.6 to
// 17.8); c1 follows from the stretch at which the leaflet is to bear its load.
Material exponential_leaflet(double pressure, double thickness, RandomSource& random) {
  constexpr double kMostUniaxial = 1.5;
  constexpr double kSofter =
      0.65;  // a sheet of finite bulk modulus stretches more than its formula here says
  const double c0 = rounded(random.log_between(0.001, 0.01)), c2 = rounded(random.log_between(4, 20));
  double stretch = random.between(1.15, 1.35);
  const bool has_bulk = random.chance(0.5);
  if (has_bulk) stretch = 1 + kSofter * (stretch - 1);
  const double bulk = rounded(random.log_between(0.1, 1));
  ExponentialSheet sheet{c0, 0, c2, thickness};
  do {
    sheet.c1 = 0;
    const double matrix = sheet.biaxial(stretch), wanted = kSphere * pressure;
    sheet.c1 = 1;
    // The tension is linear in c1.
    sheet.c1 = rounded(std::max(1e-5, (wanted - matrix) / (sheet.biaxial(stretch) - matrix)));
    stretch = 1 + 0.9 * (stretch - 1);
  } while (sheet.uniaxial(has_bulk ? 1 + kSofter * (kMostUniaxial - 1) : kMostUniaxial) < kTube * pressure);
  Material law{"cst_exponential",
               {{"c0", pressure_text(c0)}, {"c1", pressure_text(sheet.c1)}, {"c2", exact_text(c2)}}};
  if (has_bulk) law.keys.emplace_back("bulk", pressure_text(bulk));
  return law;
}

// Around the numbers of studies.md for Hammer et al. 2011, at 13 kPa and 1 mm.
Material orthotropic_leaflet(double pressure, double thickness, RandomSource& random) {
  const double scale = pressure / 0.013 / thickness * random.log_between(0.6, 1.6);
  auto modulus = [&](double value) {
    return pressure_text(rounded(scale * value * random.log_between(0.8, 1.25)));
  };
  Material law{"cst_orthotropic", {}};
  law.keys.emplace_back("fibre_young_pre", modulus(0.5));
  law.keys.emplace_back("fibre_young_post", modulus(6));
  law.keys.emplace_back("fibre_transition", exact_text(rounded(random.between(0.1, 0.2))));
  law.keys.emplace_back("cross_young_pre", modulus(0.2));
  law.keys.emplace_back("cross_young_post", modulus(2));
  law.keys.emplace_back("cross_transition", exact_text(rounded(random.between(0.15, 0.3))));
  return law;
}

// 0 linear, 1 exponential (every other one: what tissue is), 2 orthotropic.
int leaflet_type(RandomSource& random) {
  constexpr int kTypes[] = {0, 1, 1, 2};
  return kTypes[random.below(4)];
}

Material leaflet(int type, double pressure, double thickness, RandomSource& random) {
  Material law = type == 0   ? linear_leaflet(pressure, thickness, random)
                 : type == 1 ? exponential_leaflet(pressure, thickness, random)
                             : orthotropic_leaflet(pressure, thickness, random);
  law.keys.emplace_back("thickness", length_text(thickness));
  return law;
}

// Stress in the mean strand that ends at a leaflet: together they bear half the load of an annulus of
// 800 mm^2.
double mean_chord_stress(const Valve& valve) {
  double area = 0;
  for (const Chord& chord : valve.chords.chords)
    if (chord.to.kind == ChordEnd::Kind::Leaflet) area += chord.area;
  return 0.5 * 800 * valve.pressure / area;
}

// Chords by what the mean strand is strained once it is straight. Few strands of many bear the load, so that
// those are strained some twenty times as much: up to a tenth and a little more.
double chord_young(double stress, RandomSource& random) {
  return rounded(stress / random.log_between(0.0005, 0.005));
}

Material linear_chord(double stress, RandomSource& random) {
  return {"cable", {{"young", pressure_text(chord_young(stress, random))}}};
}

// Exponents of the fits of Mathur et al. 2022 (56 to 98) and a little below.
Material ogden_chord(double stress, RandomSource& random) {
  const int terms = 1 + random.below(3);
  const double mu = chord_young(stress, random) / 3, alpha = random.between(40, 100);
  std::vector<double> pairs;
  for (int k = 0; k < terms; ++k) {
    pairs.push_back(rounded(mu / terms * random.between(0.7, 1.3)));
    pairs.push_back(rounded(alpha * random.between(0.95, 1.05)));
  }
  return *formats::ogden_law(pairs);
}

// The toe's slope at its end is the line's, as in the fit of Kaiser et al. 2019 (exponent times strain 7.2).
Material toe_chord(double stress, RandomSource& random) {
  const double recruited = rounded(random.between(0.03, 0.1)),
               exponent = rounded(random.between(5, 8) / recruited);
  const double intercept = recruited + std::expm1(-exponent * recruited) / exponent;
  return {"cable_toe",
          {{"young", pressure_text(chord_young(stress, random))},
           {"recruitment_strain", exact_text(recruited)},
           {"intercept", exact_text(intercept)},
           {"exponent", exact_text(exponent)}}};
}

}  // namespace

double ExponentialSheet::biaxial(double stretch) const {
  const double square = stretch * stretch, fourth = square * square;
  return thickness * 2 * first_derivative(*this, 2 * square + 1 / fourth - 3) *
         (stretch - 1 / (stretch * fourth));
}

double ExponentialSheet::uniaxial(double stretch) const {
  const double square = stretch * stretch;
  return thickness * 2 * first_derivative(*this, square + 2 / stretch - 3) * (stretch - 1 / square);
}

void draw_tissue(RandomSource& random, Valve& valve) {
  constexpr double kOddLeaflet = 0.25;  // share of leaflets of another law than the valve's
  valve.thickness = rounded(random.between(0.4, 1.2));
  const int usual = leaflet_type(random);
  for (const std::string& region : valve.leaflets.region_names) {
    const bool is_odd = random.chance(kOddLeaflet);
    const int other = leaflet_type(random);
    valve.membranes[region] = leaflet(is_odd ? other : usual, valve.pressure, valve.thickness, random);
  }
  std::set<std::string> materials;
  for (const Chord& chord : valve.chords.chords) materials.insert(chord.material);
  const double stress = mean_chord_stress(valve);
  for (const std::string& material : materials) {
    const int type = random.below(3);
    valve.cables[material] = type == 0   ? linear_chord(stress, random)
                             : type == 1 ? ogden_chord(stress, random)
                                         : toe_chord(stress, random);
  }
}

}  // namespace coapt
