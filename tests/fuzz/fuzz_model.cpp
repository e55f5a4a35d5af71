// Abaqus input files and FEBio models, up to the valve that is made of them.
#include "core/error.hpp"
#include "formats/fe_readers.hpp"
#include "formats/utf8.hpp"
#include "fuzz/fuzz_target.hpp"

namespace coapt::fuzz {
namespace {

void checker(const Valve& valve) {
  const TriangleMesh& mesh = valve.leaflets;
  require(mesh.vertices.allFinite(), "coordinates are finite");
  require(mesh.triangle_count() > 0, "a valve has leaflets");
  require(mesh.triangles.minCoeff() >= 0 && mesh.triangles.maxCoeff() < mesh.vertex_count(),
          "corners are vertices");
  for (const int vertex : valve.annulus)
    require(vertex >= 0 && vertex < mesh.vertex_count(), "the annulus is vertices");
}

}  // namespace

void run_target(std::string_view bytes) {
  const bool is_xml = bytes.find('<') < bytes.find('*');
  const std::string text = formats::as_utf8(std::string(bytes));
  formats::FeModel model =
      is_xml ? formats::read_febio(text, "input.feb") : formats::read_abaqus(text, "input.inp");
  checker(formats::valve_of(model));
}

}  // namespace coapt::fuzz
