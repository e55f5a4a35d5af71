// Scenes solved with a judge at every accepted iterate, on every mesh of a cascade.
#pragma once

#include "results/metrics.hpp"
#include "scene/file/scene.hpp"
#include "solve/cascade.hpp"

#include <string>

namespace coapt {

// What exact predicates (mesh/distance/intersections.hpp) saw of a solve.
struct JudgedScene {
  Model model;  // of the scene's own mesh
  CascadeOutcome outcome;
  Metrics metrics;         // of the end
  long iterates = 0;       // accepted, the start of each mesh and step included
  long intersections = 0;  // most pairs of facets that passed through each other at one of them, of the
                           // membrane or of it and obstacles

  Points positions() const { return model.objective->positions(outcome.result.q); }
  long pairs_in_contact() const;  // of the barrier, at the end
};

// With the fastest factorisation of the build. Throws InputError.
JudgedScene solve_judged(const Scene& scene);

// Expects that the scene converged and that nothing passed through anything at any iterate.
void expect_no_intersection(const std::string& name, const JudgedScene& judged);

// And that something touches.
void expect_contact_without_intersection(const std::string& name, const JudgedScene& judged);

}  // namespace coapt
