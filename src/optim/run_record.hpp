// A run that can be taken up again: where each of its minimisations ended, and how to go the same way twice.
#pragma once

#include "linear/updated_order.hpp"
#include "optim/solver.hpp"

#include <functional>
#include <string>
#include <vector>

namespace coapt {

// How one Solver::minimize() ended: of a step of the path, a round of the loads, a mesh of a cascade.
struct MinimisationEnd {
  Points x;  // 3 x node_count, prescribed nodes included [length]
  Status status = Status::Converged;
  bool is_at_rest = true;
  std::string remark;
};

struct RunRecord {
  std::vector<MinimisationEnd> ends;  // in the order of the run
  KeptOrder order;                    // of elimination, as the last of these left it to what follows
  Vector iterate;       // unknowns of the last accepted iterate of the minimisation after these; may be empty
  long iterations = 0;  // accepted iterates over all sessions of the run
  double seconds = 0;   // wall time, likewise
};

// Writes the record of a run while it goes on, and leads a run along the record of an earlier session. As
// everything between two minimisations (motion, loads, renewed potentials, stiffened contact, coarser meshes)
// follows from where the ones before ended, and from the order of elimination that they left, a run that
// takes those ends from the record goes the same way to the last bit without the work. The minimisation that
// was cut short goes on from its last iterate, with the memory of the method lost: where there are several
// equilibria nearby, it may come to another one. A record without that iterate, and a method whose outcome
// depends on velocities (xpbd, dynamic with collisions), begin it anew and end where they would have. The
// minimisations of a recorded run follow each other: it may hold several solves, in an order that is always
// the same, but none side by side.
class RunRecorder {
 public:
  using Keep = std::function<void(const RunRecord&)>;

  // known: of an earlier session, empty at the first. keep: called with the record so far when a
  // minimisation begins, ends or accepts an iterate and `every` [s] have passed since the last call; what it
  // throws ends the run, so it had better not.
  RunRecorder(RunRecord known, double every, Keep keep);
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  // The same methods, recorded; their remark says what earlier sessions did, as the counts and times of a
  // result are those of its own session. The recorder must outlive the solvers made from the table.
  SolverTable recorded(const SolverTable& table);

  // Both the solvers and the observer of a run have to be recorded. next: may be empty.
  Observer recorded(Observer next);

  const RunRecord& record();

  // Whether a minimisation was cancelled or ran out of time: what follows it is no longer recorded.
  bool is_cut_short() const { return is_cut_short_; }

  // Whether the run did not fit its known record, which was dropped from there on.
  bool has_left_history() const { return has_left_history_; }

 private:
  friend class RecordedSolver;

  std::string earlier_work() const;  // in words; empty at the first session
  const MinimisationEnd* next_end(
      const Objective& objective);      // of the minimisation that begins; may be null
  const KeptOrder* next_order() const;  // that the minimisation so ended left; null before the last known
  const Vector* known_iterate(const Objective& objective);  // of it; may be null
  void begin();
  void end(MinimisationEnd end, KeptOrder order);
  void close() { is_closed_ = true; }
  void cut_short();
  void keep_in_time();

  RunRecord record_;
  double every_, start_, last_kept_;
  double seconds_before_;
  long iterations_before_;
  Keep keep_;
  size_t next_ = 0;            // minimisation
  bool is_recording_ = false;  // one that is going on
  bool is_closed_ = false;     // nothing more is recorded or taken from the record
  bool is_cut_short_ = false, has_left_history_ = false;
};

}  // namespace coapt
