#include "cli/command_line.hpp"
#include "cli/commands.hpp"
#include "cli/length_argument.hpp"
#include "cli/session.hpp"
#include "cli/written_document.hpp"
#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/json_text.hpp"
#include "formats/json/markups.hpp"
#include "formats/lower_extension.hpp"
#include "formats/mesh_io.hpp"
#include "image/read_volume.hpp"
#include "image/segment/ridge_points.hpp"
#include "image/slices/valve_slices.hpp"
#include "image/write_volume.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

namespace coapt::cli {
namespace {

// Of surfaces drawn on slices, in their order (Okabe and Ito, "Color universal design", 2008).
constexpr std::array<Colour, 4> kSurfaceColours = {
    Colour{86, 180, 233}, {230, 159, 0}, {0, 158, 115}, {204, 121, 167}};

constexpr Colour kSheetColour = {240, 228, 66};  // yellow of the same set

struct ImageArguments {
  std::string file, output, kind, annulus;
  std::vector<std::string> surfaces;
  std::optional<int> frame;
  bool draws_sheets = false;
  std::vector<std::string> spacing;  // with units: one for all axes, or three
};

VolumeReadOptions read_options(const ImageArguments& arguments) {
  VolumeReadOptions options{arguments.frame, {}};
  if (arguments.spacing.empty()) return options;
  if (arguments.spacing.size() == 2) throw InputError("--spacing: give one length for all axes, or three");
  Vec3 spacing;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string& text = arguments.spacing[std::min(axis, arguments.spacing.size() - 1)];
    spacing[static_cast<Eigen::Index>(axis)] = length_argument("--spacing", text);
  }
  options.spacing = spacing;
  return options;
}

// The box around the centres of all voxels [mm].
struct CentreBox {
  Vec3 low, high;
};

CentreBox centre_box(const Volume& volume) {
  const Vec3 last(volume.size[0] - 1, volume.size[1] - 1, volume.size[2] - 1);
  CentreBox box{Vec3::Constant(kInfinity), Vec3::Constant(-kInfinity)};
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at =
        position_of(volume, last.cwiseProduct(Vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1)));
    box.low = box.low.cwiseMin(at);
    box.high = box.high.cwiseMax(at);
  }
  return box;
}

nlohmann::ordered_json triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

nlohmann::ordered_json image_json(const std::string& path, const VolumeFile& file) {
  const Volume& volume = file.volume;
  const CentreBox box = centre_box(volume);
  nlohmann::ordered_json json = {{"file", path},
                                 {"format", file.format},
                                 {"voxel_kind", voxel_kind_name(file.kind)},
                                 {"size", volume.size},
                                 {"frames", file.frames},
                                 {"spacing_mm", nullptr},
                                 {"origin_mm", triple(volume.origin)},
                                 {"direction", nlohmann::ordered_json::array()},
                                 {"box_mm", {{"low", triple(box.low)}, {"high", triple(box.high)}}},
                                 {"range", nullptr},
                                 {"warnings", file.warnings}};
  if (file.states_spacing) json["spacing_mm"] = triple(volume.spacing);
  for (int axis = 0; axis < 3; ++axis) json["direction"].push_back(triple(volume.direction.col(axis)));
  if (!volume.values.empty()) {
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    json["range"] = {*low, *high};
  }
  return json;
}

std::string triple_text(const Vec3& v) {
  return number_text(v.x(), 6) + ", " + number_text(v.y(), 6) + ", " + number_text(v.z(), 6);
}

void print_image(const std::string& path, const VolumeFile& file) {
  const Volume& volume = file.volume;
  std::printf("%s: %s, %d x %d x %d voxels of %s", path.c_str(), file.format.c_str(), volume.size[0],
              volume.size[1], volume.size[2], voxel_kind_name(file.kind).c_str());
  if (file.frames > 1) std::printf(", %d frames", file.frames);
  std::printf("\n  spacing     %s\n",
              file.states_spacing ? (triple_text(volume.spacing) + " mm").c_str() : "not stated");
  std::printf("  origin      %s mm (LPS, centre of the first voxel)\n", triple_text(volume.origin).c_str());
  for (int axis = 0; axis < 3; ++axis)
    std::printf("  axis %c      %s\n", "ijk"[axis], triple_text(volume.direction.col(axis)).c_str());
  const CentreBox box = centre_box(volume);
  if (file.states_spacing)
    std::printf("  lies from   %s to %s mm\n", triple_text(box.low).c_str(), triple_text(box.high).c_str());
  if (!volume.values.empty()) {
    const auto [low, high] = std::minmax_element(volume.values.begin(), volume.values.end());
    std::printf("  range       %s to %s\n", number_text(*low, 6).c_str(), number_text(*high, 6).c_str());
  }
  for (const std::string& warning : file.warnings) std::printf("warning: %s\n", warning.c_str());
}

