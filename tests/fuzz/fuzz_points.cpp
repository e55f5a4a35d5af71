// Markups of 3D Slicer, closed curves, pairs of facets and valve JSON: every input is
// read as each of them.
#include "fuzz/fuzz_target.hpp"
#include "scene/closed_curve.hpp"
#include "scene/contact_pairs.hpp"
#include "scene/markups.hpp"
#include "scene/valve_json.hpp"

namespace coapt::fuzz {
namespace {

constexpr int kFacets = 100;

// Two triangles, for valves that name "leaflets.obj".
constexpr const char* kLeaflets = "v 0 0 0\nv 10 0 0\nv 10 10 0\nv 0 10 0\ng sheet\nf 1 2 3\nf 1 3 4\n";

}  // namespace

void run_target(std::string_view bytes) {
  static const Scratch scratch;
  static const auto leaflets = scratch.write("leaflets.obj", kLeaflets);
  const auto markups = scratch.write("input.mrk.json", bytes), valve = scratch.write("input.json", bytes),
             curve = scratch.write("input.txt", bytes);
  const std::vector<std::function<void()>> readers = {
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
  try_each(readers, "points nor a valve");
}

}  // namespace coapt::fuzz
