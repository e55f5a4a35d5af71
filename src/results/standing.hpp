// What is said of one result among others. Every page, table and line of several results says it by these
// functions, so that a state which is in doubt stands nowhere as plainly converged.
#pragma once

#include "results/results.hpp"

#include <span>
#include <string>
#include <vector>

namespace coapt {

struct Standing {
  std::string name = {};                 // of the state, the method or the point
  std::string status = {};               // status_name(), "refused" or "failed"
  std::string message = {};              // the headline, or why there is no result
  std::vector<std::string> doubts = {};  // see doubts()

  bool has_converged() const;
  bool is_plain() const { return has_converged() && doubts.empty(); }
};

Standing standing(const std::string& name, const Report& report);

// doubts() of a solve of which no report is kept; what is known of other equilibria is not among them.
std::vector<std::string> doubts(const Model& model, const Result& result, const Fields& fields,
                                const Metrics& metrics);

// Clauses with semicolons between them.
std::string joined_doubts(const std::vector<std::string>& doubts);

// "converged", "converged, in doubt", or the status of one that did not converge.
std::string shown_status(const Standing& of);

// "before and after are in doubt: the valve stands open: ..."; the clauses are those of the first. Empty
// where no result that converged is in doubt.
std::string doubts_in_words(std::span<const Standing> all);

}  // namespace coapt
