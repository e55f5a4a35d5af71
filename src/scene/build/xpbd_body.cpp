#include "scene/build/xpbd_body.hpp"

#include "core/error.hpp"
#include "energy/kernels/bending.hpp"
#include "energy/term_access.hpp"
#include "scene/build/contact_pairs.hpp"
#include "scene/terms/term_types.hpp"
#include "xpbd/options.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kSpringPoisson = 1.0 / 3;  // of edges on equilateral triangles
constexpr double kShrunk = 0.9;             // linear size at which a membrane shows whether it pushes back
constexpr double kPushes = 0.01;            // of its modulus: stress there that counts as resistance

// --- Lines ------------------------------------------------------------------------------------------------

TetherKind tether_kind(TermKind kind) {
  return kind == TermKind::Spring ? TetherKind::Edge
         : kind == TermKind::Link ? TetherKind::Link
                                  : TetherKind::Chord;
}

// A link to which the scene gives no length.
bool is_clip(const EnergyTerm& term, TermKind kind, const std::vector<TermSpec>& specs) {
  if (kind != TermKind::Link) return false;
  const auto spec =
      std::find_if(specs.begin(), specs.end(), [&](const TermSpec& s) { return s.name == term.name(); });
  return spec != specs.end() && !spec->parameters.has("length") && !spec->parameters.flag("keeps_distance");
}

void add_tethers(const EnergyTerm& term, const TermAccess& access, const std::vector<TermSpec>& specs,
                 XpbdBody& body) {
  const bool clips = is_clip(term, access.kind(), specs);
  const int* nodes = term.stencils().nodes.data();
  for (int e = 0; e < term.stencils().count(); ++e, nodes += 2) {
    const LineTraits line = access.line(e);
    body.tethers.push_back({.a = nodes[0],
                            .b = nodes[1],
                            .length = line.length,
                            .stiffness = line.stiffness,
                            .only_tension = !line.resists,
                            .kind = tether_kind(access.kind()),
                            .is_clip = clips,
                            .law = line.is_straight ? nullptr : access.line_law(e)});
  }
}

// --- Hinges, films and other triangles --------------------------------------------------------------------

void add_hinges(const EnergyTerm& term, const TermAccess& access, XpbdBody& body) {
  const Points& X = body.rest;
  const int* n = term.stencils().nodes.data();
  for (int e = 0; e < term.stencils().count(); ++e, n += BendingHinge::kNodes)
    body.hinges.push_back({{n[0], n[1], n[2], n[3]},
                           BendingHinge::angle(X.col(n[0]), X.col(n[1]), X.col(n[2]), X.col(n[3])),
                           access.hinge_stiffness(e)});
}

void add_films(const EnergyTerm& term, const TermAccess& access, XpbdBody& body) {
  const int* n = term.stencils().nodes.data();
  for (int e = 0; e < term.stencils().count(); ++e, n += 3)
    body.films.push_back({{n[0], n[1], n[2]}, access.film_tension(e)});
}

void add_triangles(const EnergyTerm& term, const TermAccess& access, XpbdBody& body) {
  const int* n = term.stencils().nodes.data();
  for (int e = 0; e < term.stencils().count(); ++e, n += 3)
    body.others.push_back({{n[0], n[1], n[2]}, access.element_energy(e)});
}

// What the registry says of a term of the model, if that is one of the registry's.
XpbdConstraint constraint_of(const EnergyTerm& term) {
  const TermType* type = find_term_type(std::string(term.type()));
  return type == nullptr || type->kind != kind_of(term) ? XpbdConstraint::None : type->xpbd;
}

// Of membranes all together: see add_membrane(). False: there is no constraint for the term.
bool add_constraints(const EnergyTerm& term, const std::vector<TermSpec>& specs, XpbdBody& body) {
  const TermAccess* access = access_of(term);
  const XpbdConstraint constraint = constraint_of(term);
  if (constraint == XpbdConstraint::Tethers) add_tethers(term, *access, specs, body);
  if (constraint == XpbdConstraint::Films) add_films(term, *access, body);
  if (constraint == XpbdConstraint::Hinges) add_hinges(term, *access, body);
  if (constraint == XpbdConstraint::Energy) add_triangles(term, *access, body);
  return constraint != XpbdConstraint::None;
}

// --- Membranes --------------------------------------------------------------------------------------------

// What covers a triangle whose membrane its edges stand for; only these know whether they push back where
// they are made smaller.
enum class Cover : char { None, Relaxed, Resisting };

bool has_edges(const Model& model, const MembranePatch& patch) {
  const auto& terms = model.objective->terms();
  return std::any_of(terms.begin(), terms.end(), [&](const auto& term) {
    return term->name() == patch.term && constraint_of(*term) == XpbdConstraint::Edges;
  });
}

