// What every fuzzer is made of: a target that takes bytes, and an engine that makes them. The engines are
// libFuzzer (libfuzzer_entry.cpp, preset `fuzz`) and, in every build, a fixed sequence of damaged seeds
// (replay.cpp).
#pragma once

#include "core/error.hpp"

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace coapt::fuzz {

// Defined once in each fuzzer. Takes the bytes as a file of its kind. InputError is a good answer to them;
// any other exception, a signal or a report of a sanitizer is a defect.
void run_target(std::string_view bytes);

// What was read is not what the reader promises, or what was solved not what the solver does.
class Defect : public std::logic_error {
  using std::logic_error::logic_error;
};

inline void require(bool holds, const std::string& promise) {
  if (!holds) throw Defect("broken promise: " + promise);
}

// Lets each of several readers try; refuses, as "neither ...", what none of them takes.
inline void try_each(const std::vector<std::function<void()>>& readers, const std::string& neither) {
  bool is_read = false;
  for (const auto& read : readers) try {
      read();
      is_read = true;
    } catch (const InputError& error) {
      require(!error.defects().empty(), "a refusal has a reason");
    }
  if (!is_read) throw InputError("input: neither " + neither);
}

// For readers that take a path: a folder of this process, gone with it.
class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  // Throws std::runtime_error when the disk is full.
  std::filesystem::path write(const std::string& name, std::string_view bytes) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace coapt::fuzz
