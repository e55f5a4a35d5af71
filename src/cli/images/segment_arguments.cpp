#include "cli/images/segment_arguments.hpp"

#include "cli/command_line.hpp"
#include "cli/length_argument.hpp"
#include "cli/progress.hpp"
#include "core/error.hpp"
#include "formats/json/markups.hpp"
#include "formats/json/valve_json.hpp"
#include "formats/lower_extension.hpp"
#include "image/read_volume.hpp"
#include "image/template/fit_template.hpp"
#include "image/template/given_template.hpp"
#include "valve/other_files.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace coapt::cli {
namespace {

// What a user writes for each value of an option; the first is the default.
template <typename Value>
using Names = std::vector<std::pair<std::string, Value>>;

const Names<SegmentMethod>& methods() {
  static const Names<SegmentMethod> kNames = {{"ridge", SegmentMethod::Ridge},
                                              {"isosurface", SegmentMethod::Isosurface},
                                              {"burlina-2010", SegmentMethod::Burlina2010},
                                              {"template", SegmentMethod::Template}};
  return kNames;
}

const Names<Inhibition>& inhibitions() {
  static const Names<Inhibition> kNames = {{"intensity", Inhibition::Intensity}, {"edge", Inhibition::Edge}};
  return kNames;
}

const Names<EdgeRule>& edge_rules() {
  static const Names<EdgeRule> kNames = {{"contrast", EdgeRule::Contrast}, {"learnt", EdgeRule::Learnt}};
  return kNames;
}

// Pre: one of the names, or empty for the default.
template <typename Value>
Value value_named(const Names<Value>& names, const std::string& name) {
  for (const auto& [other, value] : names)
    if (other == name) return value;
  return names.front().second;
}

template <typename Value>
std::string name_of(const Names<Value>& names, Value value) {
  for (const auto& [name, other] : names)
    if (other == value) return name;
  return "";
}

std::optional<Valve> template_shape(const SegmentArguments& arguments) {
  if (arguments.shape.empty()) return std::nullopt;
  if (formats::lower_extension(arguments.shape) == ".json")
    refuse_scene(read_json(arguments.shape), arguments.shape,
                 "a valve JSON with an annulus and a free edge, as `coapt segment` writes");
  ValveFile file = read_valve(arguments.shape);
  for (const std::string& warning : file.warnings) std::printf("warning: %s\n", warning.c_str());
  try {
    check_template(file.valve);
  } catch (const InputError& error) {
    throw error.within(arguments.shape);
  }
  return std::move(file.valve);
}

SegmentOptions segment_options(const SegmentArguments& arguments) {
  SegmentOptions options;
  options.method = value_named(methods(), arguments.method);
  options.finder = template_finder({.shape = template_shape(arguments)});
  options.has_second_route = arguments.has_second_route;
  options.inhibition = value_named(inhibitions(), arguments.inhibition);
  if (!arguments.edge.empty()) options.edge = value_named(edge_rules(), arguments.edge);
  if (!arguments.seeds.empty()) {
    options.seeds = papillary_points(arguments.seeds);
    if (options.seeds->cols() != 2)
      throw InputError(arguments.seeds + ": has " + std::to_string(options.seeds->cols()) +
                       " points; expected 2, one in the atrium and one in the ventricle");
  }
  options.annulus = annulus_curve(arguments.annulus);
  if (!arguments.papillary.empty())
    options.ventricle = papillary_points(arguments.papillary).rowwise().mean();
  options.threshold = arguments.threshold;
  if (!arguments.mask.empty()) options.mask = printed_volume(arguments.mask, std::nullopt);
  options.dynamic_range = arguments.dynamic_range.value_or(0);
  if (!arguments.blur.empty()) options.blur = length_argument("--blur", arguments.blur);
  options.edge_length = length_argument("--edge-length", arguments.edge_length);
  options.keeps_evidence = arguments.keeps_evidence;
  const bool is_terminal = isatty(STDERR_FILENO) == 1;
  options.on_phase = [is_terminal](const std::string& phase) {
    if (is_terminal) std::fprintf(stderr, "\r  %s ...\033[K", phase.c_str());
  };
  return options;
}

// What is doubtful first.
void print_found(const Segmentation& found) {
  for (const std::string& warning : found.warnings) std::printf("warning: %s\n", warning.c_str());
  const TriangleMesh& mesh = found.valve.leaflets;
  std::printf("leaflets: %d vertices, %d triangles, least angle %.1f degrees, %.1f mm2\n",
              mesh.vertex_count(), mesh.triangle_count(), found.least_angle,
              surface_area(mesh.vertices, mesh.triangles));
  std::printf("  %-12s %.2f mm in the middle, seen through a blur of %.2f mm\n", "thickness",
              found.thickness_median, found.blur);
  std::printf("  %-12s %.2f mm across the leaflets on average, %.2f mm of the free edge along them\n",
              "deviation", found.deviation.mean(), found.edge_deviation);
  if (const std::optional<RouteAgreement>& other = found.second_route)
    std::printf("  %-12s %.2f mm away on average, 95 %% %.2f mm; its free edge %.2f mm, its area %+.1f %%\n",
                "second route", other->mean, other->p95, other->free_edge, 100 * other->area_difference);
  std::printf("  %-12s %.0f %% of the area\n", "shown", 100 * found.shown_share);
  std::printf("  %-12s %d x %d x %d voxels, %.1f s of the processor\n", "looked at", found.size[0],
              found.size[1], found.size[2], found.cpu_seconds);
}

void add_edge_options(CLI::App& command, SegmentArguments& arguments) {
  command
      .add_option("--edge", arguments.edge,
                  "What the free edge of ridge is found by: contrast, with the strength of the sheet, or "
                  "learnt, a network that knows generated phantoms of ultrasound alone (default: learnt with "
                  "--dynamic-range and without --mask, else contrast)")
      ->check(CLI::IsMember(edge_rules()));
  command.add_option("--edge-length", arguments.edge_length, "Of the mesh")->capture_default_str();
}

}  // namespace

