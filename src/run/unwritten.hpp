// Results of a solve that could not all be written: they come with the error, so that nothing that was
// computed is lost.
#pragma once

#include "core/output_error.hpp"
#include "run/run.hpp"

#include <memory>
#include <utility>

namespace coapt {

// From write_run() and what writes by it.
class UnwrittenReport : public OutputError {
 public:
  UnwrittenReport(const OutputError& error, Report report)
      : OutputError(error.defects()), report_(std::make_shared<Report>(std::move(report))) {}

  Report& report() const { return *report_; }

 private:
  std::shared_ptr<Report> report_;
};

// From run() of a scene and run_to_accuracy().
class UnwrittenRun : public OutputError {
 public:
  UnwrittenRun(const OutputError& error, RunReport run)
      : OutputError(error.defects()), run_(std::make_shared<RunReport>(std::move(run))) {}

  RunReport& run() const { return *run_; }

 private:
  std::shared_ptr<RunReport> run_;
};

}  // namespace coapt
