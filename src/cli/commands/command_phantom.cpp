#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/length_argument.hpp"
#include "cli/progress.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "core/error.hpp"
#include "formats/durable_file.hpp"
#include "formats/json/json_text.hpp"
#include "formats/mesh_io.hpp"
#include "image/write_phantom.hpp"
#include "results/fields.hpp"
#include "run/run.hpp"
#include "scene/build/build.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace coapt::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kUnknownChordRadius = 0.4;  // of a line without a cross-section [mm]

struct PhantomArguments {
  std::string scene, closed, output = "phantom", on_wall;
  std::string voxel = "0.5mm", thickness = "1mm", wall = "6mm", margin = "6mm", probe_distance = "60mm";
  std::vector<std::string> psf = {"0.6mm", "0.9mm"}, probe;
  PhantomOptions options;
};

struct PhantomState {
  std::string name;
  PhantomValve valve;
};

void read_lengths(PhantomArguments& arguments) {
  PhantomOptions& options = arguments.options;
  options.voxel = length_argument("--voxel", arguments.voxel);
  options.axial = length_argument("--psf", arguments.psf.front());
  options.lateral = length_argument("--psf", arguments.psf.back());
  options.thickness = length_argument("--thickness", arguments.thickness);
  options.wall = length_argument("--wall", arguments.wall);
  options.margin = length_argument("--margin", arguments.margin);
  options.probe_distance = length_argument("--probe-distance", arguments.probe_distance);
  if (arguments.probe.empty()) return;
  Vec3 probe;
  for (int axis = 0; axis < 3; ++axis)
    probe[axis] = length_argument("--probe", arguments.probe[static_cast<std::size_t>(axis)]);
  options.probe = probe;
}

// The set `annulus` of the scene; else the longest rim of the mesh.
std::vector<int> annulus_loop(const Model& model, const std::string& scene) {
  if (const std::vector<int>* annulus = annulus_of(model)) return *annulus;
  std::vector<int> longest;
  double greatest = 0;
  for (const std::vector<int>& loop : boundary_loops(model.mesh.triangles)) {
    double length = 0;
    for (std::size_t k = 0; k < loop.size(); ++k)
      length += (model.X.col(loop[k]) - model.X.col(loop[(k + 1) % loop.size()])).norm();
    if (length <= greatest) continue;
    greatest = length;
    longest = loop;
  }
  if (longest.size() < 3)
    throw InputError(scene + ": its surface is closed and has no set `annulus`; a phantom needs an orifice");
  return longest;
}

std::vector<int> triangles_on_wall(const Model& model, const std::string& region) {
  if (region.empty()) return {};
  const std::vector<std::string>& names = model.mesh.region_names;
  const auto named = std::find(names.begin(), names.end(), region);
  if (named == names.end()) {
    std::string all;
    for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
    throw InputError("--on-wall: the mesh has no region `" + region + "`; it has " +
                     (all.empty() ? "none" : all));
  }
  std::vector<int> triangles;
  for (int t = 0; t < model.mesh.triangle_count(); ++t)
    if (model.mesh.regions[static_cast<std::size_t>(t)] == named - names.begin()) triangles.push_back(t);
  return triangles;
}

// x: positions of all nodes in the coordinates of the input [mm].
PhantomValve valve_at(const Points& x, const Model& model, const std::vector<int>& annulus) {
  PhantomValve valve;
  valve.surface = model.mesh;
  valve.surface.vertices = x.leftCols(model.mesh.vertex_count());
  valve.annulus = annulus;
  valve.line_ends.resize(3, 2 * static_cast<Eigen::Index>(model.lines.size()));
  for (std::size_t k = 0; k < model.lines.size(); ++k) {
    const Line& line = model.lines[k];
    valve.line_ends.col(static_cast<Eigen::Index>(2 * k)) = x.col(line.a);
    valve.line_ends.col(static_cast<Eigen::Index>(2 * k + 1)) = x.col(line.b);
    valve.line_radii.push_back(line.area > 0 ? std::sqrt(line.area / std::numbers::pi) : kUnknownChordRadius);
  }
  return valve;
}

// Of a result folder, or of the scene solved now.
Points closed_nodes(const PhantomArguments& arguments, const Scene& scene, const Model& model,
                    Session& session) {
  if (arguments.closed != "solve") {
    const fs::path file = fs::path(arguments.closed) / "closed.vtp";
    if (!fs::exists(file))
      throw InputError(file.string() +
                       ": does not exist; --closed wants the folder of a result, or the word solve");
    Points nodes = read_mesh(file).mesh.vertices;
    if (nodes.cols() != model.X.cols())
      throw InputError(file.string() + ": has " + std::to_string(nodes.cols()) + " nodes, the scene has " +
                       std::to_string(model.X.cols()) + "; it is the result of another scene");
    return nodes;
  }
  listen_for_interrupts();
  RunOptions options;
  options.writes = false;
  options.factorisations = all_factorisations();
  options.checker = intersection_checker();
  show_progress(session, options);
  const RunReport solved = run(scene, all_solvers(), options);
  end_progress();
  if (solved.report.result.status != Status::Converged) {
    std::printf("warning: the scene did not converge: %s\n", solved.report.result.message.c_str());
    session.exit_code = kNotConverged;
  }
  return solved.report.fields.x.colwise() + solved.model.origin;
}

