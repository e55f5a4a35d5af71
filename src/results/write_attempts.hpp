// Several files of which one that cannot be written does not keep the others back.
#pragma once

#include "core/output_error.hpp"

#include <string>
#include <vector>

namespace coapt {

class WriteAttempts {
 public:
  // Calls write(); what it throws, as where its folder is gone, is kept for finish().
  template <typename Write>
  void operator()(const Write& write) {
    try {
      write();
    } catch (const InputError& error) {
      defects_.insert(defects_.end(), error.defects().begin(), error.defects().end());
    }
  }

  // Throws OutputError with all that could not be written.
  void finish() const {
    if (!defects_.empty()) throw OutputError(defects_);
  }

 private:
  std::vector<std::string> defects_;
};

}  // namespace coapt
