#include "results/healthy_closure.hpp"

#include "core/number_text.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kBloodDensity = 1060;   // [kg/m3]
constexpr double kSystole = 0.3;         // [s], at some 70 beats a minute
constexpr double kShareTolerance = 0.1;  // of the diameter: 2/3 is read by eye off an ultrasound image
constexpr double kPascals = 1e6;         // of a MPa
constexpr const char* kSource = "Toma et al. 2016, section 2.1";

// In vivo, of the anterior leaflets of 57 sheep over the beat: average peak of the maximum principal strain
// and its standard deviation.
constexpr double kPeakStrain = 0.13, kPeakDeviation = 0.047;
constexpr double kDeviations = 2;  // that a healthy valve may lie above the mean
constexpr const char* kStrain = "p99_principal_strain";

}  // namespace

double regurgitant_volume_ml(double orifice_mm2, double pressure_mpa) {
  return orifice_mm2 * std::sqrt(2 * kPascals * pressure_mpa / kBloodDensity) * kSystole;  // mm2 m = ml
}

std::vector<HealthyCriterion> healthy_criteria(const ClosureFigures& figures) {
  std::vector<HealthyCriterion> criteria = {
      {"anterior_share", "", figures.anterior_share, 2.0 / 3 - kShareTolerance, 2.0 / 3 + kShareTolerance,
       "share of the antero-posterior diameter over which the anterior leaflet is seen; healthy: about 2/3",
       kSource},
      {"coaptation_height_mm", "mm", figures.coaptation_height_mm, 3, 5,
       "extent of contact below and across the coaptation line: 90th percentile along it", kSource}};
  if (figures.pressure_mpa > 0)
    criteria.push_back({"regurgitant_volume_ml", "ml",
                        regurgitant_volume_ml(figures.regurgitant_area_mm2, figures.pressure_mpa),
                        std::nullopt, 5,
                        "upper estimate for one systole: regurgitant area times the velocity of Bernoulli's "
                        "equation times 0.3 s",
                        kSource});
  if (figures.strain_p99)
    criteria.push_back(
        {kStrain, "", *figures.strain_p99, std::nullopt, kPeakStrain + kDeviations * kPeakDeviation,
         "greatest principal strain, not exceeded on 99 % of the leaflets; healthy: no more than two "
         "standard deviations above the average peak in vivo, 13.0 +- 4.7 % in the anterior "
         "leaflets of 57 sheep",
         "Rausch et al. 2011, abstract"});
  return criteria;
}

std::string figure_in_words(const HealthyCriterion& criterion) {
  std::string words = criterion.name;
  const std::string unit = "_" + criterion.unit;
  if (!criterion.unit.empty() && words.ends_with(unit)) words.resize(words.size() - unit.size());
  std::replace(words.begin(), words.end(), '_', ' ');
  return words + " " + number_text(criterion.value, 2) + (criterion.unit.empty() ? "" : " " + criterion.unit);
}

std::string range_in_words(const HealthyCriterion& criterion) {
  const auto text = [](double number) { return number_text(number, 2); };
  const std::string unit = criterion.unit.empty() ? "" : " " + criterion.unit;
  if (criterion.lowest && criterion.highest)
    return text(*criterion.lowest) + " to " + text(*criterion.highest) + unit;
  if (criterion.highest) return "at most " + text(*criterion.highest) + unit;
  return criterion.lowest ? "at least " + text(*criterion.lowest) + unit : "any";
}

std::string strain_doubt(const std::vector<HealthyCriterion>& criteria) {
  const auto strain = std::find_if(criteria.begin(), criteria.end(),
                                   [](const HealthyCriterion& each) { return each.name == kStrain; });
  if (strain == criteria.end() || strain->is_met()) return "";
  return "1 % of the leaflets strained above " + number_text(100 * strain->value, 2) +
         " % (in vivo: peaks of 13 +- 4.7 %, Rausch 2011)";
}

}  // namespace coapt
