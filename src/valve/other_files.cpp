#include "valve/other_files.hpp"

#include "core/error.hpp"
#include "formats/mesh_io.hpp"
#include "valve/valve_import.hpp"

namespace coapt {
namespace {

constexpr const char* kImport = "`coapt import FILE -o FOLDER` makes a scene of it";
constexpr const char* kMarkups =
    "`coapt import LEAFLETS --annulus-closed or --papillary FILE` takes its curve or points";

// Where a scene lies beside the file, that one is most likely meant.
[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& what, std::string remedy) {
  const std::filesystem::path scene = path.parent_path() / "scene.json";
  if (const size_t at = remedy.find("FILE"); at != std::string::npos) remedy.replace(at, 4, path.string());
  std::error_code unreadable;
  if (std::filesystem::is_regular_file(scene, unreadable))
    remedy += ", and " + scene.string() + " is a scene that lies beside it";
  throw InputError(path.string() + ": is " + what + " and no scene; " + remedy);
}

}  // namespace

void refuse_other_file(const std::filesystem::path& path) {
  std::error_code unreadable;
  if (!std::filesystem::is_regular_file(path, unreadable)) return;
  if (is_mesh_file(path)) refuse(path, "a mesh", kImport);
  if (is_model_file(path)) refuse(path, "a finite-element model", kImport);
}

void refuse_other_json(const Json& json, const std::filesystem::path& path) {
  if (!json.is_object()) return;
  if (json.contains("status") && json.contains("residual"))
    refuse(path, "the result of a solve", "its key `scene` names the scene that it was computed from");
  if (json.contains("terms")) return;
  if (json.contains("markups")) refuse(path, "a markups file of 3D Slicer", kMarkups);
  if (json.contains("leaflets")) refuse(path, "a valve JSON", kImport);
}

void refuse_scene(const Json& json, const std::filesystem::path& path, const std::string& expected) {
  if (!json.is_object() || !json.contains("terms") || json.contains("leaflets")) return;
  if (!expected.empty()) throw InputError(path.string() + ": is a scene; expected " + expected);
  throw InputError(path.string() + ": is a scene already: `coapt solve " + path.string() +
                   "` solves it as it is");
}

}  // namespace coapt
