// What a stability matrix is told as: JSON, a table, and a page to look at. Fields: docs/stress.md.
#pragma once

#include "formats/table.hpp"
#include "stress/stress.hpp"

#include <span>
#include <string>

namespace coapt {

// The text of stress.json. Numbers that are not finite are null.
std::string stress_json(const StressMatrix& matrix);

// One row for each of some results: stress.csv, and what the page and `coapt stress` show.
Table stress_table(std::span<const StressResult> results);

// The text of stress.html.
std::string stress_page(const StressMatrix& matrix);

// "93 rows: 88 pass, 2 stall honestly, 3 do not apply".
std::string stress_summary(const StressMatrix& matrix);

// Writes stress.json, stress.csv and stress.html. Throws InputError when a file cannot be written.
void write_stress(const std::filesystem::path& folder, const StressMatrix& matrix);

}  // namespace coapt
