#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/segment_arguments.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "core/error.hpp"
#include "exchange/import.hpp"
#include "formats/durable_file.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/markups.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/utf8.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "image/segment/ridge_points.hpp"
#include "image/segment/write_segmentation.hpp"
#include "mesh/curve_match.hpp"
#include "mesh/distance/surface_distance.hpp"
#include "registration/register_points.hpp"
#include "results/reference/reference_distance.hpp"
#include "results/result_warnings.hpp"
#include "results/results.hpp"
#include "run/run.hpp"
#include "valve/generators/leaflet_chords.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace coapt::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kCurvePoints = 8;   // of a smooth annulus between two that were given
constexpr double kSameSheet = 5;  // a ridge farther from the closed leaflets is another structure [mm]
constexpr double kSharePercentile = 0.95;

struct CloseArguments {
  SegmentArguments segment;
  std::string closed, annulus_closed;
  bool registers = false;
  LeafletChordOptions chords = {.zones = {chord_zone("free_edge"), chord_zone("rough")}};
};

// How far the solved leaflets lie from the middles of the sheets that the closed volume shows, and back.
struct ImageDistance {
  DistanceFigures to_image, from_image;  // [mm]
  Vector vertices;                       // of each vertex from the nearest ridge point [mm]
  Eigen::Index ridge_points = 0;         // that are counted
};

DistanceFigures figures_of(std::vector<double> values) {
  if (values.empty()) return {kNaN, kNaN, kNaN};
  std::sort(values.begin(), values.end());
  DistanceFigures figures;
  for (const double value : values) figures.mean += value / static_cast<double>(values.size());
  figures.p95 = values[static_cast<size_t>(kSharePercentile * static_cast<double>(values.size() - 1))];
  figures.max = values.back();
  return figures;
}

ImageDistance distance_from_image(const TriangleMesh& closed, const Points& ridges) {
  if (ridges.cols() == 0) throw InputError("the closed volume shows no sheets around the annulus");
  ImageDistance distance;
  const Vector from_ridges = surface_distance(ridges, closed).vertex_distances;
  std::vector<double> near;
  std::vector<Eigen::Index> counted;
  for (Eigen::Index k = 0; k < ridges.cols(); ++k)
    if (from_ridges[k] < kSameSheet) {
      near.push_back(from_ridges[k]);
      counted.push_back(k);
    }
  distance.ridge_points = static_cast<Eigen::Index>(counted.size());
  distance.from_image = figures_of(near);
  distance.vertices.resize(closed.vertex_count());
  for (int v = 0; v < closed.vertex_count(); ++v)
    distance.vertices[v] = (ridges.colwise() - closed.vertices.col(v)).colwise().norm().minCoeff();
  distance.to_image = figures_of({distance.vertices.begin(), distance.vertices.end()});
  return distance;
}

// From the frame of the closed volume to that of the open one: its annulus onto the open one.
RigidMotion motion_to_open(const CloseArguments& arguments, const Points& annulus) {
  if (!arguments.registers) return {};
  const Registration found = register_curves(annulus_curve(arguments.annulus_closed), annulus);
  std::printf(
      "registered: closed annulus onto the open one, turned by %.4g degrees, %.3g mm rms between them\n",
      found.motion.angle_deg(), found.rms);
  return found.motion;
}

// The valve with chords and, where its closed annulus is known, the way that the annulus goes.
Valve chorded(const CloseArguments& arguments, Valve valve, const RigidMotion& motion) {
  if (!arguments.segment.papillary.empty())
    valve.chords.papillary = papillary_points(arguments.segment.papillary);
  if (!arguments.annulus_closed.empty()) {
    const Points curve =
        smooth_closed_curve(motion.apply(annulus_curve(arguments.annulus_closed)), kCurvePoints);
    valve.annulus_closed = matched_by_length(valve.leaflets.vertices(Eigen::all, valve.annulus), curve);
  }
  LeafletChordOptions options = arguments.chords;
  if (valve.chords.papillary.cols() == 0) options.lengths = ChordLengths::Sum;
  valve.chords = leaflet_chords(valve, options);
  return valve;
}

void write_error_map(const fs::path& folder, const TriangleMesh& closed, const ImageDistance& distance,
                     const CloseArguments& arguments) {
  VtpSurface surface;
  surface.vertices = closed.vertices;
  surface.triangles = closed.triangles;
  surface.point_arrays.push_back({"distance_to_image_mm", distance.vertices.transpose()});
  surface.texts.push_back({"units", {"mm"}});
  write_vtp(folder / "image_distance.vtp", surface);
  const auto json = [](const DistanceFigures& d) {
    return OrderedJson{{"mean_mm", d.mean}, {"p95_mm", d.p95}, {"max_mm", d.max}};
  };
  const OrderedJson document = {{"closed_volume", arguments.closed},
                                {"to_image", json(distance.to_image)},
                                {"from_image", json(distance.from_image)},
                                {"ridge_points", distance.ridge_points},
                                {"farthest_counted_mm", kSameSheet}};
  formats::write_durable(folder / "image_distance.json", json_text(document, 2) + "\n");
}

