// S24: memory by triangle, and pairs of contact by facet.
#include "core/number_text.hpp"
#include "mesh/shapes.hpp"
#include "scene/build/build.hpp"
#include "scene/terms/term_types.hpp"
#include "solve/peak_memory.hpp"
#include "stress/scenes/pressed.hpp"
#include "stress/subject.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

constexpr double kMostBytes = 1024;  // for a triangle, without contact and factor

// The greatest size that terms, gradient and Hessian take, over the number of triangles.
StressOutcome bytes_by_triangle(const StressScene& scene) {
  const PeakMemory memory;
  const Model model = build(scene.scene, scene.geometry);
  const Vector q = model.objective->unknowns(model.X);
  Vector gradient;
  Eigen::SparseMatrix<double> hessian;
  const double energy = model.objective->hessian(q, gradient, hessian);
  const std::optional<double> risen = memory.risen_mb();
  if (!risen) return {StressVerdict::NotApplicable, {}, {}, "the system does not tell the size of a process"};
  const double bytes = *risen * 1024 * 1024 / model.mesh.triangle_count();
  const bool holds = bytes <= kMostBytes && std::isfinite(energy);
  return {holds ? StressVerdict::Pass : StressVerdict::Fail, bytes, kMostBytes,
          number_text(*risen) + " MB for " + std::to_string(model.mesh.triangle_count()) + " triangles"};
}

BuiltScene large_disc(int triangles) {
  return {.name = "S24_disc_" + std::to_string(triangles),
          .text = R"({ // A clamped disc of many triangles. Lengths in mm.
  "mesh": { "file": "mesh.obj" },
  "boundary": [{ "nodes": "boundary", "fix": true }],
  "terms": [
    { "type": "cst_tension_field", "young": "1 MPa", "poisson": 0.3, "thickness": "0.1 mm" },
    { "type": "load_pressure", "value": "1 kPa" }
  ],
  "solver": { "type": "newton", "tolerance": 1e-6, "max_iterations": 1000 }
}
)",
          .mesh = disc(10, triangles)};
}

struct Pairs {
  double facets = 0, listed = 0, active = 0;
};

// A sheet laid on the same sheet, all of it within the range of contact.
Pairs pairs_of(const StressRunner& bench, int triangles) {
  const TriangleMesh sheet = square(1, triangles);
  const double gap = 0.3 / std::sqrt(sheet.triangle_count() / 2.0), height = 3 * gap;
  const StressScene scene = written(bench.options().folder / "scenes",
                                    pressed_scene("S24_pressed_" + std::to_string(triangles), triangles,
                                                  height, sheet, 0.1, barrier_term(gap)));
  Model model = build(scene.scene, scene.geometry);
  Points x = model.X;
  x.row(2).array() -= height - 0.5 * gap;
  Vector gradient;
  model.objective->gradient(model.objective->unknowns(x), gradient);
  for (const auto& term : model.objective->terms())
    if (term->limits_steps())
      return {2.0 * sheet.triangle_count(), static_cast<double>(term->counters().candidates),
              static_cast<double>(term->counters().elements)};
  return {};
}

StressOutcome pairs_by_facet(const StressRunner& bench, int triangles) {
  constexpr int kFewer = 16;
  constexpr double kMost = 1.5;  // a list of all pairs would have sixteen times as many for each facet
  const Pairs few = pairs_of(bench, triangles / kFewer), many = pairs_of(bench, triangles);
  const double growth = many.listed / many.facets / (few.listed / few.facets);
  const bool holds = growth <= kMost && many.active > 0;
  return {holds ? StressVerdict::Pass : StressVerdict::Fail, growth, kMost,
          number_text(many.facets) + " facets: " + number_text(many.active) + " pairs touch, " +
              number_text(many.listed) + " are listed, " + number_text(many.listed / many.facets) +
              " for each facet"};
}

}  // namespace

std::vector<StressRow> large_scene_rows(const StressRunner& bench) {
  const auto memory = [&](int triangles) -> StressRow {
    return {"S24",
            "disc",
            std::to_string(triangles) + " triangles",
            "memory for each triangle",
            "B",
            false,
            [bench, triangles] {
              return bytes_by_triangle(written(bench.options().folder / "scenes", large_disc(triangles)));
            }};
  };
  const auto pairs = [&](int triangles, bool is_quick) -> StressRow {
    return {"S24",
            "sheet on a sheet",
            std::to_string(triangles) + " triangles in contact, and a sixteenth",
            "growth of the pairs for each facet",
            "",
            is_quick,
            [bench, triangles] { return pairs_by_facet(bench, triangles); }};
  };
  return {memory(250000), pairs(3200, true), pairs(50000, false)};
}

std::vector<StressRow> size_rows(const SubjectPointer& subject) {
  constexpr int kFewest = 10000;  // below, what does not grow with the mesh hides what does
  return {{"S24", subject->name, "terms, gradient and Hessian", "memory for each triangle", "B", false,
           [subject]() -> StressOutcome {
             const StressScene& scene = own_scene(*subject);
             if (scene.geometry.model.mesh.triangle_count() < kFewest)
               return {StressVerdict::NotApplicable, {}, {}, "fewer than 10000 triangles say nothing"};
             const auto& terms = scene.scene.terms;
             if (std::any_of(terms.begin(), terms.end(),
                             [](const TermSpec& term) { return kind_of(term) == TermKind::Contact; }))
               return {StressVerdict::NotApplicable, {}, {}, "the limit is that of scenes without contact"};
             return bytes_by_triangle(scene);
           }}};
}

}  // namespace coapt
