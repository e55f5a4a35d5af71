// Rest lengths of chords and other lines as a parameter.
#pragma once

#include "sensitivity/parameters/line_access.hpp"
#include "sensitivity/parameters/parameter.hpp"

#include <vector>

namespace coapt {

// What each number stands for.
enum class LengthMeasure {
  Length,  // the rest length of every line of its group [length]
  Change,  // what is added to the rest lengths of its group as they were when the parameter was made [length]
  Factor   // on those lengths
};

// One number for each group of lines of a term, by element; lines in no group keep their lengths. Changes
// leave cross-sections and moduli as they are: a shorter chord is stiffer. The value begins as the mean
// length, 0 or 1. A length must stay positive, and the term must outlive the parameter.
// Throws InputError, all defects in one pass: a term whose lines have no rest length, an element out of range
// or in two groups, an empty group, lines of different lengths in a group measured by Length.
std::unique_ptr<Parameter> make_line_lengths(std::string name, EnergyTerm& term,
                                             std::vector<std::vector<int>> groups, LengthMeasure measure);

// Each line of a term by itself, measured by Length.
std::vector<std::vector<int>> single_lines(const EnergyTerm& term);

// All lines of a term as one group.
std::vector<std::vector<int>> all_lines(const EnergyTerm& term);

}  // namespace coapt