void add_segment_options(CLI::App& command, SegmentArguments& arguments) {
  arguments.method = methods().front().first;
  arguments.inhibition = inhibitions().front().first;
  command
      .add_option("VOLUME", arguments.volume,
                  "Volume with the open valve: NRRD, NIfTI, MetaImage or a DICOM folder")
      ->required();
  command
      .add_option("--annulus", arguments.annulus,
                  "Closed curve of 3D Slicer (.mrk.json) along the annulus, in the frame of the volume")
      ->required();
  command.add_option("--frame", arguments.frame, "Of a time series, from 0 on");
  command.add_option("--papillary", arguments.papillary,
                     "Papillary tips (.mrk.json); they also say on which side the ventricle is");
  command
      .add_option(
          "--dynamic-range", arguments.dynamic_range,
          "Between the least and the greatest value, in dB, where values are logarithms (ultrasound); "
          "default: values are linear (CT, MR)")
      ->check(CLI::Range(1.0, 200.0));
  command.add_option("--blur", arguments.blur,
                     "Standard deviation of the blur across the leaflets, such as 0.4mm (default: found)");
  auto* method =
      command
          .add_option("--method", arguments.method,
                      "ridge: the middle of the bright sheet; isosurface: the side to the atrium of what "
                      "is above a threshold; template: a shape that is fitted by its energy in the image; "
                      "burlina-2010: what the thin-tissue detector and the level set of "
                      "that paper leave")
          ->check(CLI::IsMember(methods()))
          ->capture_default_str();
  command
      .add_option("--template", arguments.shape,
                  "Of template: a valve JSON with leaflets, annulus and free edge (default: a funnel)")
      ->needs(method);
  command.add_flag(
      "--second-route", arguments.has_second_route,
      "Also find the leaflets as template where the method is ridge, or the other way round, and "
      "say how far the two lie apart");
  command.add_option("--threshold", arguments.threshold, "Of the isosurface (default: Otsu's)")
      ->needs(method);
  command
      .add_option("--inhibition", arguments.inhibition,
                  "Of burlina-2010, what stops its contours: edge (eq. 7) or intensity (eq. 8)")
      ->check(CLI::IsMember(inhibitions()))
      ->capture_default_str()
      ->needs(method);
  command
      .add_option("--seeds", arguments.seeds,
                  "Of burlina-2010: two points (.mrk.json), in the blood of the atrium and of the ventricle")
      ->needs(method);
  command
      .add_option(
          "--mask", arguments.mask,
          "Volume that is above 0.5 in the leaflets, as a neural network gives it: it takes the place of "
          "what the image shows")
      ->excludes(method);
  add_edge_options(command, arguments);
  command.add_flag("--keep", arguments.keeps_evidence, "Also write the evidence of sheets, evidence.nrrd");
}

Volume printed_volume(const std::string& path, const std::optional<int>& frame,
                      const std::string& frame_option) {
  VolumeFile file = read_volume(path, {.frame = frame, .spacing = {}, .frame_option = frame_option});
  for (const std::string& warning : file.warnings) std::printf("warning: %s\n", warning.c_str());
  return std::move(file.volume);
}

Segmentation find_leaflets(const SegmentArguments& arguments, const Volume& volume) {
  const auto needs_method = [&](SegmentMethod method, const std::string& options) {
    if (value_named(methods(), arguments.method) != method)
      throw InputError(options + ": belongs to --method " + name_of(methods(), method));
  };
  if (arguments.threshold) needs_method(SegmentMethod::Isosurface, "--threshold");
  if (!arguments.seeds.empty() || value_named(inhibitions(), arguments.inhibition) != Inhibition::Intensity)
    needs_method(SegmentMethod::Burlina2010, "--seeds or --inhibition");
  if (!arguments.shape.empty()) needs_method(SegmentMethod::Template, "--template");
  if (arguments.has_second_route && !arguments.mask.empty())
    throw InputError("--second-route: is of what the image shows, and not of a --mask");
  const bool is_learnt = arguments.edge == name_of(edge_rules(), EdgeRule::Learnt);
  if (is_learnt && (!arguments.dynamic_range || !arguments.mask.empty()))
    throw InputError("--edge learnt: is of ultrasound, with --dynamic-range and without a --mask");
  if (is_learnt) needs_method(SegmentMethod::Ridge, "--edge learnt");
  const SegmentOptions options = segment_options(arguments);
  try {
    const auto [least, greatest] = std::minmax_element(volume.values.begin(), volume.values.end());
    if (*least == *greatest) throw InputError("the image has the same value everywhere: it shows nothing");
    const Segmentation found = segment_leaflets(volume, options);
    end_progress();
    print_found(found);
    return found;
  } catch (const InputError& error) {
    end_progress();
    throw error.within(arguments.volume);
  }
}

}  // namespace coapt::cli
