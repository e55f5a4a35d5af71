// How much the equilibrium of a scene depends on its mesh: solved again on meshes four, sixteen, ... times
// finer.
//
// Every triangle is cut into four flat ones, so that all meshes are discretisations of one and the same
// problem: shape at rest, supports, chord insertions, fibres and numbers given by triangle are those of the
// scene. Where contact takes its range from the edges of the mesh, that shrinks with them.
#pragma once

#include "formats/table.hpp"
#include "results/reference/reference_distance.hpp"
#include "run/run.hpp"

#include <functional>
#include <span>

namespace coapt {

struct MeshLevel {
  int triangles = 0, vertices = 0;
  Status status = Status::Stalled;
  std::vector<std::string> doubts = {};  // see doubts() in result_warnings.hpp
  double residual = 0;                   // relative
  int iterations = 0;
  double wall_s = 0, cpu_s = 0;  // of the solve, from the scene's own start
  long intersections = 0;
  std::optional<double> orifice_area_mm2, max_chord_force_n;
  TriangleMesh closed = {};  // relative to the model's origin [mm]
  std::optional<DistanceFigures> to_previous =
      {};  // between this closed surface and that of the level before
  std::optional<DistanceFigures> to_reference = {};  // where the scene has a reference surface
  // log2 of the ratio of the mean distances between the levels before and here; empty at the first two.
  std::optional<double> order = {};
};

struct MeshStudy {
  std::string scene_file, solver;
  double tolerance = 0;
  Vec3 origin = Vec3::Zero();  // of the closed surfaces [mm]
  std::vector<MeshLevel>
      levels;  // the scene's own mesh first; fewer than wanted where the study was cancelled

  bool has_converged() const;
};

// levels: how often the mesh is cut into four, at least once. report: called after each level; may be empty.
// A level that does not converge stays in the study and says so; distances to its shape are left out.
// options: as for run(); its time limit is that of each level. Throws InputError for bad input.
MeshStudy study_mesh(const Scene& scene, const SolverTable& solvers, int levels, const RunOptions& options,
                     const std::function<void(const MeshLevel&)>& report = {});

// One row for each level: mesh_study.csv, and what `coapt mesh-study` prints.
Table level_table(std::span<const MeshLevel> levels);

// Writes mesh_study.json, mesh_study.csv and the closed surface of each level, closed_<triangles>.obj.
// Throws InputError when a file cannot be written.
void write_mesh_study(const std::filesystem::path& folder, const MeshStudy& study);

}  // namespace coapt
