// Markups of 3D Slicer, closed curves, pairs of facets, valve JSON and the tables that a scene names (numbers
// of triangles and of vertices, fibres, forces, positions): every input is read as each of them.
#include "formats/json/closed_curve.hpp"
#include "formats/json/markups.hpp"
#include "formats/json/valve_json.hpp"
#include "fuzz/fuzz_target.hpp"
#include "scene/build/build.hpp"
#include "scene/build/contact_pairs.hpp"

namespace coapt::fuzz {
namespace {

constexpr int kFacets = 100;

// Two triangles, for valves that name "leaflets.obj".
constexpr const char* kLeaflets = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\ng sheet\nf 1 2 3\nf 1 3 4\n";

// Scenes on them, each with the input as one table.
constexpr const char* kWithTables[] = {
    R"({"mesh": {"file": "leaflets.obj"}, "terms": [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3,
        "thickness": "1 mm", "triangle_values": "input.txt"}]})",
    R"({"mesh": {"file": "leaflets.obj"}, "terms": [{"type": "cst_stvk", "young": "1 MPa", "poisson": 0.3,
        "thickness": "1 mm", "vertex_values": "input.txt"}]})",
    R"({"mesh": {"file": "leaflets.obj"}, "fibres": {"file": "input.txt"}, "terms": [{"type": "cst_may_newman_yin",
        "c0": "1 kPa", "c1": 1, "c2": 2, "thickness": "1 mm"}]})",
    R"({"mesh": {"file": "leaflets.obj"}, "terms": [{"type": "cst_stvk", "young": "1 MPa", "thickness": "1 mm"},
        {"type": "load_field", "forces": "input.txt"}]})",
    R"({"mesh": {"file": "leaflets.obj"}, "boundary": [{"nodes": [0, 1, 2], "move_to": "input.txt"}],
        "terms": [{"type": "cst_stvk", "young": "1 MPa", "thickness": "1 mm"}]})"};

}  // namespace

void run_target(std::string_view bytes) {
  static const Scratch scratch;
  static const auto leaflets = scratch.write("leaflets.obj", kLeaflets);
  const auto markups = scratch.write("input.mrk.json", bytes), valve = scratch.write("input.json", bytes),
             curve = scratch.write("input.txt", bytes);
  std::vector<std::function<void()>> readers = {
      [&] {
        for (const Markup& markup : read_markups(markups))
          require(markup.points.allFinite(), "points of a markup are finite");
      },
      [&] { require(annulus_curve(markups).cols() >= 3, "an annulus has three points"); },
      [&] { require(papillary_points(markups).cols() >= 1, "there are tips"); },
      [&] { require(read_closed_curve(curve).allFinite(), "points of a curve are finite"); },
      [&] {
        for (const auto& [first, second] : read_facet_pairs(curve, kFacets))
          require(0 <= first && first <= second && second < kFacets,
                  "pairs are of facets, the smaller first");
      },
      [&] {
        const ValveFile file = read_valve(valve);
        for (const auto& [name, points] : file.points)
          require(points.allFinite(), "positions of a valve are finite");
      },
      [&] { read_valve(valve, ValveMeshes::Skip); }};
  for (const char* text : kWithTables)
    readers.emplace_back([&, text] {
      const Model model = build(parse_scene(text, leaflets.parent_path() / "scene.json"));
      Vector g;
      model.objective->gradient(model.objective->unknowns(model.X), g);
      require(g.allFinite() && model.fibres.allFinite(), "what is built from a table is finite");
    });
  try_each(readers, "points nor a valve");
}

}  // namespace coapt::fuzz
