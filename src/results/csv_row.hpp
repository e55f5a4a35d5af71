// A line of a CSV file, some of whose numbers are not there.
#pragma once

#include "formats/csv_table.hpp"
#include "results/reference_distance.hpp"

#include <cmath>
#include <optional>
#include <ostream>

namespace coapt {

class Row {
 public:
  explicit Row(std::ostream& out) : out_(out) {}
  void text(const std::string& text) { cell() << csv_text(text); }
  void count(long number) { cell() << number; }
  void number(const std::optional<double>& value) {
    cell();
    if (value && std::isfinite(*value)) out_ << *value;
  }
  void distance(const DistanceFigures* figures) {
    number(figures ? std::optional(figures->mean) : std::nullopt);
    number(figures ? std::optional(figures->p95) : std::nullopt);
    number(figures ? std::optional(figures->max) : std::nullopt);
  }

 private:
  std::ostream& cell() {
    if (!is_first_) out_ << ',';
    is_first_ = false;
    return out_;
  }
  std::ostream& out_;
  bool is_first_ = true;
};

}  // namespace coapt
