#include "run/judged_scene.hpp"

#include "scene/build/build.hpp"
#include "scene/build/contact_pairs.hpp"
#include "solve/solve_scene.hpp"
#include "support/contact_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace coapt {

long JudgedScene::pairs_in_contact() const {
  long pairs = 0;
  for (const TermReport& term : outcome.result.terms)
    if (term.type == "contact_barrier") pairs += term.counters.elements;
  return pairs;
}

JudgedScene solve_judged(const Scene& scene) {
  RunOptions options;
  options.factorisations = built_in_factorisations();
  SolveSetup setup = solve_setup(scene, scene_solvers(), options);
  JudgedScene judged;
  const Model* level = nullptr;  // whose iterates the observer sees
  setup.make_solver = [&, make = setup.make_solver](const Model& model) {
    level = &model;
    return make(model);
  };
  setup.observer = [&](const Iteration&, const Vector& q) {
    const long seen = judged_intersections(level->objective->positions(q), all_facets(*level),
                                           level->mesh.triangle_count());
    ++judged.iterates;
    judged.intersections = std::max(judged.intersections, seen);
    return true;
  };
  const SceneGeometry geometry = scene_geometry(scene);
  judged.model = build(scene, geometry);
  judged.outcome = solve_scene(scene, geometry, judged.model, setup);
  judged.metrics =
      measure(judged.model, judged.outcome.result.q, compute_fields(judged.model, judged.positions()));
  return judged;
}

void expect_no_intersection(const std::string& name, const JudgedScene& judged) {
  const Result& result = judged.outcome.result;
  EXPECT_EQ(result.status, Status::Converged) << name << ": " << result.message;
  EXPECT_EQ(judged.intersections, 0) << name << ", at an iterate";
  EXPECT_EQ(judged.metrics.intersections, 0) << name << ", at the end";
  EXPECT_GT(judged.iterates, result.iterations) << name << ": iterates escaped the judge";
  std::printf("%s: %d iterations, %.2f s, %ld pairs in contact, %ld iterates judged\n", name.c_str(),
              result.iterations, result.wall_s, judged.pairs_in_contact(), judged.iterates);
}

void expect_contact_without_intersection(const std::string& name, const JudgedScene& judged) {
  expect_no_intersection(name, judged);
  EXPECT_GT(judged.pairs_in_contact(), 0) << name << ": nothing touches";
}

}  // namespace coapt
