#include "cli/checkpointing.hpp"

#include "cli/study_options.hpp"
#include "core/error.hpp"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <system_error>

namespace coapt::cli {
namespace {

namespace fs = std::filesystem;

bool is_empty(const RunRecord& record) { return record.ends.empty() && record.iterate.size() == 0; }

}  // namespace

void add_checkpoint_arguments(CLI::App& command, CheckpointArguments& arguments) {
  command.add_option("--checkpoint", arguments.file,
                     "Keep the run in this file while it goes on, for --resume; removed when it is through");
  command
      .add_option("--checkpoint-every", arguments.every,
                  "Seconds from one checkpoint to the next (default: 60)")
      ->check(positive_defect);
  auto* resume =
      command.add_option("--resume", arguments.resumed,
                         "Go on with the run that this file keeps, and keep it there (or in --checkpoint)");
  command
      .add_flag(
          "--exactly", arguments.is_exact,
          "With --resume: begin the minimisation that was cut short anew, which gives the same result to "
          "the last bit also where a scene has several equilibria")
      ->needs(resume);
}

Checkpointing::Checkpointing(const CheckpointArguments& arguments, const RunIdentity& identity)
    : file_(arguments.file.empty() ? arguments.resumed : arguments.file), identity_(identity) {
  std::error_code error;
  const bool is_same = !arguments.resumed.empty() &&
                       (file_ == arguments.resumed || fs::equivalent(file_, arguments.resumed, error));
  if (!is_same && fs::exists(file_, error))
    throw InputError(file_.string() + ": is there already; go on with the run that it keeps by --resume " +
                     file_.string() + ", or remove it");
  RunRecord known;
  if (!arguments.resumed.empty()) known = read_checkpoint(arguments.resumed, identity);
  if (arguments.is_exact) known.iterate.resize(0);
  write_checkpoint(file_, identity, known);
  if (!is_empty(known))
    std::printf("resumed after %zu minimisations and %ld iterates in %.3g s\n", known.ends.size(),
                known.iterations, known.seconds);
  recorder_.emplace(std::move(known), arguments.every, [this](const RunRecord& record) { keep(record); });
}

Checkpointing::~Checkpointing() {
  if (is_finished_) return;
  std::error_code ignored;
  if (is_empty(recorder_->record()))
    fs::remove(file_, ignored);
  else
    keep(recorder_->record());
}

void Checkpointing::keep(const RunRecord& record) {
  try {
    write_checkpoint(file_, identity_, record);
    failure_.clear();
  } catch (const InputError& error) {
    failure_ = error.what();
  }
}

void Checkpointing::finish(const std::string& scene) {
  is_finished_ = true;
  if (recorder_->has_left_the_way())
    std::printf("  warning: the run left the way that its checkpoint knew, and was solved anew from there\n");
  if (!recorder_->is_cut_short()) {
    std::error_code ignored;
    fs::remove(file_, ignored);
    return;
  }
  keep(recorder_->record());
  if (failure_.empty())
    std::printf("go on with the same options and: coapt solve %s --resume %s\n", scene.c_str(),
                file_.string().c_str());
  else
    std::printf("  warning: the run could not be kept: %s\n", failure_.c_str());
}

}  // namespace coapt::cli
