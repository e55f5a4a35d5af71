// The standard output as commands print on it for people, and as programs read it.
#pragma once

#include <string>
#include <vector>

namespace coapt::cli {

// Where text goes that is not wanted on the standard output.
enum class TextPlace { Nowhere, StandardError };

// Commands print their text whoever asked; for --json and --quiet it is turned away before they begin. A
// process has one of these.
class TextOutput {
 public:
  TextOutput() = default;
  TextOutput(const TextOutput&) = delete;
  TextOutput& operator=(const TextOutput&) = delete;
  ~TextOutput() { restore(); }

  // From now on what is written to the standard output goes there instead.
  void turn_away(TextPlace place);

  // Gives the standard output back. False where what was printed before did not all arrive, as on a full
  // disk.
  bool restore();

 private:
  int kept_ = -1;  // the standard output; -1: not turned away
};

// Prints it and says whether it has arrived.
bool print_document(const std::string& document);

// {"error": [defects]}, one line.
std::string error_document(const std::vector<std::string>& defects);

}  // namespace coapt::cli
