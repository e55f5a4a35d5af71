#include "core/error.hpp"
#include "formats/json/read_json.hpp"
#include "formats/json/units.hpp"
#include "scene/build/in_memory.hpp"
#include "scene/file/detail/read_parameters.hpp"
#include "scene/file/scene.hpp"
#include "scene/file/scene_text.hpp"
#include "scene/interventions/intervention.hpp"
#include "valve/other_files.hpp"
#include "xpbd/paper_numbers.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace coapt {
namespace {

// The factor of a key `unit`; `otherwise` where it is absent.
double length_scale(const Parameters& values, double otherwise, Reading& reading) {
  if (!values.has("unit")) return otherwise;
  try {
    return unit_factor(values.text("unit"), kLength);
  } catch (const InputError& error) {
    reading.defects.push_back(values.where("unit") + ": " + error.what());
    return otherwise;
  }
}

std::optional<SceneMesh> mesh_from(const Parameters& scene, Reading& reading) {
  if (!scene.has("mesh")) return std::nullopt;
  const Parameters& values = scene.object("mesh");
  SceneMesh mesh;
  if (values.has("file")) mesh.file = values.text("file");
  mesh.scale = length_scale(values, 1, reading);
  if (values.has("sets")) mesh.sets = values.text("sets");
  return mesh;
}

std::vector<SceneObstacle> obstacles_from(const Parameters& scene, double mesh_scale, Reading& reading) {
  std::vector<SceneObstacle> obstacles;
  if (!scene.has("obstacles")) return obstacles;
  std::set<std::string> names;
  for (const Parameters& values : scene.objects("obstacles")) {
    SceneObstacle obstacle;
    obstacle.where = values.where();
    if (values.has("name")) obstacle.name = values.text("name");
    if (values.has("file")) obstacle.file = values.text("file");
    obstacle.scale = length_scale(values, mesh_scale, reading);
    if (values.has("name") && !names.insert(obstacle.name).second)
      reading.defects.push_back(values.where("name") + ": \"" + obstacle.name +
                                "\" is the name of another obstacle too");
    obstacles.push_back(std::move(obstacle));
  }
  return obstacles;
}

std::vector<BoundaryEntry> boundary_from(const Parameters& scene, double mesh_scale, Reading& reading) {
  std::vector<BoundaryEntry> entries;
  if (!scene.has("boundary")) return entries;
  for (const Parameters& values : scene.objects("boundary")) {
    BoundaryEntry entry;
    entry.where = values.where();
    if (values.has("nodes")) entry.nodes = values.nodes("nodes");
    if (values.has("move_to")) entry.path = values.targets("move_to");
    entry.fix.fill(!values.has("fix"));
    if (values.has("fix"))
      for (const std::string& axis : values.texts("fix"))
        entry.fix[static_cast<size_t>(axis[0] - 'x')] = true;
    if (!entry.path.empty() && entry.fix == std::array<bool, 3>{})
      reading.defects.push_back(values.where("fix") + ": nodes that move cannot be free");
    entry.scale = length_scale(values, mesh_scale, reading);
    entries.push_back(std::move(entry));
  }
  return entries;
}

std::optional<SceneFibres> fibres_from(const Parameters& scene, bool has_mesh, Reading& reading) {
  if (!scene.has("fibres")) return std::nullopt;
  const Parameters& values = scene.object("fibres");
  SceneFibres fibres;
  fibres.where = values.where();
  if (values.has("defaults")) fibres.defaults = values.text("defaults");
  fibres.joins_regions = values.has("join_regions") && values.flag("join_regions");
  if (values.has("file")) fibres.file = values.text("file");
  if (values.has("directions"))
    for (const Parameters& entry : values.objects("directions"))
      if (entry.has("nodes") && entry.has("direction"))
        fibres.entries.push_back({entry.where(), entry.nodes("nodes"), entry.direction("direction")});
  if (fibres.file && values.has("directions"))
    reading.defects.push_back(fibres.where +
                              ": has `file` and `directions`; a file gives every triangle its "
                              "direction, keep one of them");
  if (!has_mesh) reading.defects.push_back(fibres.where + ": the scene has no mesh that fibres could lie in");
  return fibres;
}

Points points_of(const std::vector<Vec3>& list) {
  Points points(3, static_cast<Eigen::Index>(list.size()));
  for (size_t k = 0; k < list.size(); ++k) points.col(static_cast<Eigen::Index>(k)) = list[k];
  return points;
}

void read_tips(const Parameters& values, SceneChords& chords, Reading& reading) {
  std::vector<Vec3> open, closed;
  for (const Parameters& tip : values.objects("tips")) {
    if (tip.has("at")) open.push_back(tip.vector("at"));
    if (tip.has("closed_at")) closed.push_back(tip.vector("closed_at"));
  }
  if (!closed.empty() && closed.size() != open.size())
    reading.defects.push_back(values.where("tips") + ": closed_at: give it for all tips or for none");
  chords.tips = points_of(open);
  chords.tips_closed = points_of(closed);
}

// What the key `chords` says, with what is wrong in it.
std::optional<SceneChords> chords_from(const Parameters& scene, bool has_mesh, Reading& reading) {
  if (!scene.has("chords")) return std::nullopt;
  const Parameters& values = scene.object("chords");
  const size_t before = reading.defects.size();
  SceneChords chords;
  chords.where = values.where();
  if (values.has("tips")) read_tips(values, chords, reading);
  const auto keep = [&](const std::string& key, const auto& read_one) {
    if (!values.has(key)) return;
    for (const std::string& text : values.texts(key)) try {
        read_one(text);
      } catch (const InputError& error) {
        reading.defects.push_back(values.where(key) + ": " + error.what());
      }
  };
  LeafletChordOptions& options = chords.options;
  options.zones.clear();
  keep("zones", [&](const std::string& text) { options.zones.push_back(chord_zone(text)); });
  keep("level_areas",
       [&](const std::string& text) { options.level_areas.push_back(quantity_value(text, kArea)); });
  const auto integer = [&](const char* key, auto& value) {
    if (values.has(key)) value = static_cast<std::decay_t<decltype(value)>>(values.integer(key));
  };
  integer("count", options.count);
  integer("levels", options.levels);
  integer("branches", options.branches);
  integer("seed", options.seed);
  options.lengths = chord_lengths(values.has("lengths") ? values.text("lengths") : "coapted");
  options.scale = values.number_or("scale", 1);
  options.depth = values.number_or("depth", 0);
  if (reading.defects.size() == before && !options.level_areas.empty() &&
      static_cast<int>(options.level_areas.size()) != options.levels)
    reading.defects.push_back(values.where("level_areas") + ": holds " +
                              std::to_string(options.level_areas.size()) + " areas for " +
                              std::to_string(options.levels) + " levels");
  if (!has_mesh) reading.defects.push_back(chords.where + ": the scene has no mesh that chords could hold");
  return chords;
}

// The key `chords` and a term that names its network go together.
void check_generated(const Scene& scene, const std::string& file, Reading& reading) {
  bool is_named = false;
  for (const TermSpec& term : scene.terms) {
    if (!term.parameters.has("network") || term.parameters.text("network") != kGeneratedNetwork) continue;
    is_named = true;
    if (!scene.chords)
      reading.defects.push_back(term.parameters.where("network") +
                                ": \"generated\" needs the scene's key `chords`");
  }
  if (scene.chords && !is_named && reading.defects.empty())
    reading.defects.push_back(file + ": chords: no term takes them; give one \"network\": \"generated\"");
}

// Terms or interventions. Names default to the type; where several share it they are numbered from the second
// on. names: those that are taken.
template <class Spec>
std::vector<Spec> named(const Parameters& scene, const std::string& key, std::set<std::string>& names,
                        Reading& reading) {
  std::vector<Spec> specs;
  if (!scene.has(key)) return specs;
  const std::vector<Parameters>& all = scene.objects(key);
  for (const Parameters& values : all)
    if (values.has("name") && !names.insert(values.text("name")).second)
      reading.defects.push_back(values.where("name") + ": \"" + values.text("name") +
                                "\" is the name of another term or intervention too");
  std::map<std::string, int> next_of_type;  // below it all numbers are taken
  for (const Parameters& values : all) {
    Spec spec{values.text("type"), "", values};
    if (values.has("name")) {
      spec.name = values.text("name");
    } else {
      int& number = next_of_type.try_emplace(spec.type, 2).first->second;
      for (spec.name = spec.type; !names.insert(spec.name).second; ++number)
        spec.name = spec.type + "_" + std::to_string(number);
    }
    specs.push_back(std::move(spec));
  }
  return specs;
}

DynamicOptions dynamics_from(const Parameters& values) {
  DynamicOptions dynamics;
  if (values.text("integration") == "semi_implicit_euler")
    dynamics.integration = TimeIntegration::SemiImplicitEuler;
  dynamics.time_step = values.number("time_step");
  dynamics.adapts_steps = values.flag("adaptive");
  dynamics.longest_step = values.number_or("longest_step", dynamics.longest_step);
  dynamics.relaxation_time = values.number("relaxation_time");
  dynamics.has_kinetic_damping = values.flag("kinetic_damping");
  const std::string& collisions = values.text("collisions");
  if (collisions == "inelastic") dynamics.collisions = Collisions::Inelastic;
  if (collisions == "balanced") dynamics.collisions = Collisions::Balanced;
  dynamics.collision_distance = values.number_or("collision_distance", 0);
  dynamics.uses_conjugate_gradients = values.text("linear_solver") == "conjugate_gradients";
  return dynamics;
}

XpbdPaper paper_from(const Parameters& values) {
  XpbdPaper paper;
  for (const PaperNumber& number : kPaperNumbers) paper.*number.value = values.number(number.name);
  if (values.text("rest_angle") == "flat") paper.rest_angle = HingeRest::Flat;
  return paper;
}

XpbdOptions xpbd_from(const Parameters& values) {
  XpbdOptions xpbd = values.text("model") == "walczak-2019" ? walczak_2019() : XpbdOptions{};
  const auto says = [&](const char* key, const char* choice, auto& option, auto otherwise, auto meant) {
    if (values.has(key)) option = values.text(key) == choice ? meant : otherwise;
  };
  xpbd.time_step = values.number_or("time_step", 0);
  if (values.has("iterations")) xpbd.iterations = values.integer("iterations");
  if (values.has("steps")) xpbd.steps = values.integer("steps");
  xpbd.motion_time = values.number_or("motion_time", xpbd.motion_time);
  xpbd.rest_move = values.number_or("rest_move", xpbd.rest_move);
  xpbd.damping = values.number_or("damping", xpbd.damping);
  xpbd.thickness = values.number("thickness");
  says("stiffness", "paper", xpbd.stiffness, XpbdStiffness::Material, XpbdStiffness::Paper);
  says("forces", "paper", xpbd.forces, XpbdForces::Scene, XpbdForces::Paper);
  says("contact_features", "vertices", xpbd.features, XpbdContactFeatures::VerticesAndEdges,
       XpbdContactFeatures::Vertices);
  if (values.text("phase") == "diastole") xpbd.phase = HeartPhase::Diastole;
  if (values.has("paper")) xpbd.paper = paper_from(values.object("paper"));
  return xpbd;
}

SolverSpec solver_from(const Parameters& values) {
  SolverSpec solver;
  solver.type = values.text("type");
  solver.tolerance = values.number("tolerance");
  solver.max_iterations = values.integer("max_iterations");
  solver.max_seconds = values.number_or("max_seconds", kInfinity);
  solver.memory = values.integer("memory");
  solver.is_preconditioned = values.flag("preconditioned");
  solver.globalisation =
      values.text("globalisation") == "trust_region" ? Globalisation::TrustRegion : Globalisation::LineSearch;
  solver.factorisation = values.text("factorisation");
  solver.threads = values.integer("threads");
  solver.density = values.number("density");
  if (values.has("continuation")) {
    const Parameters& continuation = values.object("continuation");
    solver.continuation.load_steps = continuation.integer("load_steps");
    solver.continuation.stiffness_steps = continuation.integer("stiffness_steps");
    solver.continuation.first_stiffness = continuation.number("first_stiffness");
    solver.continuation.damped_steps = continuation.integer("damped_steps");
  }
  if (values.has("dynamics")) solver.dynamic = dynamics_from(values.object("dynamics"));
  XpbdOptions xpbd = values.has("xpbd") ? xpbd_from(values.object("xpbd")) : XpbdOptions{};
  xpbd.threads = std::max(1, solver.threads);
  solver.xpbd = std::make_shared<const XpbdOptions>(xpbd);
  solver.cascade = values.flag("cascade");
  if (values.has("certificate")) solver.modes = values.object("certificate").integer("modes");
  return solver;
}

void check_substance(const Scene& scene, const Json& json, const std::string& file, Reading& reading) {
  const bool has_terms = json.is_object() && json.contains("terms");
  if (has_terms && json["terms"].is_array() && json["terms"].empty())
    reading.defects.push_back(file + ": terms: empty; a scene needs at least one term");
  const bool has_network = std::any_of(scene.terms.begin(), scene.terms.end(),
                                       [](const TermSpec& term) { return term.parameters.has("network"); });
  if (reading.defects.empty() && !scene.mesh && !has_network)
    reading.defects.push_back(file + ": mesh: missing; a scene needs a mesh, or a term with a `network`");
}

void check_continuation(const Parameters& values, const std::string& file, Reading& reading) {
  const Parameters& solver = values.object("solver");
  if (!solver.has("continuation")) return;
  const Parameters& continuation = solver.object("continuation");
  if (continuation.integer("damped_steps") > 0 &&
      std::max(continuation.integer("load_steps"), continuation.integer("stiffness_steps")) > 1)
    reading.defects.push_back(file +
                              ": solver.continuation: damped_steps raise the loads themselves; leave out "
                              "load_steps and stiffness_steps, or damped_steps");
}

void read_reference(const Parameters& values, double mesh_scale, Scene& scene, Reading& reading) {
  if (!values.has("reference")) return;
  const Parameters& reference = values.object("reference");
  if (reference.has("closed_surface")) scene.closed_surface = reference.text("closed_surface");
  scene.closed_surface_scale = length_scale(reference, mesh_scale, reading);
  if (!reference.has("register")) return;  // it is not one of the words
  const std::optional<RegistrationMethod> method = registration_method(reference.text("register"));
  const auto has_defect_of = [&reading](const std::string& key) {  // as a file that was not found
    return std::any_of(reading.defects.begin(), reading.defects.end(),
                       [&key](const std::string& defect) { return defect.starts_with(key + ":"); });
  };
  for (const std::string key : {"trim", "scale"})
    if (reference.has(key) && !method)
      reading.defects.push_back(reference.where(key) +
                                ": only a registration uses it; say which by \"register\", or leave it out");
  const bool by_landmarks = method == RegistrationMethod::Landmarks;
  for (const std::string key : {"landmarks", "reference_landmarks"})
    if (reference.has(key) != by_landmarks && !has_defect_of(reference.where(key)))
      reading.defects.push_back(reference.where(key) + (by_landmarks
                                                            ? ": missing; \"register\": \"landmarks\" "
                                                              "needs the points of both"
                                                            : ": only \"register\": \"landmarks\" uses it"));
  if (!method || !reading.defects.empty()) return;
  RegistrationOptions options;
  options.trim = reference.number_or("trim", options.trim);
  options.with_scale = reference.has("scale") && reference.flag("scale");
  scene.registration = SceneRegistration{reference.where("register"), *method, options, {}, {}};
  if (!by_landmarks) return;
  scene.registration->landmarks = reference.text("landmarks");
  scene.registration->reference_landmarks = reference.text("reference_landmarks");
}

// The mesh is the scene's own, or the caller has it in memory.
Scene parsed(const std::string& text, const std::filesystem::path& path, bool has_mesh_in_memory) {
  const std::string file = path.string();
  const Json json = parse_json(text, file);
  refuse_other_json(json, path);
  Reading reading{path.parent_path(), {}};
  const Parameters values = read_object(json, scene_spec(), file, reading);
  Scene scene;
  scene.file = path;
  scene.name = values.has("name") ? values.text("name") : path.stem().string();
  scene.mesh = mesh_from(values, reading);
  if (has_mesh_in_memory && scene.mesh)
    reading.defects.push_back(file + ": mesh: the mesh is given in memory; leave this key out");
  if (has_mesh_in_memory) scene.mesh = SceneMesh{.file = kMeshInMemory, .sets = {}};
  const bool has_mesh = scene.mesh.has_value();
  const double mesh_scale = scene.mesh ? scene.mesh->scale : 1;
  if (values.has("sets")) scene.sets = values.selections("sets");
  scene.obstacles = obstacles_from(values, mesh_scale, reading);
  scene.boundary = boundary_from(values, mesh_scale, reading);
  if (values.has("motion") && values.object("motion").has("steps"))
    scene.motion_steps = values.object("motion").integer("steps");
  scene.fibres = fibres_from(values, has_mesh, reading);
  scene.chords = chords_from(values, has_mesh, reading);
  std::set<std::string> names;
  scene.terms = named<TermSpec>(values, "terms", names, reading);
  scene.interventions = named<InterventionSpec>(values, "interventions", names, reading);
  if (reading.defects.empty()) add_terms_of_interventions(scene, reading.defects);
  read_reference(values, mesh_scale, scene, reading);
  if (values.has("output")) {
    const Parameters& output = values.object("output");
    if (output.has("folder"))
      scene.output_folder = (path.parent_path() / output.text("folder")).lexically_normal();
    if (output.has("frames")) scene.frame_interval = output.integer("frames");
    scene.wants_first_piola = output.has("first_piola_stress") && output.flag("first_piola_stress");
    scene.writes_page = output.has("report") && output.flag("report");
  }
  check_generated(scene, file, reading);
  if (!has_mesh_in_memory) check_substance(scene, json, file, reading);
  if (reading.defects.empty()) check_continuation(values, file, reading);
  if (!reading.defects.empty()) throw InputError(reading.defects);
  scene.solver = solver_from(values.object("solver"));
  return scene;
}

}  // namespace

Scene parse_scene(const std::string& text, const std::filesystem::path& path) {
  return parsed(text, path, false);
}

Scene parse_scene_around_mesh(const std::string& text, const std::filesystem::path& path) {
  return parsed(text, path, true);
}

Scene load_scene(const std::filesystem::path& path) { return parse_scene(scene_text(path), path); }

std::string scene_title(const Scene& scene) {
  const std::string file = scene.file.filename().string();
  return scene.name == scene.file.stem().string() ? file : scene.name + " (" + file + ")";
}

}  // namespace coapt
