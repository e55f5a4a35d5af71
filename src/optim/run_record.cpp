#include "optim/run_record.hpp"

#include "core/number_text.hpp"
#include "linear/last_factor.hpp"
#include "optim/dynamic/dynamic.hpp"
#include "optim/monitor.hpp"

#include <memory>
#include <optional>
#include <utility>

namespace coapt {

namespace {

bool cuts_short(Status status) { return status == Status::Cancelled || status == Status::TimeLimit; }

// Whether what it finds is an equilibrium only by where its velocities take it.
bool depends_on_velocities(const std::string& name, const SolverOptions& options) {
  return name == "xpbd" || (is_dynamic(name) && options.dynamic.collisions != Collisions::None);
}

}  // namespace

// A method that asks the record before it works. Private to the recorder.
class RecordedSolver final : public Solver {
 public:
  using Make = std::function<std::unique_ptr<Solver>()>;

  // last_factor: that its factorisations share; may be null.
  RecordedSolver(Make make, bool has_velocities, std::shared_ptr<LastFactor> last_factor,
                 RunRecorder& recorder)
      : make_(std::move(make)),
        solver_(make_()),
        has_velocities_(has_velocities),
        last_factor_(std::move(last_factor)),
        recorder_(recorder) {}

  std::string_view name() const override { return solver_->name(); }
  bool follows_path() const override { return solver_->follows_path(); }
  bool raises_stress_limits() const override { return solver_->raises_stress_limits(); }
  bool honours_step_limits() const override { return solver_->honours_step_limits(); }
  bool minimises_objective() const override { return solver_->minimises_objective(); }
  bool is_at_rest() const override { return retraced_ ? retraced_->is_at_rest : solver_->is_at_rest(); }

  std::string remark() const override {
    const std::string own = own_remark(), earlier = recorder_.earlier_work();
    return own.empty() || earlier.empty() ? own + earlier : own + "; " + earlier;
  }

  bool takes_motion(const MotionPath& motion) override {
    has_motion_ = solver_->takes_motion(motion);
    return has_motion_;
  }

  Status minimize(Objective& objective, Vector& q, Monitor& monitor) override {
    retraced_.reset();
    const bool had_left = recorder_.has_left_history();
    if (const MinimisationEnd* end = recorder_.next_end(objective))
      return retrace(*end, objective, q, monitor);
    if (last_factor_ && recorder_.has_left_history() != had_left) last_factor_->order = {};  // as recorded
    if (const Vector* iterate = has_velocities_ ? nullptr : recorder_.known_iterate(objective)) {
      if (const auto stop = visit(q, monitor)) return *stop;
      q = *iterate;
    }
    recorder_.begin();
    MinimisationEnd end;
    try {
      end.status = solver_->minimize(objective, q, monitor);
    } catch (...) {
      recorder_.close();
      throw;
    }
    end.x = objective.positions(q);
    end.is_at_rest = solver_->is_at_rest();
    end.remark = own_remark();
    const Status status = end.status;
    recorder_.end(std::move(end), last_factor_ ? last_factor_->order : KeptOrder());
    has_motion_ = false;
    return status;
  }

 private:
  std::string own_remark() const { return retraced_ ? retraced_->remark : solver_->remark(); }

  // Accepts a state of the history. Returns why the run is cut short there, if it is.
  std::optional<Status> visit(const Vector& q, Monitor& monitor) {
    Vector g;
    const double energy = monitor.gradient(q, g);
    const std::optional<Status> status = monitor.accept(q, energy, g);
    if (!status || !cuts_short(*status)) return std::nullopt;
    recorder_.cut_short();
    return status;
  }

  Status retrace(const MinimisationEnd& end, Objective& objective, Vector& q, Monitor& monitor) {
    if (const auto stop = visit(q, monitor)) return *stop;
    objective.prescribe(end.x);
    q = objective.unknowns(end.x);
    if (const auto stop = visit(q, monitor)) return *stop;
    if (std::exchange(has_motion_, false)) solver_ = make_();  // the motion is over
    if (const KeptOrder* order = last_factor_ ? recorder_.next_order() : nullptr)
      last_factor_->order = *order;
    retraced_ = {Points(), end.status, end.is_at_rest, end.remark};
    return end.status;
  }

  Make make_;
  std::unique_ptr<Solver> solver_;
  bool has_velocities_, has_motion_ = false;
  std::shared_ptr<LastFactor> last_factor_;
  RunRecorder& recorder_;
  std::optional<MinimisationEnd> retraced_;  // of the last minimisation, without its positions
};

RunRecorder::RunRecorder(RunRecord known, double every, Keep keep)
    : record_(std::move(known)),
      every_(every),
      start_(wall_seconds()),
      last_kept_(start_),
      seconds_before_(record_.seconds),
      iterations_before_(record_.iterations),
      keep_(std::move(keep)) {}

SolverTable RunRecorder::recorded(const SolverTable& table) {
  SolverTable result;
  for (const auto& [name, make] : table)
    result[name] = [this, name = name, make = make](const SolverOptions& options) {
      return std::make_unique<RecordedSolver>([make, options] { return make(options); },
                                              depends_on_velocities(name, options), options.last_factor,
                                              *this);
    };
  return result;
}

Observer RunRecorder::recorded(Observer next) {
  return [this, next = std::move(next)](const Iteration& iteration, const Vector& q) {
    if (is_recording_ && !is_closed_) {
      record_.iterate = q;
      ++record_.iterations;
      keep_in_time();
    }
    return !next || next(iteration, q);
  };
}

const RunRecord& RunRecorder::record() {
  record_.seconds = seconds_before_ + wall_seconds() - start_;
  return record_;
}

std::string RunRecorder::earlier_work() const {
  if (iterations_before_ == 0) return {};
  return "taken up again after " + std::to_string(iterations_before_) + " iterates in " +
         number_text(seconds_before_) + " s";
}

const MinimisationEnd* RunRecorder::next_end(const Objective& objective) {
  if (is_closed_ || next_ >= record_.ends.size()) return nullptr;
  const MinimisationEnd& end = record_.ends[next_];
  if (end.x.cols() == objective.node_count()) {
    ++next_;
    return &end;
  }
  has_left_history_ = true;
  record_.ends.resize(next_);
  record_.order = {};
  record_.iterate.resize(0);
  return nullptr;
}

const KeptOrder* RunRecorder::next_order() const {
  return next_ == record_.ends.size() ? &record_.order : nullptr;
}

const Vector* RunRecorder::known_iterate(const Objective& objective) {
  const bool is_known =
      !is_closed_ && record_.iterate.size() > 0 && record_.iterate.size() == objective.unknown_count();
  return is_known ? &record_.iterate : nullptr;
}

void RunRecorder::begin() {
  is_recording_ = !is_closed_;
  if (is_recording_) keep_in_time();
}

void RunRecorder::end(MinimisationEnd end, KeptOrder order) {
  if (!std::exchange(is_recording_, false)) return;
  if (cuts_short(end.status)) return cut_short();
  record_.ends.push_back(std::move(end));
  record_.order = std::move(order);
  record_.iterate.resize(0);
  ++next_;
  keep_in_time();
}

void RunRecorder::cut_short() { is_closed_ = is_cut_short_ = true; }

void RunRecorder::keep_in_time() {
  const double now = wall_seconds();
  if (now - last_kept_ < every_ || !keep_) return;
  keep_(record());
  last_kept_ = wall_seconds();
}

}  // namespace coapt
