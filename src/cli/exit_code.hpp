// What the command returns to the shell.
#pragma once

namespace coapt::cli {

enum ExitCode {
  kConverged = 0,     // or: did what was asked
  kNotConverged = 1,  // the result is written all the same
  kBadInput = 2,      // arguments, scene, mesh, or a folder that cannot be written
  kInternal = 3,      // a fault of the program
  kInDoubt = 4        // `solve`: converged, but the state is not stable, or that could not be decided
};

}  // namespace coapt::cli