std::vector<Cover> covers(const Model& model) {
  std::vector<Cover> all(static_cast<size_t>(model.mesh.triangle_count()), Cover::None);
  for (const MembranePatch& patch : model.membrane_patches) {
    if (!has_edges(model, patch)) continue;
    for (size_t e = 0; e < patch.triangles.size(); ++e) {
      const auto t = static_cast<size_t>(patch.triangles[e]);
      const auto corners = model.mesh.triangles.col(patch.triangles[e]);
      CstVector x;
      for (int k = 0; k < 3; ++k) x.segment<3>(3 * k) = kShrunk * model.X.col(corners[k]);
      const bool pushes =
          patch.state(static_cast<int>(e), x).stress.minCoeff() < -kPushes * model.membrane[t].young;
      all[t] = pushes ? Cover::Resisting : Cover::Relaxed;
    }
  }
  return all;
}

// E' of the edges.
double spring_modulus(const MembraneProperties& m) {
  return m.poisson < kSpringPoisson ? m.young : 4 * m.young / (3 * (1 + m.poisson));
}

void add_membrane(const Model& model, XpbdBody& body) {
  if (model.membrane_patches.empty()) return;
  const std::vector<Cover> cover = covers(model);
  const Triangles& triangles = model.mesh.triangles;
  Vector areas(triangles.cols());
  for (int t = 0; t < triangles.cols(); ++t) {
    const auto corners = triangles.col(t);
    areas[t] = area_vector(model.X, corners).norm();
    if (cover[static_cast<size_t>(t)] == Cover::None) continue;
    const MembraneProperties& m = model.membrane[static_cast<size_t>(t)];
    const std::array<int, 3> nodes{corners[0], corners[1], corners[2]};
    const double resultant = m.young * m.thickness;
    if (m.poisson > kSpringPoisson && resultant > 0)
      body.areas.push_back({nodes, areas[t],
                            resultant * (3 * m.poisson - 1) / (2 * (1 - m.poisson * m.poisson) * areas[t]),
                            cover[static_cast<size_t>(t)] == Cover::Relaxed});
    if (m.prestress > 0) body.films.push_back({nodes, m.prestress});
  }
  for (const Edge& edge : edges(triangles)) {
    const double length = (model.X.col(edge.a) - model.X.col(edge.b)).norm();
    double stiffness = 0;
    bool only_tension = true;
    for (const int t : edge.triangles) {
      if (cover[static_cast<size_t>(t)] == Cover::None) continue;
      const MembraneProperties& m = model.membrane[static_cast<size_t>(t)];
      stiffness += spring_modulus(m) * m.thickness * areas[t] / (length * length);
      only_tension = only_tension && cover[static_cast<size_t>(t)] == Cover::Relaxed;
    }
    if (stiffness > 0) body.edges.push_back({edge.a, edge.b, length, stiffness, only_tension});
  }
}

}  // namespace

std::shared_ptr<const XpbdBody> xpbd_body(const Model& model, const std::vector<TermSpec>& terms) {
  auto body = std::make_shared<XpbdBody>();
  body->rest = model.X;
  body->triangles = model.mesh.triangles;
  body->obstacles = model.obstacles;
  body->pressure = model.applied_pressure;
  if (const auto annulus = model.sets.find("annulus"); annulus != model.sets.end())
    body->annulus = annulus->second;
  std::vector<std::string> defects;
  for (const auto& term : model.objective->terms()) {
    if (term->role() == TermRole::Contact) body->has_contact = true;
    if (term->role() == TermRole::Internal && !add_constraints(*term, terms, *body))
      defects.push_back("solver \"xpbd\" has no constraint for term \"" + term->name() + "\" (" +
                        std::string(term->type()) + "); leave it out or take another solver");
  }
  if (!defects.empty()) throw InputError(defects);
  add_membrane(model, *body);
  body->is_exact = body->edges.empty() && body->areas.empty() && body->hinges.empty() && !body->has_contact;
  for (const TermSpec& term : terms)
    if (is_barrier(term) && term.parameters.has("exclude"))
      for (const auto& pair :
           read_facet_pairs(term.parameters.text("exclude"),
                            static_cast<int>(model.mesh.triangles.cols() + model.obstacles.cols())))
        body->excluded.push_back(pair);
  return body;
}

bool xpbd_takes_the_loads(const Scene& scene) {
  return !scene.solver.xpbd || scene.solver.xpbd->forces == XpbdForces::Scene;
}

bool xpbd_moves_the_scene_itself(const Scene& scene) {
  const XpbdOptions options = scene.solver.xpbd ? *scene.solver.xpbd : XpbdOptions{};
  return options.stiffness == XpbdStiffness::Material && options.forces == XpbdForces::Scene &&
         options.phase == HeartPhase::Systole &&
         std::none_of(scene.terms.begin(), scene.terms.end(), [](const TermSpec& term) {
           const TermType& type = type_of(term);
           return type.xpbd == XpbdConstraint::Edges || type.xpbd == XpbdConstraint::Hinges ||
                  type.kind == TermKind::Contact;
         });
}

}  // namespace coapt
