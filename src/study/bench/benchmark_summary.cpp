#include "study/bench/benchmark_summary.hpp"

#include "report/report_page.hpp"

#include <algorithm>
#include <cmath>

namespace coapt {
namespace {

bool is_asked(const BenchRun& run, const RunFilter& filter) {
  return run.status == Status::Converged && run.method == filter.method.value_or(run.method) &&
         run.mesh == filter.mesh.value_or(run.mesh);
}

// 2,500.
std::string grouped(int count) {
  std::string text = std::to_string(count);
  for (int k = static_cast<int>(text.size()) - 3; k > 0; k -= 3) text.insert(static_cast<size_t>(k), ",");
  return text;
}

std::string described(const Benchmark& bench, const BenchRun& run) {
  return bench.methods[run.method].name + ", " + mesh_text(bench.meshes[run.mesh]) + ", " +
         page_number(run.wall.median, 2) + " s";
}

std::string not_found(const Benchmark& bench, size_t method, const BenchMesh& mesh) {
  return "the equilibrium of " + bench.methods[method].name + " on " + mesh_text(mesh) + " was not found";
}

// That of the reference method; on the mesh that is not benchmarked no method was run.
std::string not_found(const Benchmark& bench, const BenchMesh& mesh) {
  return mesh.is_benchmarked ? not_found(bench, 0, mesh)
                             : "the equilibrium on " + mesh_text(mesh) + " was not found";
}

// Why no run has a total error.
std::string why_unknown(const Benchmark& bench) {
  if (bench.is_cancelled) return "the benchmark was cancelled";
  const auto is_converged = [](const BenchRun& run) { return run.status == Status::Converged; };
  if (std::none_of(bench.runs.begin(), bench.runs.end(), is_converged)) return "no run reached its tolerance";
  for (const BenchMesh& mesh : bench.meshes)
    if (!mesh.missing.empty()) return not_found(bench, mesh);
  return "no error is";
}

// Slope of log(time) over log(size). Pre: sizes that differ, two or more.
double slope(const std::vector<double>& sizes, const std::vector<double>& seconds) {
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto count = static_cast<double>(sizes.size());
  for (size_t k = 0; k < sizes.size(); ++k) {
    const double lx = std::log(sizes[k]), ly = std::log(seconds[k]);
    x += lx / count;
    y += ly / count;
    xx += lx * lx / count;
    xy += lx * ly / count;
  }
  return (xy - x * y) / (xx - x * x);
}

}  // namespace

std::optional<double> error_of(const BenchRun& run, ErrorKind kind) {
  if (kind == ErrorKind::Total) return run.errors.total;
  return run.errors.algebraic ? std::optional(run.errors.algebraic->max) : std::nullopt;
}

std::optional<double> factorisations_worth(const Benchmark& bench, const BenchRun& run) {
  const std::optional<double>& unit = bench.meshes[run.mesh].factorisation_s;
  if (!unit || !(*unit > 0)) return std::nullopt;
  return run.cpu.median / *unit;
}

const BenchRun* fastest_run(const Benchmark& bench, ErrorKind kind, double mm, const RunFilter& filter) {
  const BenchRun* fastest = nullptr;
  for (const BenchRun& run : bench.runs) {
    const std::optional<double> error = error_of(run, kind);
    if (!is_asked(run, filter) || !error || !(*error <= mm)) continue;
    if (fastest == nullptr || run.wall.median < fastest->wall.median) fastest = &run;
  }
  return fastest;
}

const BenchRun* most_exact_run(const Benchmark& bench, ErrorKind kind) {
  const BenchRun* exact = nullptr;
  for (const BenchRun& run : bench.runs) {
    const std::optional<double> error = error_of(run, kind);
    if (is_asked(run, {}) && error && (exact == nullptr || *error < *error_of(*exact, kind))) exact = &run;
  }
  return exact;
}

std::optional<Growth> growth(const Benchmark& bench, size_t method) {
  std::optional<Growth> found;
  for (const double tolerance : bench.tolerances) {  // falling: later ones win where they have as many meshes
    std::vector<double> sizes, seconds;
    for (const BenchRun& run : bench.runs) {
      if (!is_asked(run, {.method = method}) || run.tolerance != tolerance || !(run.cpu.best > 0)) continue;
      sizes.push_back(bench.meshes[run.mesh].triangles);
      seconds.push_back(run.cpu.best);
    }
    const int meshes = static_cast<int>(sizes.size());
    if (meshes >= 2 && (!found || meshes >= found->meshes))
      found = Growth{slope(sizes, seconds), tolerance, meshes};
  }
  return found;
}

std::string mesh_text(const BenchMesh& mesh) {
  return mesh.triangles > 0 ? grouped(mesh.triangles) + " triangles" : grouped(mesh.nodes) + " nodes";
}

std::vector<std::string> missing_equilibria(const Benchmark& bench) {
  std::vector<std::string> all;
  for (const BenchMesh& mesh : bench.meshes)
    if (!mesh.missing.empty()) all.push_back(not_found(bench, mesh) + ": " + mesh.missing);
  for (const BenchEnd& end : bench.ends)
    if (end.method > 0 && !end.missing.empty())
      all.push_back(not_found(bench, end.method, bench.meshes[end.mesh]) + ": " + end.missing);
  return all;
}

std::string doubts_of_shown(const Benchmark& bench) {
  return bench.shown ? doubts_in_words(std::span(&bench.shown->standing, 1)) : "";
}

std::vector<std::string> other_equilibria(const Benchmark& bench) {
  std::vector<std::string> all;
  for (const BenchEnd& end : bench.ends)
    if (end.verdict == Verdict::AnotherBranch)
      all.push_back(bench.methods[end.method].name + " on " + mesh_text(bench.meshes[end.mesh]) +
                    " ends in another equilibrium than " + bench.methods.front().name +
                    (end.gap ? ", up to " + page_number(end.gap->same_vertex.max, 3) + " mm apart" : "") +
                    ": its method error is that of the branch");
  if (bench.branches)
    all.push_back("around the equilibrium of " + bench.methods.front().name + " on " +
                  mesh_text(bench.meshes.front()) + ": " + branches_message(*bench.branches));
  return all;
}

std::string recommendation(const Benchmark& bench, double mm) {
  const std::string begin = "for " + page_number(mm) + " mm on this scene: ";
  if (const BenchRun* run = fastest_run(bench, ErrorKind::Total, mm))
    return begin + described(bench, *run) + " (tolerance " + page_number(run->tolerance) + ", error " +
           page_number(*run->errors.total, 2) + " mm)";
  const BenchRun* exact = most_exact_run(bench, ErrorKind::Total);
  if (exact == nullptr) return begin + "not known, as " + why_unknown(bench);
  const RunErrors& errors = exact->errors;
  const bool lacks_mesh = errors.discretisation.value_or(0) > 0.5 * *errors.total;
  return begin + "none of these runs; the most exact is " + described(bench, *exact) + " with an error of " +
         page_number(*errors.total, 2) + " mm, most of it " +
         (lacks_mesh ? "of the mesh: take more --levels" : "not of the mesh: take smaller --tolerances");
}

}  // namespace coapt
