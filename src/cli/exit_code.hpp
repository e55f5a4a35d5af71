// What the command returns to the shell.
#pragma once

#include <string>
#include <vector>

namespace coapt::cli {

inline constexpr int kConverged = 0;  // or: did what was asked
inline constexpr int kNotConverged =
    1;                                // or: found that it does not hold; the result is written all the same
inline constexpr int kBadInput = 2;   // arguments, scene, mesh, or a folder that cannot be used
inline constexpr int kInternal = 3;   // a fault of the program, or too little memory
inline constexpr int kInDoubt = 4;    // converged, but the stability of a result is in doubt: is_in_doubt()
inline constexpr int kUnwritten = 5;  // what was computed could not be written: a full disk

// Of a command that solves several times: the first of the codes 1 and 4 that one of its results has.
// doubts: of each result that it tells of, see doubts() in results/result_warnings.hpp.
int exit_code_of(bool has_converged, const std::vector<std::vector<std::string>>& doubts);

}  // namespace coapt::cli
