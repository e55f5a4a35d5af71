#include "scene/build/scene_geometry.hpp"

#include "core/error.hpp"
#include "formats/json/markups.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/mesh_io.hpp"
#include "mesh/mesh_check.hpp"
#include "mesh/rim_order.hpp"
#include "scene/build/build_parts.hpp"
#include "scene/build/node_selection.hpp"
#include "scene/build/supports.hpp"
#include "scene/interventions/intervention.hpp"

#include <algorithm>
#include <set>

namespace coapt {
namespace {

// Everything that is gathered on the way.
struct Assembly : SceneGeometry {
  std::map<std::string, Points> points;  // named positions, in the frame of the files [mm]
  std::vector<int> held;                 // nodes prescribed unless the scene frees them

  void keep(const InputError& error) {
    defects.insert(defects.end(), error.defects().begin(), error.defects().end());
  }
  void stop_on_defects() const {
    if (!defects.empty()) throw InputError(defects);
  }
  void warn(const std::vector<std::string>& sentences) {
    model.warnings.insert(model.warnings.end(), sentences.begin(), sentences.end());
  }
};

TriangleMesh read_scaled(const std::filesystem::path& path, double scale, Assembly& assembly) {
  MeshFile file = read_mesh(path);
  file.mesh.vertices *= scale;
  assembly.warn(file.warnings);
  return std::move(file.mesh);
}

void read_surface(const Scene& scene, Assembly& assembly) {
  if (!scene.mesh) return;
  try {
    assembly.model.mesh = read_scaled(scene.mesh->file, scene.mesh->scale, assembly);
  } catch (const InputError& error) {
    assembly.keep(error);
  }
}

WantedRegistration wanted_registration(const SceneRegistration& given, const TriangleMesh& reference) {
  WantedRegistration wanted{given.method, given.options};
  try {
    if (given.method == RegistrationMethod::Landmarks) {
      wanted.moving_landmarks = papillary_points(given.reference_landmarks);
      wanted.target_landmarks = papillary_points(given.landmarks);
    }
    check(wanted, reference);
  } catch (const InputError& error) {
    throw error.within(given.where);
  }
  return wanted;
}

void read_reference(const Scene& scene, Assembly& assembly) {
  if (!scene.closed_surface) return;
  try {
    assembly.model.closed_reference =
        read_scaled(*scene.closed_surface, scene.closed_surface_scale, assembly);
    if (scene.registration)
      assembly.model.registration =
          wanted_registration(*scene.registration, *assembly.model.closed_reference);
  } catch (const InputError& error) {
    assembly.keep(error);
  }
}

// Whether the mesh can be worked on; one with errors is refused later on, with all of them named.
bool is_sound(const Assembly& assembly) {
  return assembly.defects.empty() &&
         !has_error(check_mesh(assembly.model.mesh, {.orientation_matters = false}));
}

// Paths of the networks in the order in which the terms name them, each once.
std::vector<std::string> network_paths(const Scene& scene) {
  std::vector<std::string> paths;
  for (const TermSpec& term : scene.terms) {
    if (!term.parameters.has("network")) continue;
    const std::string& path = term.parameters.text("network");
    if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
  }
  return paths;
}

// The chords of the scene's key `chords`, on the mesh as it was read.
ChordNetwork generated_chords(const Scene& scene, const Valve& sets_file, Assembly& assembly) {
  const SceneChords& chords = *scene.chords;
  Model mesh_alone;
  mesh_alone.mesh = assembly.model.mesh;
  mesh_alone.X = mesh_alone.mesh.vertices;
  mesh_alone.sets = assembly.model.sets;
  const auto set = [&](const char* name) {
    const auto own = scene.sets.find(name);
    if (own != scene.sets.end())
      return selected_nodes(own->second, mesh_alone, scene.file.string() + ": sets." + name);
    const auto found = mesh_alone.sets.find(name);
    return found == mesh_alone.sets.end() ? std::vector<int>() : found->second;
  };
  Valve valve;
  valve.leaflets = mesh_alone.mesh;
  valve.annulus = set("annulus");
  valve.free_edge = set("free_edge");
  if (valve.annulus == sets_file.annulus) valve.annulus_closed = sets_file.annulus_closed;
  valve.chords.papillary = chords.tips.cols() > 0 ? chords.tips : sets_file.chords.papillary;
  valve.chords.papillary_closed =
      chords.tips.cols() > 0 ? chords.tips_closed : sets_file.chords.papillary_closed;
  if (valve.chords.papillary.cols() == 0)
    throw InputError(chords.where + ".tips: missing, and the file of `mesh.sets` names no papillary points");
  ChordNetwork network;
  try {
    find_rims(valve);
    network = leaflet_chords(valve, chords.options);
  } catch (const InputError& error) {
    throw error.within(scene.file.string());
  }
  if (network.papillary_closed.cols() > 0)
    assembly.points.insert_or_assign("papillary_closed", network.papillary_closed);
  return network;
}

// Reads the file of sets and the networks of the terms; the chords of the key `chords` come last.
NamedNetworks read_valves(const Scene& scene, Assembly& assembly) {
  std::vector<std::string> paths = network_paths(scene);
  const size_t network_count = paths.size();
  if (scene.mesh && scene.mesh->sets) paths.push_back(scene.mesh->sets->string());
  Model& model = assembly.model;
  NamedNetworks networks;
  std::set<std::string> done;
  Valve sets_file;
  for (size_t k = 0; k < paths.size(); ++k) {
    if (paths[k] == kGeneratedNetwork || !done.insert(paths[k]).second) continue;
    try {
      ValveFile file = read_valve(paths[k], ValveMeshes::Skip);
      if (scene.mesh && assembly.defects.empty())
        for (const std::string& defect : vertex_defects(file, paths[k], model.mesh.vertex_count()))
          assembly.defects.push_back(defect);
      if (scene.mesh)
        for (const auto& [name, nodes] : file.sets)
          if (nodes.empty() || *std::max_element(nodes.begin(), nodes.end()) < model.mesh.vertex_count())
            model.sets[name] = nodes;
      for (auto& [name, positions] : file.points) assembly.points.try_emplace(name, std::move(positions));
      if (scene.mesh && scene.mesh->sets && paths[k] == scene.mesh->sets->string()) sets_file = file.valve;
      if (k < network_count) networks.emplace_back(paths[k], std::move(file.valve.chords));
    } catch (const InputError& error) {
      assembly.keep(error);
    }
  }
  if (scene.chords && is_sound(assembly)) try {
      networks.emplace_back(kGeneratedNetwork, generated_chords(scene, sets_file, assembly));
    } catch (const InputError& error) {
      assembly.keep(error);
    }
  return networks;
}

void operate(const Scene& scene, NamedNetworks& networks, Assembly& assembly) {
  if (scene.interventions.empty() || !assembly.defects.empty() || (scene.mesh && !is_sound(assembly))) return;
  Model& model = assembly.model;
  ValveEdit edit{scene, model.mesh, networks, model.sets, assembly.links, assembly.patches, model.warnings};
  edit_valve(edit, assembly.defects);
}

// Gives the points of the networks their numbers, behind the vertices of the mesh.
void place_networks(NamedNetworks&& networks, Assembly& assembly) {
  Model& model = assembly.model;
  std::vector<Points> blocks{model.mesh.vertices};
  int next = model.mesh.vertex_count();
  for (auto& [path, network] : networks) {
    const auto papillary = static_cast<int>(network.papillary.cols()),
               junctions = static_cast<int>(network.junctions.cols());
    for (int node = 0; node < papillary; ++node) model.sets["papillary"].push_back(next + node);
    for (int node = 0; node < junctions; ++node) model.sets["junctions"].push_back(next + papillary + node);
    blocks.push_back(network.papillary);
    blocks.push_back(network.junctions);
    assembly.networks[path] = {std::move(network), next, next + papillary};
    next += papillary + junctions;
  }
  model.X.resize(3, next);
  int column = 0;
  for (const Points& block : blocks) {
    model.X.middleCols(column, block.cols()) = block;
    column += static_cast<int>(block.cols());
  }
}

// The nodes of the obstacles follow all others.
void read_obstacles(const Scene& scene, Assembly& assembly) {
  Model& model = assembly.model;
  for (const SceneObstacle& obstacle : scene.obstacles) try {
      const TriangleMesh mesh = read_scaled(obstacle.file, obstacle.scale, assembly);
      const auto first = model.X.cols(), facets = model.obstacles.cols();
      model.X.conservativeResize(3, first + mesh.vertex_count());
      model.X.rightCols(mesh.vertex_count()) = mesh.vertices;
      model.obstacles.conservativeResize(3, facets + mesh.triangle_count());
      model.obstacles.rightCols(mesh.triangle_count()) = mesh.triangles.array() + static_cast<int>(first);
      std::vector<int>& nodes = model.sets[obstacle.name];
      if (!nodes.empty())
        assembly.defects.push_back(obstacle.where + ".name: \"" + obstacle.name +
                                   "\" names other nodes already");
      for (auto node = first; node < model.X.cols(); ++node) {
        nodes.push_back(static_cast<int>(node));
        assembly.held.push_back(static_cast<int>(node));
      }
    } catch (const InputError& error) {
      assembly.keep(error);
    }
}

void warn_of_idle_obstacles(const Scene& scene, Assembly& assembly) {
  if (scene.obstacles.empty() || std::any_of(scene.terms.begin(), scene.terms.end(), is_barrier)) return;
  assembly.warn({scene.file.string() +
                 ": obstacles: nothing keeps the membrane off them, as no term is a `contact_barrier`; where "
                 "it passes through them is counted in the intersections of the result."});
}

// Moves the nodes to zero where they lie so far from it that digits would be lost.
void recentre(Assembly& assembly) {
  Model& model = assembly.model;
  if (model.X.cols() == 0) return;
  const Vec3 centre = 0.5 * (model.X.rowwise().minCoeff() + model.X.rowwise().maxCoeff());
  if (centre.norm() <= bounding_box_diagonal(model.X)) return;
  model.origin = centre;
  model.X.colwise() -= centre;
  model.mesh.vertices.colwise() -= centre;
  if (model.closed_reference) model.closed_reference->vertices.colwise() -= centre;
  if (model.registration) shift(*model.registration, -centre);
}

void name_sets(const Scene& scene, Assembly& assembly) {
  Model& model = assembly.model;
  const TriangleMesh& mesh = model.mesh;
  std::vector<int>& all = model.sets["all"];
  for (int node = 0; node < model.X.cols(); ++node) all.push_back(node);
  std::vector<int> boundary;
  for (const auto& loop : boundary_loops(mesh.triangles))
    boundary.insert(boundary.end(), loop.begin(), loop.end());
  if (mesh.triangle_count() > 0) model.sets["boundary"] = boundary;
  for (size_t region = 0; region < mesh.region_names.size(); ++region) {
    std::set<int> nodes;
    for (int t = 0; t < mesh.triangle_count(); ++t)
      if (mesh.regions[static_cast<size_t>(t)] == static_cast<int>(region))
        for (int k = 0; k < 3; ++k) nodes.insert(mesh.triangles(k, t));
    model.sets.try_emplace(mesh.region_names[region], nodes.begin(), nodes.end());
  }
  std::map<std::string, std::vector<int>> named;
  for (const auto& [name, selection] : scene.sets) {
    try {
      named[name] = selected_nodes(selection, model, scene.file.string() + ": sets." + name);
    } catch (const InputError& error) {
      assembly.keep(error);
    }
  }
  for (auto& [name, nodes] : named) model.sets[name] = std::move(nodes);
}

// The annulus as a closed loop, whatever order it was named in: its area and what it encloses depend on it.
// Motion is told by then, and knows each node.
void order_annulus(const Scene& scene, Assembly& assembly) {
  const auto annulus = assembly.model.sets.find("annulus");
  if (annulus == assembly.model.sets.end()) return;
  RimLoop loop = rim_loop(annulus->second, assembly.model.mesh.triangles);
  const std::string where = scene.file.string() + ": annulus: ";
  if (loop.spans_rims()) assembly.defects.push_back(where + spans_rims_text(loop.rims));
  if (!loop.is_reordered) return;
  annulus->second = std::move(loop.vertices);
  assembly.warn({where + reordered_text()});
}

}  // namespace

namespace {

// The surface is there.
SceneGeometry assembled(const Scene& scene, Assembly assembly) {
  Model& model = assembly.model;
  read_reference(scene, assembly);
  NamedNetworks networks = read_valves(scene, assembly);
  operate(scene, networks, assembly);
  place_networks(std::move(networks), assembly);
  read_obstacles(scene, assembly);
  warn_of_idle_obstacles(scene, assembly);
  assembly.stop_on_defects();
  check_surface(scene, model, assembly.defects);
  assembly.stop_on_defects();
  recentre(assembly);
  name_sets(scene, assembly);

  const auto papillary = model.sets.find("papillary");
  if (papillary != model.sets.end() && !assembly.networks.empty())
    assembly.held.insert(assembly.held.end(), papillary->second.begin(), papillary->second.end());
  assembly.prescribed = prescribe(scene.boundary, assembly.held, model, assembly.points, assembly.defects);
  if (!assembly.prescribed.fixed(Eigen::all, model.obstacles.reshaped()).all())
    assembly.defects.push_back(
        scene.file.string() +
        ": boundary: sets nodes of an obstacle free; they have no stiffness of their own");
  order_annulus(scene, assembly);
  SupportEdit supports{scene, model, assembly.prescribed, model.warnings};
  if (assembly.defects.empty()) edit_supports(supports, assembly.defects);
  hold_isolated_nodes(model, assembly.networks, assembly.prescribed.fixed);
  return std::move(static_cast<SceneGeometry&>(assembly));
}

}  // namespace

SceneGeometry scene_geometry(const Scene& scene) {
  Assembly assembly;
  read_surface(scene, assembly);
  return assembled(scene, std::move(assembly));
}

SceneGeometry scene_geometry(const Scene& scene, TriangleMesh mesh) {
  Assembly assembly;
  assembly.model.mesh = std::move(mesh);
  return assembled(scene, std::move(assembly));
}

const SceneGeometry& finest_geometry(const SceneGeometry& geometry) {
  return geometry.finest == nullptr ? geometry : finest_geometry(*geometry.finest);
}

std::vector<int> selected_nodes(const NodeSelection& selection, const SceneGeometry& geometry,
                                const std::string& where) {
  const bool is_listed = selection.kind == NodeSelection::Kind::Indices;
  if (geometry.finest == nullptr || (geometry.is_refined && !is_listed))
    return selected_nodes(selection, geometry.model, where);
  std::vector<int> nodes;
  for (const int node : selected_nodes(selection, *geometry.finest, where))
    if (const int here = geometry.number[static_cast<size_t>(node)]; here >= 0) nodes.push_back(here);
  return nodes;
}

std::vector<int> kept_vertices(const SceneGeometry& geometry) {
  std::vector<int> kept(static_cast<size_t>(geometry.model.mesh.vertex_count()));
  for (int v = 0; v < geometry.finest->model.mesh.vertex_count(); ++v)
    if (const int k = geometry.number[static_cast<size_t>(v)]; k >= 0) kept[static_cast<size_t>(k)] = v;
  return kept;
}

double multiplicity(const NodeSelection* selection, const SceneGeometry& geometry, const std::string& where) {
  if (geometry.finest == nullptr) return 1;
  const Model& own = finest_geometry(geometry).model;
  if (selection == nullptr)
    return static_cast<double>(own.mesh.vertex_count()) / geometry.model.mesh.vertex_count();
  const size_t left = selected_nodes(*selection, geometry, where).size();
  const size_t all = selected_nodes(*selection, own, where).size();
  return left > 0 ? static_cast<double>(all) / static_cast<double>(left) : 1;
}

const TriangleMesh& scene_mesh(const SceneGeometry& geometry) { return finest_geometry(geometry).model.mesh; }

Vector at_vertices(const Vector& values, const SceneGeometry& geometry) {
  if (geometry.finest == nullptr) return values;
  Vector here(geometry.model.mesh.vertex_count());
  if (geometry.is_refined) {
    const Vector coarse = at_vertices(values, *geometry.coarser);
    here.head(coarse.size()) = coarse;
    for (size_t k = 0; k < geometry.parents.size(); ++k)
      here[coarse.size() + static_cast<Eigen::Index>(k)] =
          0.5 * (coarse[geometry.parents[k][0]] + coarse[geometry.parents[k][1]]);
    return here;
  }
  const Vector fine = at_vertices(values, *geometry.finest);
  for (Eigen::Index v = 0; v < fine.size(); ++v)
    if (const int kept = geometry.number[static_cast<size_t>(v)]; kept >= 0) here[kept] = fine[v];
  return here;
}

Vector on_triangles(const Vector& values, const SceneGeometry& geometry) {
  if (geometry.finest == nullptr) return values;
  if (geometry.is_refined)
    return on_triangles(values, *geometry.coarser).transpose().replicate(4, 1).reshaped();
  const TriangleMesh& fine = geometry.finest->model.mesh;
  const Vector there = on_triangles(values, *geometry.finest);
  Vector sum = Vector::Zero(fine.vertex_count()), count = sum;
  for (int t = 0; t < fine.triangle_count(); ++t)
    for (const int v : fine.triangles.col(t)) {
      sum[v] += there[t];
      ++count[v];
    }
  const Vector mean = sum.cwiseQuotient(count.cwiseMax(1));
  Vector here = Vector::Zero(geometry.model.mesh.triangle_count());
  const std::vector<int> kept = kept_vertices(geometry);
  for (int t = 0; t < here.size(); ++t)
    for (const int v : geometry.model.mesh.triangles.col(t))
      here[t] += mean[kept[static_cast<size_t>(v)]] / 3;
  return here;
}

}  // namespace coapt
