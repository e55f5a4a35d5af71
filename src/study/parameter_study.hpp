// A scene solved at every point of a grid of values, and the points ranked by a figure.
//
// What a study is made of is plain data and functions; who solves the points, and in how many processes, is
// left to the caller. A finished point is a file, so that a study that was stopped goes on where it was.
#pragma once

#include "formats/table.hpp"
#include "report/shape_view.hpp"
#include "results/standing.hpp"
#include "run/run.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace coapt {

// The values that one key takes.
struct Sweep {
  std::string path;                 // of the key, see with_value() in scene_text.hpp
  std::vector<std::string> values;  // at least one, as texts of the scene file
};

// KEY=a..b[:n], n values (default 5) at equal steps with both ends, or KEY=a,b,c. A unit may follow b, or
// each of a list: `ring.size=26..34mm:5`, `pressure.value=80,120 mmHg`. Throws InputError naming the sweep.
Sweep parse_sweep(const std::string& text);

struct StudyPoint {
  size_t number = 0;
  std::vector<std::string> values;  // of each sweep
  std::string scene;                // text
  std::string key;                  // of all that its result depends on: the scene and how it is solved
};

// Every combination, the last sweep fastest. Throws InputError where there are more than 100,000, a key is
// swept twice, or a point is no valid scene, naming its values: all such defects of the first bad point.
// settings: solver, tolerance and limits that the points are solved with, as text.
std::vector<StudyPoint> study_points(const std::filesystem::path& scene, const std::vector<Sweep>& sweeps,
                                     const std::string& settings);

// What is kept of a solved point.
struct PointResult {
  size_t number = 0;
  std::vector<std::string> values;
  std::string key;
  std::string status;  // name of the Status, or "refused"
  std::string message;
  double residual = 0;
  int iterations = 0;
  double wall_s = 0;
  std::vector<std::pair<std::string, std::optional<double>>> metrics;  // by name, in the order of metric_rows
  std::vector<std::string> doubts = {};                                // see doubts() in result_warnings.hpp

  bool has_converged() const { return status == status_name(Status::Converged); }
  std::optional<double> metric(const std::string& name) const;
};

// Under the name "point 7".
Standing standing(const PointResult& result);

PointResult point_result(const StudyPoint& point, const RunReport& run);
PointResult refused_point(const StudyPoint& point, const std::string& message);

// The folder of a point within that of the study: "point_0007".
std::filesystem::path point_folder(const std::filesystem::path& study, size_t number);

// Writes point.json into the folder, whole or not at all; reading gives nothing where there is none, it is
// not whole, or it is not of this point.
void write_point(const std::filesystem::path& folder, const PointResult& result);
std::optional<PointResult> read_point(const std::filesystem::path& folder, const StudyPoint& point);

struct ParameterStudy {
  std::string scene_file = {}, scene_title = {};
  std::vector<Sweep> sweeps = {};
  std::string metric = {};  // that ranks
  bool is_greatest_best = false;
  size_t point_count = 0;                 // of the grid
  std::vector<PointResult> results = {};  // in the order of the grid; fewer where the study was stopped
  std::optional<ShapeView> shapes = {};   // for the page, see point_shapes.hpp
  bool has_converged() const;             // every point of the grid
};

// Throws InputError where the name is none of metric_rows, listing those.
void check_metric(const std::string& name);

// Places in results: converged points by the metric, the best first, then converged ones without it, then the
// others. Equal ones keep the order of the grid.
std::vector<size_t> ranked(const ParameterStudy& study);

// One row for each point, the best first: study.csv, and what the page and `coapt study` show.
Table point_table(const ParameterStudy& study);

std::string parameter_study_json(const ParameterStudy& study);
std::string parameter_study_page(const ParameterStudy& study);

// Writes study.json, study.csv (a row for each point, ranked) and study.html. Throws InputError.
void write_parameter_study(const std::filesystem::path& folder, const ParameterStudy& study);

}  // namespace coapt