void show_image(const ImageArguments& arguments, Session& session) {
  const VolumeReadOptions options = read_options(arguments);
  VolumeFile file = read_volume_header(arguments.file, options);
  // Of a series without a frame chosen, and where lengths are not known, the header says all that can be
  // said.
  if (file.states_spacing && (file.frames == 1 || arguments.frame))
    file = read_volume(arguments.file, options);
  print_image(arguments.file, file);
  session.document = image_json(arguments.file, file).dump(2);
}

void convert_image(const ImageArguments& arguments, Session& session) {
  std::error_code is_missing;
  if (std::filesystem::equivalent(arguments.file, arguments.output, is_missing))
    throw InputError(arguments.output + ": is the volume to convert; write to another file");
  const VolumeFile file = read_volume(arguments.file, read_options(arguments));
  for (const std::string& warning : file.warnings) std::printf("warning: %s\n", warning.c_str());
  const VoxelKind kind = arguments.kind.empty() ? file.kind : voxel_kind(arguments.kind).value();
  write_volume(arguments.output, file.volume, kind);
  std::printf("written to %s (%s)\n", arguments.output.c_str(), voxel_kind_name(kind).c_str());
  session.document = written_document({arguments.output}, file.warnings);
}

// Through the valve of an annulus, the leaflets below where surfaces say where they are; else through the
// middle of the volume.
void draw_slices(const ImageArguments& arguments, Session& session) {
  if (formats::lower_extension(arguments.output) != ".png")
    throw InputError(arguments.output + ": slices are written as .png");
  const VolumeFile file = read_volume(arguments.file, read_options(arguments));
  for (const std::string& warning : file.warnings) std::printf("warning: %s\n", warning.c_str());
  std::vector<DrawnSurface> surfaces;
  for (const std::string& path : arguments.surfaces)
    surfaces.push_back({read_mesh(path).mesh, kSurfaceColours[surfaces.size() % kSurfaceColours.size()]});
  std::optional<Vec3> below;
  if (!surfaces.empty()) below = surfaces.front().surface.vertices.rowwise().mean();
  const std::vector<SlicePlane> planes = arguments.annulus.empty()
                                             ? middle_planes(file.volume)
                                             : valve_planes(annulus_curve(arguments.annulus), below);
  std::vector<DrawnPoints> sheets;
  if (arguments.draws_sheets) sheets.push_back({ridge_points_in(file.volume), kSheetColour});
  const Picture picture = valve_slices(file.volume, planes, surfaces, sheets);
  write_png(arguments.output, picture);
  std::printf("written to %s (%d x %d pixels)\n", arguments.output.c_str(), picture.width, picture.height);
  session.document = written_document({arguments.output}, file.warnings);
}

void add_reading_options(CLI::App& command, ImageArguments& arguments) {
  command
      .add_option("FILE", arguments.file,
                  "Volume: .nrrd, .seq.nrrd, .nhdr, .nii, .nii.gz, .mha, .mhd, or a folder "
                  "with a DICOM series")
      ->required();
  command.add_option("--frame", arguments.frame, "Frame of a time series, from 0");
  command
      .add_option("--spacing", arguments.spacing,
                  "Edge lengths of the voxels in place of the file's, one or three: 0.5mm")
      ->expected(1, 3);
}

}  // namespace

void add_image_command(CLI::App& app, Session& session) {
  CLI::App* command = app.add_subcommand(
      "image", "Say what a volume image holds, draw slices through it, or write it in another format");
  command->require_subcommand(1);
  const auto arguments = std::make_shared<ImageArguments>();
  CLI::App* info = command->add_subcommand(
      "info", "Size, spacing, origin, direction, range, kind of voxel, frames, place");
  add_reading_options(*info, *arguments);
  info->callback([arguments, &session] { show_image(*arguments, session); });

  CLI::App* convert =
      command->add_subcommand("convert", "Write a volume, or one frame of a series, to another file");
  add_reading_options(*convert, *arguments);
  convert->add_option("-o,--output", arguments->output, "File to write: .nrrd, .nii, .nii.gz or .mha")
      ->required();
  convert
      ->add_option("--kind", arguments->kind,
                   "Kind of its voxels (default: as in FILE); whole numbers are rounded")
      ->check(CLI::IsMember({"uint8", "int16", "uint16", "float32"}));
  CLI::App* slices = command->add_subcommand("slices", "Draw slices through the volume, as one PNG");
  add_reading_options(*slices, *arguments);
  slices->add_option(
      "--annulus", arguments->annulus,
      "Closed curve (.mrk.json): slices along its axis (default: along the axes of the volume)");
  slices->add_option("--surface", arguments->surfaces, "Mesh to draw where a slice cuts it; any number")
      ->delimiter(',');
  slices->add_flag("--sheets", arguments->draws_sheets,
                   "Draw the middles of the bright sheets that the volume shows");
  slices->add_option("-o,--output", arguments->output, "File to write: .png")->required();
  slices->callback([arguments, &session] { draw_slices(*arguments, session); });
  convert->callback([arguments, &session] { convert_image(*arguments, session); });
}

}  // namespace coapt::cli
