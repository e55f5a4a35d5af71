// What a benchmark is told as: a table, JSON, and a page to look at. Fields: docs/bench_command.md.
#pragma once

#include "formats/table.hpp"
#include "study/bench/benchmark.hpp"

#include <span>
#include <string>

namespace coapt {

// The text of bench.json. Numbers that are not finite or not known are null.
std::string benchmark_json(const Benchmark& bench);

// One row for each of some runs of a benchmark: bench.csv but for the column "mesh", and what the page and
// `coapt bench` show.
Table run_table(const Benchmark& bench, std::span<const BenchRun> runs);

// Median wall times to an accuracy, of the fastest run that is good enough; nothing where there is none.
Table times_table(const Benchmark& bench);

// The text of bench.html: recommendations, error against time, times to an accuracy, meshes and runs. It
// needs nothing but itself.
std::string benchmark_page(const Benchmark& bench);

// Writes bench.json, bench.csv and bench.html. Throws InputError when a file cannot be written.
void write_benchmark(const std::filesystem::path& folder, const Benchmark& bench);

}  // namespace coapt
