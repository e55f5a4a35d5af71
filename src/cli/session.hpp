// What every command is told beside its own options, and what it leaves.
#pragma once

#include "cli/exit_code.hpp"

#include <string>

namespace coapt::cli {

struct Session {
  bool prints_json = false;  // --json: the document alone on the standard output
  bool is_quiet = false;     // --quiet: nothing there, and no progress
  bool is_verbose = false;   // --verbose: a line of progress for every iterate
  int exit_code = kConverged;
  std::string document = {};  // JSON: what was found; commands print text all the same, see TextOutput
};

}  // namespace coapt::cli
