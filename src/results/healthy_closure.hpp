// What surgeons and engineers ask of a mitral valve that closes well, beside the figures of a result.
// Sources: Toma et al. 2016, section 2.1 (papillary muscles were placed so that these held); of the strain of
// the leaflets Rausch et al. 2011.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct HealthyCriterion {
  std::string name;  // of the figure, with its unit at the end where it has one
  std::string unit;
  double value = 0;
  std::optional<double> lowest, highest;  // of the healthy range; empty: no bound
  std::string meaning;                    // one sentence
  std::string source;                     // paper and section of the range

  bool is_met() const { return !(lowest && value < *lowest) && !(highest && value > *highest); }
};

// What the criteria are judged by.
struct ClosureFigures {
  double anterior_share = 0;        // of the antero-posterior diameter (Closure::anterior_share)
  double coaptation_height_mm = 0;  // 90th percentile along the coaptation line
  double regurgitant_area_mm2 = 0;
  double pressure_mpa = 0;                // on the leaflets; 0: not known
  std::optional<double> strain_p99 = {};  // greatest principal, not exceeded on 99 % of the area
};

// Regurgitant volume of one systole [ml] through an orifice [mm2] under a pressure [MPa]: area times the
// velocity of Bernoulli's equation, sqrt(2 p/rho), times the duration of systole. An upper estimate: no
// contraction of the jet, no pressure in the atrium, the peak pressure throughout. Source: Lancellotti et al.
// 2013 (volume = effective orifice times velocity-time integral). Pre: neither is negative.
double regurgitant_volume_ml(double orifice_mm2, double pressure_mpa);

// In the order of the source; without the volume where the pressure is not known.
std::vector<HealthyCriterion> healthy_criteria(const ClosureFigures& figures);

// The figure in words: "coaptation height 4.9 mm".
std::string figure_in_words(const HealthyCriterion& criterion);

// A range in words: "3 to 5 mm", "at most 5 ml".
std::string range_in_words(const HealthyCriterion& criterion);

// Why the strain of the leaflets is doubtful, a clause with the published values; empty: it is in their
// range, or is not judged.
std::string strain_doubt(const std::vector<HealthyCriterion>& criteria);

}  // namespace coapt
