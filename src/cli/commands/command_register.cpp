#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/output_folder.hpp"
#include "cli/row_printer.hpp"
#include "cli/session.hpp"
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/durable_file.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/markups.hpp"
#include "formats/mesh_io.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "registration/wanted_registration.hpp"
#include "results/reference/coaptation_line.hpp"
#include "results/reference/reference_results.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace coapt::cli {
namespace {

namespace fs = std::filesystem;

struct RegisterArguments {
  std::string moving, target, output = "registered", method;
  std::vector<std::string> landmarks;
  RegistrationOptions options;
};

struct RegisteredMeshes {
  TriangleMesh moving, target;
  Registration registration;
  RegistrationDistances before, after;
  std::optional<LineDistance> lines;  // coaptation lines, after it
};

TriangleMesh mesh_of(const std::string& path) {
  MeshFile file = read_mesh(path);
  for (const std::string& warning : file.warnings) std::printf("warning: %s\n", warning.c_str());
  return std::move(file.mesh);
}

Registration registration_of(const RegisterArguments& arguments, const TriangleMesh& moving,
                             const TriangleMesh& target) {
  WantedRegistration wanted{registration_method(arguments.method).value(), arguments.options};
  const bool by_landmarks = !arguments.landmarks.empty();
  if (by_landmarks) {
    wanted.moving_landmarks = papillary_points(arguments.landmarks[0]);
    wanted.target_landmarks = papillary_points(arguments.landmarks[1]);
  }
  const std::string where =
      by_landmarks ? arguments.landmarks[0] + " and " + arguments.landmarks[1] : arguments.moving;
  try {
    check(wanted, moving);
    return register_by(wanted, moving, target);
  } catch (const InputError& error) {
    throw error.within(where);
  }
}

nlohmann::ordered_json distances_json(const RegistrationDistances& distances) {
  const auto one = [](const RegistrationDistance& d) {
    return nlohmann::ordered_json{
        {"mean_mm", d.mean}, {"p95_mm", d.p95}, {"rms_mm", d.rms}, {"max_mm", d.max}};
  };
  return {{"to_target", one(distances.to_target)}, {"from_target", one(distances.from_target)}};
}

nlohmann::ordered_json figures_json(const DistanceFigures& figures) {
  return {{"mean_mm", figures.mean}, {"p95_mm", figures.p95}, {"max_mm", figures.max}};
}

nlohmann::ordered_json document(const RegisterArguments& arguments, const RegisteredMeshes& meshes) {
  const Registration& found = meshes.registration;
  nlohmann::ordered_json json = registration_json(found, moved_by(found.motion, meshes.moving.vertices));
  json["moving"] = arguments.moving;
  json["target"] = arguments.target;
  json["distances_before"] = distances_json(meshes.before);
  json["distances_after"] = distances_json(meshes.after);
  if (meshes.lines)
    json["coaptation_line"] = {{"to_target", figures_json(meshes.lines->there)},
                               {"from_target", figures_json(meshes.lines->back)}};
  json["warnings"] = registration_doubts(found);
  return json;
}

void write_map(const fs::path& path, const TriangleMesh& mesh, const Vector& distances) {
  VtpSurface surface;
  surface.vertices = mesh.vertices;
  surface.triangles = mesh.triangles;
  surface.point_arrays.push_back({"distance", distances.transpose()});
  surface.texts.push_back({"units", {"mm"}});
  write_vtp(path, surface);
}

void write_files(const RegisterArguments& arguments, const RegisteredMeshes& meshes) {
  const fs::path folder = arguments.output;
  TriangleMesh moved = meshes.moving;
  moved.vertices = meshes.registration.motion.apply(moved.vertices);
  write_mesh(folder / "moved.obj", moved);
  write_map(folder / "moved.vtp", moved, meshes.after.moving_vertices);
  write_map(folder / "target.vtp", meshes.target, meshes.after.target_vertices);
  formats::write_durable(folder / "registration.json", document(arguments, meshes).dump(2) + "\n");
}

Table distance_table(const RegisteredMeshes& meshes) {
  Table table{.columns = {text_column("distance"), text_column("direction")}};
  for (const char* figure : {"mean", "95 %", "rms", "max"}) table.columns.push_back({figure, "", "mm"});
  const auto add = [&](const char* when, const RegistrationDistances& distances) {
    for (const auto& [direction, d] : {std::pair{"moving to target", distances.to_target},
                                       std::pair{"target to moving", distances.from_target}})
      table.rows.push_back({when, direction, d.mean, d.p95, d.rms, d.max});
  };
  add("before", meshes.before);
  add("after", meshes.after);
  if (meshes.lines)
    for (const auto& [direction, d] : {std::pair{"moving to target", meshes.lines->there},
                                       std::pair{"target to moving", meshes.lines->back}})
      table.rows.push_back({"coaptation lines", direction, d.mean, d.p95, "", d.max});
  return table;
}

void register_meshes(RegisterArguments& arguments, Session& session) {
  if (arguments.method.empty()) arguments.method = arguments.landmarks.empty() ? "surface" : "landmarks";
  if ((arguments.method == "landmarks") != !arguments.landmarks.empty())
    throw InputError("--landmarks A.mrk.json B.mrk.json and --method landmarks need each other");
  for (const std::string& path : {arguments.moving, arguments.target})
    refuse_folder_of(path, arguments.output);
  RegisteredMeshes meshes{mesh_of(arguments.moving), mesh_of(arguments.target), {}, {}, {}, {}};
  meshes.registration = registration_of(arguments, meshes.moving, meshes.target);
  const Registration& found = meshes.registration;
  TriangleMesh moved = meshes.moving;
  moved.vertices = found.motion.apply(moved.vertices);
  meshes.before = registration_distances(meshes.moving, meshes.target);
  meshes.after = registration_distances(moved, meshes.target);
  meshes.lines = distance_of_lines(moved, meshes.target);
  const OutputFolder output(arguments.output);
  write_files(arguments, meshes);
  session.document = document(arguments, meshes).dump(2) + "\n";
  std::printf("%s onto %s by %s: turned by %.4g degrees, moved by %.4g mm, scale %.6g\n",
              arguments.moving.c_str(), arguments.target.c_str(), arguments.method.c_str(),
              found.motion.angle_deg(), moved_by(found.motion, meshes.moving.vertices), found.motion.scale);
  std::printf("  overlap %.3g, %d pairs, %.3g mm rms between them, %d iterations%s\n", found.overlap,
              found.pairs, found.rms, found.iterations,
              found.standard_error
                  ? (", standard error " + number_text(*found.standard_error, 2) + " mm").c_str()
                  : "");
  print_table(distance_table(meshes));
  for (const std::string& doubt : registration_doubts(found)) std::printf("warning: %s\n", doubt.c_str());
  std::printf("written to %s (moved.obj, moved.vtp, target.vtp, registration.json)\n",
              arguments.output.c_str());
}

}  // namespace

void add_register_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<RegisterArguments>();
  CLI::App* command = app.add_subcommand(
      "register", "Move one surface onto another, as a scan: motion, overlap, distances before and after");
  command->add_option("A", arguments->moving, "Mesh that is moved [mm]")->required();
  command->add_option("B", arguments->target, "Mesh that it is moved onto [mm]")->required();
  command
      ->add_option("--method", arguments->method,
                   "annulus, landmarks or surface (default: surface, or landmarks where they are given)")
      ->check(CLI::IsMember({"annulus", "landmarks", "surface"}));
  command
      ->add_option(
          "--landmarks", arguments->landmarks,
          "Points of A and of B, two files of 3D Slicer (.mrk.json), the same points in the same order")
      ->expected(2);
  command->add_option("--trim", arguments->options.trim, "Share of the pairs that is left out, the farthest")
      ->check(CLI::Range(0.0, 0.9))
      ->capture_default_str();
  command->add_flag("--scale", arguments->options.with_scale, "Also find one scale");
  command->add_option("-o,--output", arguments->output, "Folder to write")->capture_default_str();
  command->callback([arguments, &session] { register_meshes(*arguments, session); });
}

}  // namespace coapt::cli
