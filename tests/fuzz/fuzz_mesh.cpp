// OBJ, PLY, STL, OFF and VTP: every input is read as each of them. What is accepted keeps the promises of
// read_mesh, is judged without an exception, and is read again as it was written.
#include "core/error.hpp"
#include "formats/formats.hpp"
#include "fuzz/fuzz_target.hpp"
#include "mesh/mesh_check.hpp"

namespace coapt::fuzz {
namespace {

using Reader = MeshFile (*)(std::string_view, const std::string&);

bool is_same(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

void checker(const TriangleMesh& mesh) {
  require(mesh.triangle_count() > 0, "a mesh has triangles");
  require(mesh.vertices.allFinite(), "coordinates are finite");
  require(mesh.triangles.minCoeff() >= 0 && mesh.triangles.maxCoeff() < mesh.vertex_count(),
          "corners are vertices");
  require(mesh.regions.empty() || static_cast<int>(mesh.regions.size()) == mesh.triangle_count(),
          "every triangle has a region");
  for (const int region : mesh.regions)
    require(region >= 0 && region < static_cast<int>(mesh.region_names.size()), "every region has a name");
  check_mesh(mesh, {.orientation_matters = true, .contact = mesh.triangle_count() < 200});
  require(is_same(formats::read_ply(formats::write_ply(mesh, MeshCoding::Binary), "again.ply").mesh, mesh),
          "binary PLY gives the same numbers");
  require(is_same(formats::read_off(formats::write_off(mesh), "again.off").mesh, mesh),
          "OFF gives the same numbers");
}

}  // namespace

void run_target(std::string_view bytes) {
  bool is_read = false;
  for (const Reader read :
       {&formats::read_obj, &formats::read_ply, &formats::read_stl, &formats::read_off, &formats::read_vtp}) {
    MeshFile file;
    try {
      file = read(bytes, "input");
    } catch (const InputError& error) {
      require(!error.defects().empty(), "a refusal has a reason");
      continue;
    }
    is_read = true;
    checker(file.mesh);
  }
  if (!is_read) throw InputError("input: no mesh");
}

}  // namespace coapt::fuzz
