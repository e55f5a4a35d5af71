// What a program may want otherwise than the scene says.
#pragma once

#include "mesh/distance/intersections.hpp"
#include "optim/solver.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace coapt {

struct FirstOrder;
struct Model;
struct Report;
struct Scene;
struct SceneGeometry;

// What a run does next, for those who show how far it is.
struct RunPhase {
  std::string name = {};  // "mesh 1 of 3", "finest mesh", "certificate"; empty: one solve
  double tolerance = 0;   // on the residual, of the solve that begins; 0: none does
};

struct RunOptions {
  std::string solver;                 // empty: the scene's
  std::optional<double> tolerance;    // empty: the scene's
  std::optional<double> max_seconds;  // empty: the scene's
  std::optional<int> damped_steps;    // of Continuation, 0: solves at once; empty: the scene's
  std::optional<int> modes;           // smallest eigenvalues in the certificate; empty: the scene's
  std::optional<int> frame_interval;  // accepted iterates from frame to frame, at least 1; empty: the scene's
  std::optional<bool> writes_page;    // report.html; empty: as the scene says
  std::filesystem::path folder;       // empty: the scene's, see result_folder() of run.hpp
  bool writes = true;                 // false: measures only
  Observer observer;                  // may be empty
  std::function<void(const RunPhase&)> phase = {};  // told of each as it begins; may be empty

  // What is doubtful about a scene that was built, asked before it is solved: sentences for the warnings of
  // the result; may be empty.
  std::function<std::vector<std::string>(const Scene&, const SceneGeometry&, const Model&)> doubts = {};

  // How a result follows its parameters, for the sliders of report.html: asked where that page is written,
  // once all other files are. May be empty: no sliders. first_order_of_runs() of tuning makes one.
  std::function<FirstOrder(const Scene&, const Model&, const Report&)> first_order = {};

  // Those of the build; a scene that leaves the choice open gets "multifrontal".
  FactorisationTable factorisations = built_in_factorisations();
  IntersectionChecker checker;  // of the result
};

}  // namespace coapt
