// A scene as plain data: names, and numbers in internal units (mm, N, MPa).
#pragma once

#include "optim/solver.hpp"
#include "registration/registration.hpp"
#include "scene/file/parameters.hpp"
#include "valve/generators/leaflet_chords.hpp"

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct SceneMesh {
  std::filesystem::path file;
  double scale = 1;                           // mm per unit of the file
  std::optional<std::filesystem::path> sets;  // JSON with named node sets and points
};

// How the closed surface of `reference` is brought onto the result.
struct SceneRegistration {
  std::string where;  // for messages
  RegistrationMethod method = RegistrationMethod::Surface;
  RegistrationOptions options;
  std::filesystem::path landmarks, reference_landmarks;  // of the method of this name
};

// Later entries win over earlier ones where they share nodes.
struct BoundaryEntry {
  std::string where;  // for messages
  NodeSelection nodes;
  std::array<bool, 3> fix{};     // prescribed coordinates
  std::vector<MoveTarget> path;  // empty: they stay
  double scale = 1;              // mm per unit of the files in `path`
};

// A surface that the membrane meets; its nodes are prescribed and known by its name.
struct SceneObstacle {
  std::string where;  // for messages
  std::string name;
  std::filesystem::path file;
  double scale = 1;  // mm per unit of the file
};

// Fibre directions in the membrane.
struct FibreEntry {
  std::string where;  // for messages
  NodeSelection nodes;
  SurfaceDirection direction;
};
struct SceneFibres {
  std::string where;                          // for messages
  std::string defaults = "auto";              // auto, valve, boundary, none
  std::vector<FibreEntry> entries;            // later ones win, all over the defaults
  std::optional<std::filesystem::path> file;  // one direction per triangle, instead of the others
  bool joins_regions = false;
};

// Chords that are made when the scene is built, for terms whose `network` is kGeneratedNetwork.
struct SceneChords {
  std::string where;                  // for messages
  Points tips = Points(3, 0);         // none: the papillary points of the file of sets [mm]
  Points tips_closed = Points(3, 0);  // none: the tips stay, or as above [mm]
  LeafletChordOptions options;
};
inline constexpr const char* kGeneratedNetwork = "generated";

struct TermSpec {
  std::string type, name;  // the name is unique within the scene
  Parameters parameters;
};

// One edit of the valve, made between mesh and terms (docs/interventions.md).
struct InterventionSpec {
  std::string type, name;  // the name is unique among the interventions and the terms
  Parameters parameters;
};

struct SolverSpec : MethodOptions, StopRule {
  std::string type = "newton";
  bool cascade = false;                // coarser meshes first
  std::string factorisation = "auto";  // name in the table of the build
  Continuation continuation;
  int threads = 0;           // that share the work; 0: as many as there are processors
  double density = 1.06e-9;  // of membrane and lines, for methods that move masses [t/mm3]
  int modes = 0;             // smallest eigenvalues in the certificate
};

struct Scene {
  std::filesystem::path file;  // that it was read from
  std::string name;
  std::optional<SceneMesh> mesh;
  std::map<std::string, NodeSelection> sets;
  std::vector<SceneObstacle> obstacles;
  std::vector<BoundaryEntry> boundary;
  int motion_steps = 0;  // 0 = no prescribed node moves by more than one mean edge length in a step
  std::optional<SceneFibres> fibres;
  std::optional<SceneChords> chords;
  std::vector<TermSpec> terms;  // with those that interventions bring
  SolverSpec solver;
  std::optional<std::filesystem::path> closed_surface;  // reference
  double closed_surface_scale = 1;                      // mm per unit of that file
  std::optional<SceneRegistration> registration;        // none: the closed surface stays as it lies
  std::optional<std::filesystem::path> output_folder;   // relative to the scene's folder resolved
  int frame_interval = 0;                               // accepted iterates from frame to frame; 0: no frames
  bool writes_page = true;                              // report.html
  bool wants_first_piola = false;                       // stress among the fields
  std::vector<InterventionSpec> interventions;          // in the order in which they are made
};

// Reads and validates a scene file (docs/scene.md). Throws InputError with all defects, each as
// `FILE: terms[1].yuong: unknown key; did you mean "young"?`.
Scene load_scene(const std::filesystem::path& path);

// The same from text; `path` gives the name for messages and the folder that relative paths start from.
Scene parse_scene(const std::string& text, const std::filesystem::path& path);

// For people: `Mitral valve (scene.json)`; the file's name alone where the scene has no name of its own.
std::string scene_title(const Scene& scene);

}  // namespace coapt
