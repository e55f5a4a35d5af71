// Gathers what is wrong with one file, so that it can be said in one go.
#pragma once

#include "core/error.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace coapt::formats {

class Defects {
 public:
  explicit Defects(std::string file) : file_(std::move(file)) {}

  void add(const std::string& what) {
    if (listed_.size() < kListed) listed_.push_back(file_ + ": " + what);
    ++count_;
  }
  void add(const std::string& unit, long long number, const std::string& what) {
    if (listed_.size() < kListed)
      add(unit + " " + std::to_string(number) + ": " + what);
    else
      ++count_;
  }
  [[noreturn]] void fail(const std::string& what) {
    add(what);
    raise();
  }

  bool any() const { return count_ > 0; }
  const std::string& file() const { return file_; }

  void throw_if_any() const {
    if (any()) raise();
  }

 private:
  static constexpr size_t kListed = 20;

  [[noreturn]] void raise() const {
    std::vector<std::string> all = listed_;
    if (count_ > listed_.size())
      all.push_back(file_ + ": and " + std::to_string(count_ - listed_.size()) + " more");
    throw InputError(all);
  }

  std::string file_;
  std::vector<std::string> listed_;
  size_t count_ = 0;
};

}  // namespace coapt::formats