std::vector<PhantomState> states_of(const PhantomArguments& arguments, Session& session) {
  const Scene scene = load_scene(arguments.scene);
  const Model model = build(scene);
  const std::vector<int> annulus = annulus_loop(model, arguments.scene);
  const std::vector<int> on_wall = triangles_on_wall(model, arguments.on_wall);
  std::vector<PhantomState> states;
  states.push_back({"open", valve_at(model.X.colwise() + model.origin, model, annulus)});
  states.front().valve.on_wall = on_wall;
  if (!arguments.closed.empty())
    states.push_back({"closed", valve_at(closed_nodes(arguments, scene, model, session), model, annulus)});
  const Vec3 upstream = upstream_direction(states.front().valve.surface, annulus);
  for (PhantomState& state : states) state.valve.upstream = upstream;
  return states;
}

nlohmann::ordered_json truth_json(const PhantomArguments& arguments, const std::vector<PhantomState>& states,
                                  const Volume& grid) {
  const PhantomOptions& o = arguments.options;
  const auto triple = [](const Vec3& v) { return nlohmann::ordered_json{v.x(), v.y(), v.z()}; };
  nlohmann::ordered_json json = {{"scene", arguments.scene},
                                 {"seed", o.seed},
                                 {"size", grid.size},
                                 {"voxel_mm", o.voxel},
                                 {"psf_axial_mm", o.axial},
                                 {"psf_lateral_mm", o.lateral},
                                 {"probe_mm", triple(*o.probe)},
                                 {"beam", triple(grid.direction.col(2))},
                                 {"sector_deg", o.sector},
                                 {"dynamic_range_db", o.dynamic_range},
                                 {"thickness_mm", o.thickness},
                                 {"wall_mm", o.wall},
                                 {"dropout", o.dropout},
                                 {"shadows", o.shadows},
                                 {"on_wall", arguments.on_wall},
                                 {"states", nlohmann::ordered_json::array()},
                                 {"labels",
                                  {{"outside", kLabelOutside},
                                   {"atrium", kLabelAtrium},
                                   {"ventricle", kLabelVentricle},
                                   {"leaflet", kLabelLeaflet},
                                   {"wall", kLabelWall},
                                   {"chord", kLabelChord}}}};
  for (const PhantomState& state : states) json["states"].push_back(state.name);
  return json;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string() + ": cannot be made: " + error.message());
}

void make_phantoms(PhantomArguments& arguments, Session& session) {
  read_lengths(arguments);
  const std::vector<PhantomState> states = states_of(arguments, session);
  std::vector<PhantomValve> valves;
  for (const PhantomState& state : states) valves.push_back(state.valve);
  PhantomOptions& options = arguments.options;
  const Volume grid = phantom_grid(valves, options);
  options.probe = probe_position(valves.front(), options);
  const PhantomPattern pattern = phantom_pattern(valves.front().surface, options);
  const fs::path folder = arguments.output;
  make_folder(folder);
  for (std::size_t k = 0; k < states.size(); ++k) {
    const Phantom phantom = make_phantom(states[k].valve, pattern, grid, options, static_cast<int>(k));
    make_folder(folder / states[k].name);
    write_phantom(folder / states[k].name, states[k].valve, pattern, phantom, options);
    std::printf("%s: %d x %d x %d voxels of %g mm, written to %s\n", states[k].name.c_str(), grid.size[0],
                grid.size[1], grid.size[2], options.voxel, (folder / states[k].name).c_str());
  }
  session.document = truth_json(arguments, states, grid).dump(2) + "\n";
  formats::write_durable(folder / "phantom.json", session.document);
}

void add_appearance_options(CLI::App& command, PhantomArguments& arguments) {
  command
      .add_option("--psf", arguments.psf,
                  "Standard deviation of the spread along the beam, and across it at the annulus")
      ->expected(1, 2)
      ->capture_default_str();
  command
      .add_option("--dropout", arguments.options.dropout, "Share of the leaflets that gives hardly any echo")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command.add_option("--shadows", arguments.options.shadows, "Number of shadows behind bright spots")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  command.add_option("--dynamic-range", arguments.options.dynamic_range, "From black to white [dB]")
      ->check(CLI::Range(1.0, 200.0))
      ->capture_default_str();
  command
      .add_option("--sector", arguments.options.sector, "Opening of the beams in both directions [degrees]")
      ->check(CLI::Range(1.0, 179.0))
      ->capture_default_str();
  command
      .add_option("--probe", arguments.probe,
                  "Where the beams start, in LPS: 10mm -5mm 80mm (default: above the "
                  "annulus, on its axis)")
      ->expected(3);
  command
      .add_option("--probe-distance", arguments.probe_distance,
                  "From the annulus, where --probe is not given")
      ->capture_default_str();
}

}  // namespace

void add_phantom_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<PhantomArguments>();
  CLI::App* command = app.add_subcommand(
      "phantom", "Make an ultrasound-like volume image of a scene, open and closed, with its truth");
  command->add_option("SCENE", arguments->scene, "Scene file (JSON)")->required();
  command->add_option("--closed", arguments->closed,
                      "Also the closed state: the folder of a result, or `solve` to solve the scene now");
  command->add_option("--voxel", arguments->voxel, "Edge length of the voxels")->capture_default_str();
  command->add_option("--thickness", arguments->thickness, "Of the leaflets")->capture_default_str();
  command->add_option("--wall", arguments->wall, "Thickness of the walls")->capture_default_str();
  command->add_option("--margin", arguments->margin, "Of the volume around the valve")->capture_default_str();
  command->add_option("--on-wall", arguments->on_wall, "Region of the mesh that lies on the wall when open");
  add_appearance_options(*command, *arguments);
  command->add_option("--seed", arguments->options.seed, "Of the random numbers")->capture_default_str();
  command->add_option("-o,--output", arguments->output, "Folder to write")->capture_default_str();
  command->callback([arguments, &session] { make_phantoms(*arguments, session); });
}

}  // namespace coapt::cli
