// Exceptions are for the caller's mistakes; a solver that does not converge returns a Status.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace coapt {

// The input (file, scene, argument) cannot be used. Carries every defect that one pass found;
// each names the file, the key or element, the reason and, where there is one, the remedy.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& defect) : InputError(std::vector<std::string>{defect}) {}

  // Pre: at least one defect.
  explicit InputError(std::vector<std::string> defects)
      : std::runtime_error(join(defects)), defects_(std::move(defects)) {}

  const std::vector<std::string>& defects() const { return defects_; }

  // The same defects, each after "`where`: ", for what was found without knowing the file it came from.
  InputError within(const std::string& where) const {
    std::vector<std::string> placed;
    for (const std::string& defect : defects_) placed.push_back(where + ": " + defect);
    return InputError(std::move(placed));
  }

 private:
  static std::string join(const std::vector<std::string>& defects) {
    std::string text;
    for (const std::string& defect : defects) text += (text.empty() ? "" : "\n") + defect;
    return text;
  }

  std::vector<std::string> defects_;
};

}  // namespace coapt
