// Writes what a solve found: result.json, closed.vtp, closed.obj, trace.csv, metrics.csv; for a valve also
// coaptation_line.vtp and orifice.vtp.
#pragma once

#include "results/accuracy_estimate.hpp"
#include "results/branch_report.hpp"
#include "results/cascade_level.hpp"
#include "results/first_order.hpp"
#include "results/metrics.hpp"
#include "results/neighbour_check.hpp"
#include "results/reference/reference_distance.hpp"
#include "results/shape_record.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

// Everything about one solved scene.
struct Report {
  std::string scene_file;   // file name without folder; may be empty
  std::string scene_title;  // of pages; may be empty
  std::string solver;       // name
  double tolerance = 0;     // on the residual
  std::string pressure_route;
  Result result;
  std::vector<CascadeLevel> levels;  // empty: no cascade
  Fields fields;
  Metrics metrics;
  std::optional<ReferenceDistance> reference;
  std::optional<AccuracyEstimate> accuracy;  // where one was wanted
  NeighbourCheck neighbours;
  std::optional<Branches> branches;       // where they were looked for
  std::optional<FirstOrder> first_order;  // where it was wanted, for the page; or why there is none
  std::vector<std::string> warnings;
  std::vector<std::string> surface_doubts;  // clauses, see surface_doubts()
  bool has_frames = false;                  // of an animation, in the result folder
  bool has_collisions = false;  // the method was to keep facets apart (DynamicOptions::collisions)
  bool has_page = false;        // report.html is written
  std::vector<RecordedShape> shape_history = {};  // to the result, for the page; empty without one
};

// How the pressure of the model was treated, in words.
std::string pressure_route(const Model& model, const Result& result);

// The text of result.json; its schema is result_schema(). Numbers that are not finite become null.
std::string result_json(const Model& model, const Report& report);

// Names of all files of the report, with its page and its frames.
std::vector<std::string> result_files(const Model& model, const Report& report);

// Creates the folder where it is missing and throws InputError when nothing can be written into it; called
// before a long solve, so that an unwritable folder is found before it.
void prepare_result_folder(const std::filesystem::path& folder);

// Writes these files into the folder, result.json first; each appears under its
// name only when it is whole. closed.vtp holds the mesh and the lines in the coordinates of the input;
// positions are in mm. Throws InputError when a file cannot be written.
void write_results(const std::filesystem::path& folder, const Model& model, const Report& report);

}  // namespace coapt
