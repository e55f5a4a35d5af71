// Scene files: read, and where they are read, built and evaluated once.
#include "core/error.hpp"
#include "fuzz/fuzz_target.hpp"
#include "scene/build/build.hpp"
#include "scene/file/scene.hpp"

namespace coapt::fuzz {
namespace {

constexpr const char* kMesh =
    "v 0 0 0\nv 10 0 0\nv 20 0 0\nv 0 10 0\nv 10 10 1\nv 20 10 0\nv 0 20 0\nv 10 20 0\nv 20 20 0\n"
    "g left\nf 1 2 5\nf 1 5 4\nf 4 5 8\nf 4 8 7\ng right\nf 2 3 6\nf 2 6 5\nf 5 6 9\nf 5 9 8\n";
constexpr const char* kFloor = "v -50 -50 -9\nv 60 -50 -9\nv 0 70 -9\nf 1 2 3\n";
constexpr const char* kValve = R"({"leaflets": "mesh.obj", "annulus": [0, 1, 2, 5, 8, 7, 6, 3],
  "papillary": [[10, 10, -15]], "papillary_closed": [[10, 10, -16]],
  "chords": [{"from": {"papillary": 0}, "to": {"leaflet": 4}, "area": 0.4, "rest_length": 15}]})";

}  // namespace

void run_target(std::string_view bytes) {
  static const Scratch scratch;
  static const auto mesh = scratch.write("mesh.obj", kMesh), floor = scratch.write("floor.obj", kFloor),
                    valve = scratch.write("valve.json", kValve);
  const Scene scene = parse_scene(std::string(bytes), mesh.parent_path() / "scene.json");
  Model model = build(scene);
  const Vector q = model.objective->unknowns(model.X);
  Vector g;
  model.objective->gradient(q, g);
  require(g.size() == q.size(), "the gradient has an entry for each unknown");
}

}  // namespace coapt::fuzz
