#include "scene/file/solver_keys.hpp"

#include "core/number_text.hpp"
#include "xpbd/paper_numbers.hpp"

namespace coapt {
namespace {

KeySpec dynamics_key() {
  return {
      .name = "dynamics",
      .kind = KeyKind::Object,
      .object =
          {.keys = {{.name = "integration",
                     .kind = KeyKind::Choice,
                     .fallback = "\"backward_differences\"",
                     .choices = {"backward_differences", "semi_implicit_euler"},
                     .doc = "Of dynamic: backward differences of second order, implicit, or semi-implicit "
                            "Euler, which dynamic-explicit and mass-spring always take."},
                    {.name = "time_step",
                     .dimension = kTime,
                     .fallback = "\"0.1 ms\"",
                     .min = 0,
                     .excludes_min = true,
                     .doc = "The first time step."},
                    {.name = "adaptive",
                     .kind = KeyKind::Flag,
                     .fallback = "true",
                     .doc = "Whether time steps adapt; otherwise all are the first."},
                    {.name = "longest_step",
                     .dimension = kTime,
                     .fallback = "\"1 s\"",
                     .min = 0,
                     .excludes_min = true,
                     .doc = "Greatest time step."},
                    {.name = "relaxation_time",
                     .dimension = kTime,
                     .fallback = "\"1 ms\"",
                     .min = 0,
                     .doc = "In which viscous drag alone slows every mass down by a factor e, with "
                            "mass-spring the mean mass; 0: no drag."},
                    {.name = "kinetic_damping",
                     .kind = KeyKind::Flag,
                     .fallback = "false",
                     .doc = "Whether all masses are stopped whenever the kinetic energy has begun to fall."},
                    {.name = "collisions",
                     .kind = KeyKind::Choice,
                     .fallback = "\"none\"",
                     .choices = {"none", "inelastic", "balanced"},
                     .doc = "What keeps leaflets apart besides contact terms: inelastic stops vertices that "
                            "approach a near facet (Hammer et al. 2008); balanced also takes the forces "
                            "that press them towards it (Hammer et al. 2011). What passes through all the "
                            "same is counted in the result, and a run that comes to rest on collisions "
                            "ends as stalled, as they are no part of the energy."},
                    {.name = "collision_distance",
                     .dimension = kLength,
                     .min = 0,
                     .excludes_min = true,
                     .doc = "Below which a facet is near; default: 0.3 mean edge lengths."},
                    {.name = "linear_solver",
                     .kind = KeyKind::Choice,
                     .fallback = "\"cholesky\"",
                     .choices = {"cholesky", "conjugate_gradients"},
                     .doc = "How backward differences solve for a step."}}},
      .doc =
          "How dynamic, dynamic-explicit and mass-spring follow the motion of masses until it comes to "
          "rest."};
}

KeySpec paper_key() {
  std::vector<KeySpec> keys;
  for (const PaperNumber& number : kPaperNumbers)
    keys.push_back({.name = number.name,
                    .fallback = exact_text(XpbdPaper{}.*number.value),
                    .min = 0,
                    .max = number.is_share ? 1 : kInfinity,
                    .doc = number.doc});
  keys.push_back({.name = "rest_angle",
                  .kind = KeyKind::Choice,
                  .fallback = "\"initial\"",
                  .choices = {"initial", "flat"},
                  .doc = "To what angle hinges want to fold; the paper allows both."});
  return {.name = "paper",
          .kind = KeyKind::Object,
          .object = {.keys = std::move(keys)},
          .doc =
              "Numbers for stiffness \"paper\" and forces \"paper\"; the defaults are those of Walczak et "
              "al. 2019 (table 1, eq. 15, section 3.3)."};
}

KeySpec choice_key(const char* name, const char* fallback, std::vector<std::string> choices,
                   const char* doc) {
  return {
      .name = name, .kind = KeyKind::Choice, .fallback = fallback, .choices = std::move(choices), .doc = doc};
}

// What model, and what it decides where these are not given.
std::vector<KeySpec> model_keys() {
  return {
      choice_key(
          "model", "\"coapt\"", {"coapt", "walczak-2019"},
          "What keys mean that are not given. coapt: the scene's own material and loads, 5 % damping and "
          "20 sweeps, none of it the paper's; walczak-2019: the paper by its table 1 and equations: "
          "stiffness and forces \"paper\", no damping, contact of vertices, 3 sweeps; ours are when it "
          "rests and how long the annulus moves."),
      choice_key("stiffness", "", {"material", "paper"},
                 "material (default without a model): compliances and masses from the moduli, sections and "
                 "density of the scene, so that the result can be compared; paper: the mass 1, the numbers "
                 "of the paper for all, and areas and angles as in its eq. 13 and 14."),
      choice_key("forces", "", {"scene", "paper"},
                 "scene (default without a model): the loads of the scene; paper: flow field and pressure "
                 "of the paper (eq. 16-19), by the set \"annulus\"."),
      choice_key("contact_features", "", {"vertices_and_edges", "vertices"},
                 "What contact keeps apart: vertices from triangles and edges from edges (default without "
                 "a model), or vertices alone, as in the paper, which lets edges cross."),
      choice_key("phase", "\"systole\"", {"systole", "diastole"},
                 "systole: the forces as they are, they close a valve; diastole: turned round, they open "
                 "it while the prescribed nodes go back. A start in the shape at rest is closed first."),
      paper_key()};
}

KeySpec xpbd_key() {
  std::vector<KeySpec> keys = model_keys();
  keys.insert(
      keys.end(),
      {{.name = "time_step",
        .dimension = kTime,
        .min = 0,
        .excludes_min = true,
        .doc = "Time step; default: 0.1 ms with stiffness \"material\", 5 ms with \"paper\"."},
       {.name = "iterations",
        .kind = KeyKind::Integer,
        .min = 1,
        .max = 100000,
        .doc = "Sweeps over all constraints in a step; default: 20, with model \"walczak-2019\" 3; "
               "the paper has both."},
       {.name = "steps",
        .kind = KeyKind::Integer,
        .min = 1,
        .doc = "Greatest number of time steps in a phase; it ends before where nothing moves any "
               "more. Default: 2000, with model \"walczak-2019\" 5000."},
       {.name = "rest_move",
        .dimension = kLength,
        .min = 0,
        .excludes_min = true,
        .doc = "A phase ends where the moves of all nodes in a step, root mean square, have been less "
               "than this for 50 steps. Default: where no node has moved by more than 1e-7 of the "
               "extent, with model \"walczak-2019\" 0.01 mm, which is ours."},
       {.name = "motion_time",
        .dimension = kTime,
        .min = 0,
        .excludes_min = true,
        .doc =
            "Time in which the prescribed nodes move along their path, a piece in every step; default: half "
            "the time of all steps, with model \"walczak-2019\" 2 s, which is ours."},
       {.name = "damping",
        .min = 0,
        .max = 1,
        .doc = "Share of its velocity that a node loses in a step; default: 0.05, which is ours, "
               "and 0 with model \"walczak-2019\"."},
       {.name = "thickness",
        .dimension = kLength,
        .fallback = "\"0.5 mm\"",
        .min = 0,
        .excludes_min = true,
        .doc = "Distance that contact keeps between facets, in place of that of the contact term."}});
  return {.name = "xpbd",
          .kind = KeyKind::Object,
          .object = {.keys = std::move(keys)},
          .doc =
              "How xpbd moves the scene (Macklin et al. 2016, Walczak et al. 2019); threads are those of "
              "the solver."};
}

KeySpec continuation_key() {
  return {.name = "continuation",
          .kind = KeyKind::Object,
          .object = {.keys = {{.name = "load_steps",
                               .kind = KeyKind::Integer,
                               .fallback = "1",
                               .min = 1,
                               .max = 100000,
                               .doc = "Equal steps of all loads."},
                              {.name = "stiffness_steps",
                               .kind = KeyKind::Integer,
                               .fallback = "1",
                               .min = 1,
                               .max = 100000,
                               .doc = "Steps of the stiffness, each by the same factor."},
                              {.name = "first_stiffness",
                               .fallback = "0.01",
                               .min = 0,
                               .excludes_min = true,
                               .doc = "Factor on the stiffness before the first step."},
                              {.name = "damped_steps",
                               .kind = KeyKind::Integer,
                               .fallback = "0",
                               .min = 0,
                               .max = 100000,
                               .doc = "Steps of all loads and of the prescribed motion along a damped path, "
                                      "fewer where the shape all but follows them, which the order of the "
                                      "nodes and the method hardly ever divert "
                                      "to another shape, at up to three times the time; 0: none. It takes "
                                      "neither load_steps nor stiffness_steps."}}},
          .doc =
              "Way to the full problem by easier ones, together with the prescribed "
              "motion; default: the full problem at once."};
}

KeySpec certificate_key() {
  return {.name = "certificate",
          .kind = KeyKind::Object,
          .object = {.keys = {{.name = "modes",
                               .kind = KeyKind::Integer,
                               .fallback = "0",
                               .min = 0,
                               .max = 1000,
                               .doc = "Smallest eigenvalues of the Hessian to compute, which "
                                      "needs a build with Spectra. More than none also counts "
                                      "zero and negative modes whatever the size."}}},
          .doc = "What the certificate of the result holds beyond the usual."};
}

// Which method, and when it ends.
std::vector<KeySpec> method_keys() {
  return {{.name = "type",
           .kind = KeyKind::Choice,
           .fallback = "\"newton\"",
           .choices = {"newton", "lbfgs", "bfgs", "dynamic", "dynamic-explicit", "mass-spring", "xpbd",
                       "ceres", "nlopt"},
           .doc = "The method; ceres and nlopt need a build that has them, mass-spring a scene whose "
                  "membranes are springs."},
          {.name = "tolerance",
           .fallback = "1e-6",
           .min = 0,
           .max = 1,
           .excludes_min = true,
           .doc = "Greatest out-of-balance nodal force, relative to the greatest load or "
                  "reaction, at which the result counts as converged."},
          {.name = "max_iterations",
           .kind = KeyKind::Integer,
           .fallback = "100000",
           .min = 0,
           .doc = "Greatest number of iterations over all steps."},
          {.name = "max_seconds",
           .kind = KeyKind::Quantity,
           .dimension = kTime,
           .min = 0,
           .excludes_min = true,
           .doc = "Greatest wall time; default: no limit."}};
}

// What methods may be told.
std::vector<KeySpec> option_keys() {
  return {
      {.name = "memory",
       .kind = KeyKind::Integer,
       .fallback = "12",
       .min = 1,
       .max = 1000,
       .doc = "Pairs of steps and gradient changes that lbfgs keeps."},
      {.name = "cascade",
       .kind = KeyKind::Flag,
       .fallback = "false",
       .doc = "Whether coarser meshes are made and solved first, each giving the next "
              "its start; the result is that of the scene's own mesh."},
      continuation_key(),
      {.name = "threads",
       .kind = KeyKind::Integer,
       .fallback = "0",
       .min = 0,
       .max = 256,
       .doc = "Threads that share assembly, contact search and factorisation, or the constraints of xpbd, "
              "wherever there is enough to share; the result does not depend on them. 0: one for each "
              "processor that the process may use (xpbd: one thread)."},
      {.name = "density",
       .dimension = kDensity,
       .fallback = "\"1060 kg/m^3\"",
       .min = 0,
       .excludes_min = true,
       .doc = "Mass density of membrane, chords and cables, for methods that move masses."},
      dynamics_key(),
      xpbd_key(),
      {.name = "globalisation",
       .kind = KeyKind::Choice,
       .fallback = "\"line_search\"",
       .choices = {"line_search", "trust_region"},
       .doc = "How newton keeps a step from going too far."},
      {.name = "preconditioned",
       .kind = KeyKind::Flag,
       .fallback = "false",
       .doc = "Whether lbfgs starts its recursion from a factorised Hessian."},
      {.name = "factorisation",
       .kind = KeyKind::Choice,
       .fallback = "\"auto\"",
       .choices = {"auto", "multifrontal", "cholmod", "eigen"},
       .doc = "Sparse Cholesky method of newton, preconditioned lbfgs and the certificate; "
              "auto takes multifrontal."},
      certificate_key()};
}

}  // namespace

KeySpec solver_key() {
  std::vector<KeySpec> keys = method_keys();
  for (KeySpec& key : option_keys()) keys.push_back(std::move(key));
  return {.name = "solver",
          .kind = KeyKind::Object,
          .fallback = "{}",
          .object = {.keys = std::move(keys)},
          .doc = "How the equilibrium is found."};
}

}  // namespace coapt
