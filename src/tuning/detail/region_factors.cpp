#include "tuning/detail/region_factors.hpp"

#include "scene/build/build_parts.hpp"
#include "sensitivity/parameters/line_access.hpp"
#include "sensitivity/parameters/term_number.hpp"

#include <algorithm>
#include <memory>

namespace coapt {
namespace {

using Names = std::vector<std::string>;

bool is_among(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// Elastic terms that are no lines and have no factor of their own, such as bending.
Names followers_of(const TunedScene& tuned, const Objective& objective) {
  Names with_factor, followers;
  for (Eigen::Index k = 0; k < tuned.factor_count(); ++k)
    for (const std::string& name : tuned.terms_of(k)) with_factor.push_back(name);
  for (const auto& term : objective.terms())
    if (term->role() == TermRole::Internal && line_access(*term) == nullptr &&
        !is_among(with_factor, term->name()))
      followers.push_back(term->name());
  return followers;
}

// The logarithms as they are now, and what the terms are made from.
struct Factors {
  const TunedScene& tuned;
  Vector logarithms;

  // Terms by name, in this order, with one logarithm as given. needed: what they are built from.
  std::vector<std::unique_ptr<EnergyTerm>> terms(Eigen::Index which, double value, const Names& names,
                                                 const Names& needed) const {
    Vector there = logarithms;
    there[which] = value;
    Scene scene = tuned.scene(there.array().exp());
    std::erase_if(scene.terms, [&](const TermSpec& spec) { return !is_among(needed, spec.name); });
    std::vector<std::unique_ptr<EnergyTerm>> made = build_terms(scene, tuned.geometry), wanted;
    for (const std::string& name : names)
      wanted.push_back(std::move(*std::find_if(
          made.begin(), made.end(), [&](const auto& term) { return term && term->name() == name; })));
    return wanted;
  }
};

TermNumber number_of(const std::shared_ptr<Factors>& factors, Eigen::Index which, const Names& followers,
                     const Objective& objective) {
  const TunedScene& tuned = factors->tuned;
  Names names = tuned.terms_of(which), needed = names;
  if (tuned.is_region(which) && !followers.empty()) {  // these are made of all membranes
    names.insert(names.end(), followers.begin(), followers.end());
    needed = followers;
    for (Eigen::Index k = 0; k < tuned.factor_count(); ++k)
      for (const std::string& name : tuned.terms_of(k)) needed.push_back(name);
  }
  TermNumber number;
  number.scale = 1;
  for (const std::string& name : names)
    for (const auto& term : objective.terms())
      if (term->name() == name) number.terms.push_back(term.get());
  number.terms_at = [factors, which, names, needed](double value) {
    return factors->terms(which, value, names, needed);
  };
  number.defect = [](double) { return std::string(); };
  number.keep = [factors, which](double value) { factors->logarithms[which] = value; };
  return number;
}

}  // namespace

EquilibriumMaker region_factor_maker(const TunedScene& tuned, Model& model, const TrackingOptions& tracking) {
  const auto factors = std::make_shared<Factors>(Factors{tuned, Vector::Zero(tuned.factor_count())});
  const Names followers = followers_of(tuned, *model.objective);
  return [&model, tracking, factors, followers](const Vector& q) {
    const bool has_changed = !factors->logarithms.isZero(0);
    factors->logarithms.setZero();
    auto equilibrium = std::make_unique<TrackedEquilibrium>(*model.objective, q, tracking);
    for (Eigen::Index k = 0; k < factors->logarithms.size(); ++k) {
      auto parameter =
          make_term_number("factor " + std::to_string(k), number_of(factors, k, followers, *model.objective));
      if (has_changed) parameter->set(Vector::Zero(1));
      equilibrium->add(std::move(parameter));
    }
    return equilibrium;
  };
}

}  // namespace coapt
