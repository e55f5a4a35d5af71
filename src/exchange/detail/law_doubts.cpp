#include "exchange/detail/law_doubts.hpp"

#include "core/number_text.hpp"
#include "scene/terms/term_types.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

namespace coapt::detail {
namespace {

// Generous: from the toe of an exponential law and loose matrices to stiff polymers and wires [MPa].
constexpr double kMembraneStretch = 1.1, kChordStrain = 0.02;
constexpr std::array<double, 2> kMembraneStress = {1e-5, 100};  // Cauchy, at kMembraneStretch both ways
constexpr std::array<double, 2> kChordStress = {1e-4, 1000};    // nominal, at kChordStrain

bool is_within(double value, const std::array<double, 2>& range) {
  return value >= range[0] && value <= range[1];
}

std::string doubt(const std::string& name, const std::string& what, double stress,
                  const std::array<double, 2>& range) {
  return "\"" + name + "\": " + what + " has a stress of " + number_text(stress) +
         " MPa; tissues and polymers have " + number_text(range[0]) + " to " + number_text(range[1]) +
         " MPa. Check the unit of its moduli.";
}

std::optional<StressCurve> curve_of(const TermSpec& term) {
  const TermType* type = find_term_type(term.type);
  if (type == nullptr || type->kind != TermKind::Line || !type->stress_curve) return std::nullopt;
  return type->stress_curve(term.parameters);
}

// The end of a curve goes on straight.
double stress_at(const StressCurve& curve, double strain) {
  double from = 0, low = 0, slope = 0;
  for (const auto& [to, high] : curve.points) {
    slope = (high - low) / (to - from);
    if (strain <= to) break;
    from = to;
    low = high;
  }
  return low + slope * (strain - from);
}

double strain_at(const StressCurve& curve, double stress) {
  double from = 0, low = 0, slope = 0;
  for (const auto& [to, high] : curve.points) {
    slope = (high - low) / (to - from);
    if (stress <= high) break;
    from = to;
    low = high;
  }
  return slope > 0 ? from + (stress - low) / slope : std::numeric_limits<double>::infinity();
}

// In the middle of those of up to a hundred triangles; none where stress has no meaning.
std::optional<double> usual_stress(const Model& model, const MembranePatch& patch) {
  constexpr size_t kSamples = 100;
  std::vector<double> stress;
  const size_t step = std::max<size_t>(1, patch.triangles.size() / kSamples);
  for (size_t e = 0; e < patch.triangles.size(); e += step) {
    CstVector corners;
    for (int k = 0; k < 3; ++k)
      corners.segment<3>(3 * k) = kMembraneStretch * model.X.col(model.mesh.triangles(k, patch.triangles[e]));
    const MembraneState state = patch.state(static_cast<int>(e), corners);
    if (state.has_thickness) stress.push_back(state.cauchy[0]);
  }
  if (stress.empty()) return std::nullopt;
  const auto middle = stress.begin() + static_cast<std::ptrdiff_t>(stress.size() / 2);
  std::nth_element(stress.begin(), middle, stress.end());
  return *middle;
}

}  // namespace

ChordLimits chord_limits(const Scene& scene) {
  ChordLimits limits;
  for (const TermSpec& term : scene.terms) {
    const std::optional<StressCurve> curve = curve_of(term);
    if (!curve || term.parameters.has("edges")) continue;
    const double strain = strain_at(*curve, kMostChordStress);
    if (!term.parameters.has("materials")) {
      limits.of_all = std::min(limits.of_all, strain);
      continue;
    }
    for (const std::string& material : term.parameters.texts("materials")) {
      const auto [known, is_new] = limits.by_material.emplace(material, strain);
      if (!is_new) known->second = std::min(known->second, strain);
    }
  }
  return limits;
}

std::vector<std::string> law_doubts(const Scene& scene, const Model& model) {
  std::vector<std::string> doubts;
  for (const MembranePatch& patch : model.membrane_patches) {
    const std::optional<double> stress = usual_stress(model, patch);
    if (stress && !is_within(*stress, kMembraneStress))
      doubts.push_back(doubt(
          patch.term,
          "a membrane that, stretched by " + number_text(100 * (kMembraneStretch - 1)) + " % both ways,",
          *stress, kMembraneStress));
  }
  for (const TermSpec& term : scene.terms) {
    const std::optional<StressCurve> curve = curve_of(term);
    if (!curve || term.parameters.has("edges")) continue;
    const double stress = stress_at(*curve, kChordStrain);
    if (!is_within(stress, kChordStress))
      doubts.push_back(doubt(term.name,
                             "chords whose law at a strain of " + number_text(100 * kChordStrain) + " %",
                             stress, kChordStress));
  }
  return doubts;
}

std::vector<std::string> load_doubts(const Scene& scene) {
  std::vector<std::string> doubts;
  for (const TermSpec& term : scene.terms) {
    const char* key = kind_of(term) == TermKind::Pressure ? "value" : "pressure";
    const TermType* type = find_term_type(term.type);
    const bool has_key =
        type != nullptr && std::any_of(type->spec.keys.begin(), type->spec.keys.end(),
                                       [&](const KeySpec& spec) { return spec.name == key; });
    if (!has_key || type->kind == TermKind::Contact || !term.parameters.has(key)) continue;
    if (!(term.parameters.number(key) < 0)) continue;
    doubts.push_back(term.parameters.where(key) +
                     ": is negative, so the pressure pulls the leaflets instead "
                     "of closing them; give its size" +
                     (kind_of(term) == TermKind::Pressure
                          ? ", and `\"side\": \"back\"` where it acts on the other side."
                          : "."));
  }
  return doubts;
}

}  // namespace coapt::detail
