// What the command returns to the shell.
#pragma once

namespace coapt::cli {

inline constexpr int kConverged = 0;     // or: did what was asked
inline constexpr int kNotConverged = 1;  // the result is written all the same
inline constexpr int kBadInput = 2;      // arguments, scene, mesh, or a folder that cannot be used
inline constexpr int kInternal = 3;      // a fault of the program, or too little memory
// `solve`: converged, but is_in_doubt() (results/result_warnings.hpp)
inline constexpr int kInDoubt = 4;
inline constexpr int kUnwritten = 5;  // what was computed could not be written: a full disk

}  // namespace coapt::cli
