// What a comparison of methods is told as: a table, JSON, and a page to look at. Fields: docs/studies.md.
#pragma once

#include "study/comparison.hpp"

#include <string>

namespace coapt {

// The text of compare.json. Numbers that are not finite are null.
std::string comparison_json(const Comparison& comparison);

// The text of compare.csv: one row per method, cells empty where there is no number.
std::string comparison_csv(const Comparison& comparison);

// The text of report.html: tables, error against run time, and the closed shape of every method, coloured by
// its distance to the reference's. It needs nothing but itself.
std::string comparison_page(const Comparison& comparison);

// Writes compare.json, compare.csv and report.html. Throws InputError when a file cannot be written.
void write_comparison(const std::filesystem::path& folder, const Comparison& comparison);

}  // namespace coapt
