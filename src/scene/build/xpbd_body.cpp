#include "scene/build/xpbd_body.hpp"

#include "core/error.hpp"
#include "energy/element_term.hpp"
#include "energy/kernels/bending.hpp"
#include "energy/kernels/cable.hpp"
#include "energy/kernels/cable_law.hpp"
#include "energy/kernels/spring.hpp"
#include "energy/kernels/surface_tension.hpp"
#include "energy/kernels/tether_cubic.hpp"
#include "scene/build/contact_pairs.hpp"
#include "xpbd/options.hpp"

#include <algorithm>

namespace coapt {
namespace {

constexpr double kSpringPoisson = 1.0 / 3;  // of edges on equilateral triangles
constexpr double kShrunk = 0.9;             // linear size at which a membrane shows whether it pushes back
constexpr double kPushes = 0.01;            // of its modulus: stress there that counts as resistance

// --- Lines ------------------------------------------------------------------------------------------------

XpbdTether tether_of(const Cable::Rest& rest) {
  XpbdTether tether;
  tether.length = rest.length;
  tether.stiffness = rest.stiffness;
  if (rest.smoothing > 0 || rest.tension > 0)
    tether.law = [rest](double l) {
      AxialLaw law = Cable::elastic(rest, l - rest.length);
      law.force += rest.tension;
      return law;
    };
  return tether;
}

template <typename Law>
XpbdTether tether_of(const typename CableLaw<Law>::Rest& rest) {
  XpbdTether tether;
  tether.length = rest.length;
  tether.law = [rest](double l) { return CableLaw<Law>::elastic(rest, l / rest.length - 1); };
  return tether;
}

XpbdTether tether_of(const Spring::Rest& rest) {
  XpbdTether tether;
  tether.length = rest.length;
  tether.only_tension = !rest.resists;
  tether.is_edge = true;
  tether.law = [rest](double l) { return Spring::elastic(rest, l / rest.length - 1); };
  return tether;
}

XpbdTether tether_of(const TetherCubic::Rest& rest) {
  XpbdTether tether;
  tether.length = rest.length;
  tether.law = [rest](double l) {
    const double u = std::max(l - rest.length, 0.0) / rest.scale;
    return AxialLaw{rest.strength * u * u * u, 3 * rest.strength * u * u / rest.scale,
                    6 * rest.strength * u / (rest.scale * rest.scale)};
  };
  return tether;
}

template <typename Kernel, typename TetherOf>
bool add_lines(const EnergyTerm& term, const TetherOf& tether_of_rest, XpbdBody& body) {
  const auto* lines = dynamic_cast<const ElementTerm<Kernel>*>(&term);
  if (lines == nullptr) return false;
  const int* nodes = term.stencils().nodes.data();
  for (const auto& rest : lines->rest()) {
    XpbdTether tether = tether_of_rest(rest);
    tether.a = *nodes++;
    tether.b = *nodes++;
    body.tethers.push_back(std::move(tether));
  }
  return true;
}

template <typename Law>
bool add_cable_law(const EnergyTerm& term, XpbdBody& body) {
  return add_lines<CableLaw<Law>>(
      term, [](const auto& rest) { return tether_of<Law>(rest); }, body);
}

bool add_any_lines(const EnergyTerm& term, XpbdBody& body) {
  const auto by_kernel = [](const auto& rest) { return tether_of(rest); };
  return add_lines<Cable>(term, by_kernel, body) || add_lines<TetherCubic>(term, by_kernel, body) ||
         add_lines<Spring>(term, by_kernel, body) || add_cable_law<BilinearLine>(term, body) ||
         add_cable_law<OgdenLine>(term, body) || add_cable_law<ToeLine>(term, body) ||
         add_cable_law<CrimpedLine>(term, body);
}

// --- Hinges and films -------------------------------------------------------------------------------------

bool add_hinges(const EnergyTerm& term, XpbdBody& body) {
  const auto* hinges = dynamic_cast<const ElementTerm<BendingHinge>*>(&term);
  if (hinges == nullptr) return false;
  const Points& X = body.rest;
  const int* n = term.stencils().nodes.data();
  for (const BendingHinge::Rest& rest : hinges->rest()) {
    body.hinges.push_back({{n[0], n[1], n[2], n[3]},
                           BendingHinge::angle(X.col(n[0]), X.col(n[1]), X.col(n[2]), X.col(n[3])),
                           rest.stiffness});
    n += BendingHinge::kNodes;
  }
  return true;
}

bool add_films(const EnergyTerm& term, XpbdBody& body) {
  const auto* films = dynamic_cast<const ElementTerm<SurfaceTension>*>(&term);
  if (films == nullptr) return false;
  const int* n = term.stencils().nodes.data();
  for (const SurfaceTension::Rest& rest : films->rest()) {
    body.films.push_back({{n[0], n[1], n[2]}, rest.tension});
    n += SurfaceTension::kNodes;
  }
  return true;
}

// --- Membranes --------------------------------------------------------------------------------------------

// What covers a triangle; only these know whether they push back where they are made smaller.
enum class Cover : char { None, Relaxed, Resisting };

std::vector<Cover> covers(const Model& model) {
  std::vector<Cover> all(static_cast<size_t>(model.mesh.triangle_count()), Cover::None);
  for (const MembranePatch& patch : model.membrane_patches)
    for (size_t e = 0; e < patch.triangles.size(); ++e) {
      const auto t = static_cast<size_t>(patch.triangles[e]);
      const auto corners = model.mesh.triangles.col(patch.triangles[e]);
      CstVector x;
      for (int k = 0; k < 3; ++k) x.segment<3>(3 * k) = kShrunk * model.X.col(corners[k]);
      const bool pushes =
          patch.state(static_cast<int>(e), x).stress.minCoeff() < -kPushes * model.membrane[t].young;
      all[t] = pushes ? Cover::Resisting : Cover::Relaxed;
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

bool is_membrane(const EnergyTerm& term) { return term.type().starts_with("cst_"); }

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
    if (term->role() != TermRole::Internal || is_membrane(*term)) continue;
    if (!add_any_lines(*term, *body) && !add_hinges(*term, *body) && !add_films(*term, *body))
      defects.push_back("solver \"xpbd\" has no constraint for term \"" + term->name() + "\" (" +
                        std::string(term->type()) + "); leave it out or take another solver");
  }
  if (!defects.empty()) throw InputError(defects);
  add_membrane(model, *body);
  body->is_exact = body->edges.empty() && body->areas.empty() && body->hinges.empty() && !body->has_contact;
  for (const TermSpec& term : terms)
    if (term.type == "contact_barrier" && term.parameters.has("exclude"))
      for (const auto& pair :
           read_facet_pairs(term.parameters.text("exclude"),
                            static_cast<int>(model.mesh.triangles.cols() + model.obstacles.cols())))
        body->excluded.push_back(pair);
  return body;
}

bool xpbd_moves_the_scene_itself(const Scene& scene) {
  const XpbdOptions options = scene.solver.xpbd ? *scene.solver.xpbd : XpbdOptions{};
  return options.stiffness == XpbdStiffness::Material && options.forces == XpbdForces::Scene &&
         options.phase == HeartPhase::Systole &&
         std::none_of(scene.terms.begin(), scene.terms.end(), [](const TermSpec& term) {
           return term.type.starts_with("cst_") || term.type.starts_with("contact_") ||
                  term.type == "bending";
         });
}

}  // namespace coapt
