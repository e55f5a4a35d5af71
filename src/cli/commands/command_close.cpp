#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/images/close_pictures.hpp"
#include "cli/images/image_distance.hpp"
#include "cli/images/image_line.hpp"
#include "cli/images/segment_arguments.hpp"
#include "cli/output_folder.hpp"
#include "cli/progress.hpp"
#include "cli/session.hpp"
#include "cli/solvers.hpp"
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "exchange/import.hpp"
#include "formats/json/markups.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/utf8.hpp"
#include "image/segment/annulus_region.hpp"
#include "image/segment/ridge_points.hpp"
#include "image/segment/write_segmentation.hpp"
#include "mesh/curve_match.hpp"
#include "registration/register_points.hpp"
#include "results/reference/reference_distance.hpp"
#include "results/result_warnings.hpp"
#include "results/results.hpp"
#include "run/run.hpp"
#include "tuning/first_order.hpp"
#include "valve/generators/leaflet_chords.hpp"
#include "valve/separate_leaflets.hpp"

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace coapt::cli {
namespace {

namespace fs = std::filesystem;

constexpr int kCurvePoints = 8;  // of a smooth annulus between two that were given

struct CloseArguments {
  SegmentArguments segment;
  std::string closed, annulus_closed, papillary_closed;
  std::optional<int> closed_frame;
  bool registers = false;
  LeafletChordOptions chords = {.zones = {chord_zone("free_edge"), chord_zone("rough")},
                                .lengths = ChordLengths::ToCoapted};
};

// What the files besides the open volume hold, all in its frame but for the closed volume.
struct CloseInput {
  Volume open;
  Points annulus;                        // [mm]
  std::optional<Points> annulus_closed;  // smooth [mm]
  Points papillary = Points(3, 0), papillary_closed = Points(3, 0);
  std::optional<Volume> closed;
  RigidMotion to_open;  // from the frame of the closed volume
};

// From the frame of the closed volume to that of the open one: its annulus onto the open one.
RigidMotion motion_to_open(const CloseArguments& arguments, const Points& annulus) {
  if (!arguments.registers) return {};
  const Registration found = register_curves(annulus_curve(arguments.annulus_closed), annulus);
  std::printf(
      "registered: closed annulus onto the open one, turned by %.4g degrees, %.3g mm rms between them\n",
      found.motion.angle_deg(), found.rms);
  return found.motion;
}

// An annulus that goes farther than it is wide was drawn in another frame.
void check_place(const CloseArguments& arguments, const Points& annulus, const Points& closed) {
  const Vec3 middle = annulus.rowwise().mean();
  const double moved = (closed.rowwise().mean() - middle).norm();
  const double width = 2 * (annulus.colwise() - middle).colwise().norm().maxCoeff();
  if (moved > width)
    throw InputError(arguments.annulus_closed + ": the closed annulus lies " + number_text(moved, 3) +
                     " mm from the open one, which is " + number_text(width, 3) +
                     " mm wide; is it in the frame of another volume? --register lays it onto the open one");
}

CloseInput read_input(const CloseArguments& arguments) {
  if (arguments.registers && arguments.annulus_closed.empty())
    throw InputError("--register: needs --annulus-closed, the annulus in the frame of the closed volume");
  if (arguments.closed_frame && arguments.closed.empty())
    throw InputError("--closed-frame: needs --closed, the volume that it is a frame of");
  if (!arguments.papillary_closed.empty() && arguments.segment.papillary.empty())
    throw InputError("--papillary-closed: needs --papillary, the same tips in the open valve");
  CloseInput input;
  input.annulus = annulus_curve(arguments.segment.annulus);
  input.to_open = motion_to_open(arguments, input.annulus);
  if (!arguments.annulus_closed.empty()) {
    const Points curve = input.to_open.apply(annulus_curve(arguments.annulus_closed));
    check_place(arguments, input.annulus, curve);
    input.annulus_closed = smooth_closed_curve(curve, kCurvePoints);
  }
  if (!arguments.segment.papillary.empty()) input.papillary = papillary_points(arguments.segment.papillary);
  if (!arguments.papillary_closed.empty()) {
    input.papillary_closed = input.to_open.apply(papillary_points(arguments.papillary_closed));
    if (input.papillary_closed.cols() != input.papillary.cols())
      throw InputError(arguments.papillary_closed + ": has " + std::to_string(input.papillary_closed.cols()) +
                       " tips, " + arguments.segment.papillary + " has " +
                       std::to_string(input.papillary.cols()) + "; give the same tips in the same order");
  }
  input.open = printed_volume(arguments.segment.volume, arguments.segment.frame);
  if (!arguments.closed.empty())
    input.closed = printed_volume(arguments.closed, arguments.closed_frame, "--closed-frame");
  return input;
}

// The valve with chords and, where its closed annulus is known, the way that the annulus goes.
Valve chorded(const CloseArguments& arguments, const CloseInput& input, Valve valve) {
  valve.chords.papillary = input.papillary;
  valve.chords.papillary_closed = input.papillary_closed;
  if (input.annulus_closed)
    valve.annulus_closed =
        matched_by_length(valve.leaflets.vertices(Eigen::all, valve.annulus), *input.annulus_closed);
  LeafletChordOptions options = arguments.chords;
  if (valve.chords.papillary.cols() == 0) options.lengths = ChordLengths::Sum;
  valve.chords = leaflet_chords(valve, options);
  return valve;
}

// The valve that is to be closed: without folds that pass through each other, which no contact could part.
Valve ready_valve(const CloseArguments& arguments, const CloseInput& input, const Valve& found) {
  Valve valve = found;
  try {
    const LeafletSeparation apart = separate_leaflets(valve);
    if (apart.pairs > 0)
      std::printf(
          "warning: %d pairs of triangles of the leaflets passed through each other and were pushed apart, "
          "by up to %.2g mm; look at that place\n",
          apart.pairs, apart.largest_move);
  } catch (const InputError& error) {
    throw error.within(arguments.segment.output + "/leaflets/leaflets.vtp");
  }
  valve = chorded(arguments, input, std::move(valve));
  std::printf("chords:   %zu from %ld papillary tips%s\n", valve.chords.chords.size(),
              static_cast<long>(valve.chords.papillary.cols()),
              arguments.segment.papillary.empty() ? ", which no file gave" : "");
  return valve;
}

TriangleMesh moved(const RigidMotion& motion, TriangleMesh mesh) {
  mesh.vertices = motion.apply(mesh.vertices);
  return mesh;
}

PicturedValve pictured(const CloseInput& input, const Segmentation& found, const RunReport& solved) {
  TriangleMesh closed = surface_at(solved.model, solved.report.fields.x);
  closed.vertices.colwise() += solved.model.origin;
  const TriangleMesh& leaflets = found.valve.leaflets;
  const std::optional<Closure>& closure = solved.report.metrics.closure;
  return {input.open,
          leaflets,
          std::move(closed),
          input.annulus,
          leaflets.vertices.rowwise().mean(),
          closure ? pieces_of(closure->line, solved.model.origin) : std::vector<Points>()};
}

// Where the closed volume shows the coaptation line, in its own frame.
std::vector<LineInImage> found_line(const Volume& closed, const PicturedValve& there) {
  Vec3 up = plane_of(there.annulus).normal;
  if (up.dot(there.ventricle - Vec3(there.annulus.rowwise().mean())) > 0) up = -up;
  return line_in_image(closed, there.solved, there.line, up);
}

// Into image_distance.* and coaptation_lines.vtp, and the picture of it.
PageImage compare_with_closed(const CloseArguments& arguments, const CloseInput& input,
                              const PicturedValve& valve) {
  const RigidMotion back = input.to_open.inverse();
  PicturedValve there = valve;  // in the frame of the closed volume
  there.annulus = back.apply(valve.annulus);
  there.solved = moved(back, valve.solved);
  there.ventricle = back.apply(Points(valve.ventricle)).col(0);
  for (Points& piece : there.line) piece = back.apply(piece);
  const Points ridges = ridge_points_around(*input.closed, there.annulus);
  const ImageDistance distance = distance_from_image(valve.solved, input.to_open.apply(ridges));
  const std::vector<LineInImage> line_there = found_line(*input.closed, there);
  const ImageLine line = compared_line(line_there, input.to_open);
  write_image_distance(arguments.segment.output, valve.solved, distance, line, arguments.closed);
  write_image_line(arguments.segment.output, line);
  std::printf(
      "distance to the closed image: mean %.2f, 95 %% %.2f mm; back: mean %.2f, 95 %% %.2f mm (%ld points)\n",
      distance.to_image.mean, distance.to_image.p95, distance.from_image.mean, distance.from_image.p95,
      static_cast<long>(distance.ridge_points));
  std::printf("%s\n", sentence_on(line).c_str());
  return closed_picture(arguments.segment.output, *input.closed, there, ridges, line_there,
                        sentence_on(line));
}

RunReport solve_valve(const fs::path& folder, const Session& session) {
  const Scene scene = load_scene((folder / "scene" / "scene.json").string());
  RunOptions options;
  options.folder = folder / "result";
  options.factorisations = all_factorisations();
  options.checker = intersection_checker();
  show_progress(session, options);
  options.first_order = first_order_of_runs(all_solvers(), options);
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
  const fs::path folder = arguments.segment.output;
  refuse_folder_of(arguments.segment.volume, folder);
  const CloseInput input = read_input(arguments);
  const OutputFolder output(folder);
  listen_for_interrupts();
  Segmentation found = find_leaflets(arguments.segment, input.open);
  found.valve.name = formats::as_utf8(fs::path(arguments.segment.volume).stem().string());
  fs::create_directories(folder / "leaflets");
  // Also where the valve cannot be closed: what was found can be looked at, and says why.
  write_segmentation(folder / "leaflets", found, arguments.segment.volume, arguments.segment.annulus);
  found.valve = ready_valve(arguments, input, found.valve);
  write_segmentation(folder / "leaflets", found, arguments.segment.volume, arguments.segment.annulus);
  for (const std::string& warning : import_valve(folder / "leaflets" / "valve.json", folder / "scene"))
    std::printf("warning: %s\n", warning.c_str());
  const RunReport solved = solve_valve(folder, session);
  session.document = result_json(solved.model, solved.report);
  const PicturedValve valve = pictured(input, found, solved);
  std::vector<PageImage> pictures = {open_picture(folder, valve)};
  if (input.closed) pictures.push_back(compare_with_closed(arguments, input, valve));
  write_pictured_page(solved, "Slices through the images", pictures);
  std::printf(
      "written to %s (leaflets/, scene/, result/report.html, slices_open.png%s)\n", folder.string().c_str(),
      input.closed ? ", slices_closed.png, image_distance.vtp, image_distance.json, coaptation_lines.vtp"
                   : "");
  if (solved.report.result.status != Status::Converged) return kNotConverged;
  return is_in_doubt(solved.report) ? kInDoubt : kConverged;
}

}  // namespace

void add_close_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<CloseArguments>();
  CLI::App* command = app.add_subcommand(
      "close", "From a volume image to a closed valve: segment, chords, import and solve in one go");
  add_segment_options(*command, arguments->segment);
  command->add_option("--closed", arguments->closed,
                      "Volume with the closed valve: how far the solved leaflets lie from it");
  command->add_option("--closed-frame", arguments->closed_frame,
                      "Of --closed, where that is a time series; it may be the same file");
  command->add_option("--annulus-closed", arguments->annulus_closed,
                      "Annulus of the closed valve (.mrk.json): the annulus moves there");
  command->add_option("--papillary-closed", arguments->papillary_closed,
                      "Papillary tips of the closed valve (.mrk.json), in the order of --papillary");
  command->add_flag(
      "--register", arguments->registers,
      "Closed volume, annulus and tips lie elsewhere: the closed annulus is laid onto the open one");
  command->add_option("--chords", arguments->chords.count, "Chords of each zone that leave the tips")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->segment.output, "Folder to write")->required();
  command->callback([arguments, &session] { session.exit_code = close_image(*arguments, session); });
}

}  // namespace coapt::cli
