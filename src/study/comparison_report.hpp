// What a comparison of methods is told as: a table, JSON, and a page to look at. Fields: docs/studies.md.
#pragma once

#include "formats/table.hpp"
#include "results/standing.hpp"
#include "study/comparison.hpp"

#include <span>
#include <string>

namespace coapt {

Standing standing(const ComparedMethod& method);

// The text of compare.json. Numbers that are not finite are null.
std::string comparison_json(const Comparison& comparison);

// One row for each method: compare.csv, and what the page and `coapt compare` show.
Table comparison_table(std::span<const ComparedMethod> methods);

// The text of compare.html: tables, error against run time, and the closed shape of every method, coloured by
// its distance to the reference's. It needs nothing but itself.
std::string comparison_page(const Comparison& comparison);

// Writes compare.json, compare.csv and compare.html. Throws InputError when a file cannot be written.
void write_comparison(const std::filesystem::path& folder, const Comparison& comparison);

}  // namespace coapt
