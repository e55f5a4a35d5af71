#include "cli/solve_checkpoint.hpp"

#include "cli/command_line.hpp"
#include "core/error.hpp"

#include <cstdio>

namespace coapt::cli {
namespace {

bool is_empty(const RunRecord& record) { return record.ends.empty() && record.iterate.size() == 0; }

}  // namespace

void add_solve_checkpoint_arguments(CLI::App& command, SolveCheckpointArguments& arguments) {
  auto* resume = add_checkpoint_arguments(command, arguments, "run", 60);
  command
      .add_flag(
          "--exactly", arguments.is_exact,
          "With --resume: begin the minimisation that was cut short anew, which gives the same result to "
          "the last bit also where a scene has several equilibria")
      ->needs(resume);
}

SolveCheckpoint::SolveCheckpoint(const SolveCheckpointArguments& arguments, const RunIdentity& identity)
    : file_(arguments, "run", "solve"), identity_(identity) {
  if (const auto defect = file_.defect()) throw InputError(*defect);
  RunRecord known;
  if (!arguments.resumed.empty()) known = read_checkpoint(arguments.resumed, identity);
  if (arguments.is_exact) known.iterate.resize(0);
  write_checkpoint(file_.path(), identity, known);
  if (!is_empty(known))
    std::printf("resumed after %zu minimisations and %ld iterates in %.3g s\n", known.ends.size(),
                known.iterations, known.seconds);
  recorder_.emplace(std::move(known), arguments.every, [this](const RunRecord& record) { keep(record); });
}

SolveCheckpoint::~SolveCheckpoint() {
  if (is_finished_) return;
  if (is_empty(recorder_->record()))
    file_.remove();
  else
    keep(recorder_->record());
}

void SolveCheckpoint::keep(const RunRecord& record) {
  file_.keep([&](const std::filesystem::path& path) { write_checkpoint(path, identity_, record); });
}

void SolveCheckpoint::finish(const std::string& scene, bool is_written) {
  is_finished_ = true;
  if (recorder_->has_left_history())
    std::printf(
        "  warning: the run departed from the history in its checkpoint, and was solved anew from there\n");
  if (!recorder_->is_cut_short() && is_written) return file_.remove();
  keep(recorder_->record());
  file_.print_how_to_go_on(scene);
}

}  // namespace coapt::cli