void compare_with_closed(const CloseArguments& arguments, const RunReport& solved, const Points& annulus,
                         const RigidMotion& motion) {
  const Volume volume = printed_volume(arguments.closed, std::nullopt);
  const Points there = motion.inverse().apply(annulus);  // in the frame of the closed volume
  TriangleMesh closed = surface_at(solved.model, solved.report.fields.x);
  closed.vertices.colwise() += solved.model.origin;
  const ImageDistance distance =
      distance_from_image(closed, motion.apply(ridge_points_around(volume, there)));
  write_error_map(arguments.segment.output, closed, distance, arguments);
  std::printf(
      "distance to the closed image: mean %.2f, 95 %% %.2f mm; back: mean %.2f, 95 %% %.2f mm (%ld points)\n",
      distance.to_image.mean, distance.to_image.p95, distance.from_image.mean, distance.from_image.p95,
      static_cast<long>(distance.ridge_points));
}

RunReport solve_valve(const fs::path& folder, const Session& session) {
  const Scene scene = load_scene((folder / "scene" / "scene.json").string());
  RunOptions options;
  options.folder = folder / "result";
  options.factorisations = all_factorisations();
  options.checker = intersection_checker();
  options.observer = make_observer(session);
  RunReport solved = run(scene, all_solvers(), options);
  end_progress();
  const Metrics& metrics = solved.report.metrics;
  std::printf("%s\n", headline(solved.report).text.c_str());
  if (metrics.orifice_area_mm2 && metrics.annulus_area_mm2)
    std::printf("  %-12s %.2f of %.1f mm2\n", "orifice", *metrics.orifice_area_mm2,
                *metrics.annulus_area_mm2);
  std::printf("  %-12s %ld\n", "intersections", metrics.intersections);
  return solved;
}

int close_image(const CloseArguments& arguments, Session& session) {
  if (arguments.registers && arguments.annulus_closed.empty())
    throw InputError("--register: needs --annulus-closed, the annulus in the frame of the closed volume");
  const fs::path folder = arguments.segment.output;
  refuse_folder_of(arguments.segment.volume, folder);
  const OutputFolder output(folder);
  const Points annulus = annulus_curve(arguments.segment.annulus);
  const RigidMotion motion = motion_to_open(arguments, annulus);
  listen_for_interrupts();
  Segmentation found = find_leaflets(arguments.segment);
  found.valve.name = formats::as_utf8(fs::path(arguments.segment.volume).stem().string());
  found.valve = chorded(arguments, std::move(found.valve), motion);
  std::printf("chords:   %zu from %ld papillary tips%s\n", found.valve.chords.chords.size(),
              static_cast<long>(found.valve.chords.papillary.cols()),
              arguments.segment.papillary.empty() ? ", which no file gave" : "");
  fs::create_directories(folder / "leaflets");
  write_segmentation(folder / "leaflets", found, arguments.segment.volume, arguments.segment.annulus);
  for (const std::string& warning : import_valve(folder / "leaflets" / "valve.json", folder / "scene"))
    std::printf("warning: %s\n", warning.c_str());
  const RunReport solved = solve_valve(folder, session);
  session.document = result_json(solved.model, solved.report);
  if (!arguments.closed.empty()) compare_with_closed(arguments, solved, annulus, motion);
  std::printf("written to %s (leaflets/, scene/, result/report.html%s)\n", folder.string().c_str(),
              arguments.closed.empty() ? "" : ", image_distance.vtp, image_distance.json");
  if (solved.report.result.status != Status::Converged) return kNotConverged;
  return is_in_doubt(solved.report) ? kInDoubt : kConverged;
}

}  // namespace

void add_close_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<CloseArguments>();
  CLI::App* command = app.add_subcommand(
      "close", "From a volume image to a closed valve: segment, chords, import and solve in one go");
  add_segment_options(*command, arguments->segment);
  auto* closed = command->add_option("--closed", arguments->closed,
                                     "Volume with the closed valve: how far the solved leaflets lie from it");
  command->add_option("--annulus-closed", arguments->annulus_closed,
                      "Annulus of the closed valve (.mrk.json): the annulus moves there");
  command
      ->add_flag("--register", arguments->registers,
                 "The closed volume lies elsewhere: its annulus is laid onto that of the open one")
      ->needs(closed);
  command->add_option("--chords", arguments->chords.count, "Chords of each zone that leave the tips")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->segment.output, "Folder to write")->required();
  command->callback([arguments, &session] { session.exit_code = close_image(*arguments, session); });
}

}  // namespace coapt::cli
