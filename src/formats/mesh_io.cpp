#include "formats/mesh_io.hpp"

#include "core/error.hpp"
#include "formats/file_numbering.hpp"
#include "formats/formats.hpp"
#include "formats/lower_extension.hpp"
#include "formats/utf8.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "formats/whole_file.hpp"

#include <algorithm>
#include <cctype>

namespace coapt {
namespace {

using Reader = MeshFile (*)(std::string_view, const std::string&);

// Null for what is no mesh by its extension.
Reader reader_of(const std::filesystem::path& path) {
  const std::string format = formats::lower_extension(path);
  if (format == ".obj") return formats::read_obj;
  if (format == ".ply") return formats::read_ply;
  if (format == ".stl") return formats::read_stl;
  if (format == ".off") return formats::read_off;
  return format == ".vtp" ? formats::read_vtp : nullptr;
}

[[noreturn]] void refuse_extension(const std::filesystem::path& path) {
  throw InputError(path.string() + ": the extension '" + formats::lower_extension(path) +
                   "' is not a mesh format; use .obj, .ply, .stl, .off or .vtp");
}

// The frame that a file states: where the reader has not found it, in the text of its header.
void resolve_space(std::string_view bytes, const std::string& file, MeshFile& read) {
  constexpr size_t kHeader = 4096;
  const std::string_view head = bytes.substr(0, kHeader);
  if (read.space.empty() && head.find("SPACE=RAS") != std::string_view::npos) read.space = "RAS";
  if (read.space.empty() && head.find("SPACE=LPS") != std::string_view::npos) read.space = "LPS";
  if (read.space != "RAS") return;
  read.mesh.vertices.topRows(2) *= -1;
  read.space = "LPS";
  read.warnings.push_back(file + ": its coordinates are in RAS; x and y were turned to LPS.");
}

VtpSurface vtp_surface(const TriangleMesh& mesh, const std::string& space) {
  VtpSurface surface;
  surface.vertices = mesh.vertices;
  surface.triangles = mesh.triangles;
  if (!space.empty()) surface.texts.push_back({"SPACE", {space}});
  if (mesh.regions.empty()) return surface;
  const auto count = static_cast<Eigen::Index>(mesh.regions.size());
  VtpArray region{"region", Eigen::MatrixXd(1, count), true};
  for (Eigen::Index t = 0; t < count; ++t) region.values(0, t) = mesh.regions[static_cast<size_t>(t)];
  surface.triangle_arrays.push_back(std::move(region));
  surface.texts.push_back({"region_names", mesh.region_names});
  return surface;
}

}  // namespace

Numbering file_numbering(const std::filesystem::path& file) {
  return {formats::lower_extension(file) == ".obj" ? 1 : 0};
}

bool is_mesh_file(const std::filesystem::path& path) { return reader_of(path) != nullptr; }

MeshFile read_mesh(const std::filesystem::path& path) {
  const Reader read = reader_of(path);
  formats::refuse_what_is_no_file(path);
  if (!read) refuse_extension(path);
  const std::string bytes = formats::read_whole(path);
  MeshFile file = read(bytes, path.string());
  resolve_space(bytes, path.string(), file);
  for (std::string& name : file.mesh.region_names) name = formats::as_utf8(std::move(name));
  return file;
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh, std::optional<MeshCoding> coding,
                const std::string& space) {
  const std::string format = formats::lower_extension(path), remark = space.empty() ? "" : "SPACE=" + space;
  if (format == ".obj")
    formats::write_whole(path, formats::write_obj(mesh, remark));
  else if (format == ".ply")
    formats::write_whole(path, formats::write_ply(mesh, coding.value_or(MeshCoding::Binary), remark));
  else if (format == ".stl")
    formats::write_whole(path, formats::write_stl(mesh, coding.value_or(MeshCoding::Ascii), remark));
  else if (format == ".off")
    formats::write_whole(path, formats::write_off(mesh, remark));
  else if (format == ".vtp")
    write_vtp(path, vtp_surface(mesh, space), coding.value_or(MeshCoding::Binary));
  else
    refuse_extension(path);
}

}  // namespace coapt
