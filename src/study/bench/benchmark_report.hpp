// What a benchmark is told as: a table, JSON, and a page to look at. Fields: docs/bench_command.md.
#pragma once

#include "study/bench/benchmark.hpp"

#include <string>

namespace coapt {

// The text of bench.json. Numbers that are not finite or not known are null.
std::string benchmark_json(const Benchmark& bench);

// The text of bench.csv: one row per run, cells empty where there is no number.
std::string benchmark_csv(const Benchmark& bench);

// The text of bench.html: recommendations, error against time, times to an accuracy, meshes and runs. It
// needs nothing but itself.
std::string benchmark_page(const Benchmark& bench);

// Writes bench.json, bench.csv and bench.html. Throws InputError when a file cannot be written.
void write_benchmark(const std::filesystem::path& folder, const Benchmark& bench);

}  // namespace coapt
