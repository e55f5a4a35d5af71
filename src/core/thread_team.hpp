// Threads that share the parts of a piece of work, and sleep in between.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace coapt {

// Processors that this process may run on, at least 1.
int available_processors();

// The caller of run() is one of the threads. Threads start with the first work that is worth sharing.
class ThreadTeam {
 public:
  explicit ThreadTeam(int size = 1) : size_(size < 1 ? 1 : size) {}
  ~ThreadTeam();
  ThreadTeam(const ThreadTeam&) = delete;
  ThreadTeam& operator=(const ThreadTeam&) = delete;

  int size() const { return size_; }

  // work(part, thread), 0 <= thread < size().
  using Work = std::function<void(int part, int thread)>;

  // Calls work for every part, 0 <= part < count, once, in any order and side by side, and returns when all
  // are done. Results do not depend on the number of threads if each part writes what is its own alone.
  // What work throws is thrown here, once the others have ended. It must not run anything by the same team.
  void run(int count, const Work& work);

  // Cuts [0, count) into ranges of about `grain` and calls work(first, last) for each, in the same way.
  template <class RangeWork>
  void run_ranges(size_t count, size_t grain, const RangeWork& work) {
    if (count == 0) return;
    const size_t parts = size_ == 1 ? 1 : (count + grain - 1) / grain;
    if (parts == 1) return work(size_t{0}, count);
    run(static_cast<int>(parts), [&](int part, int) {
      const auto k = static_cast<size_t>(part);
      work(count * k / parts, count * (k + 1) / parts);
    });
  }

 private:
  void start();
  bool is_copy() const;  // of a process that had the threads
  void serve(int thread);
  void take_parts(const Work& work, int count, int thread);

  const int size_;
  std::vector<std::jthread> others_;
  long process_ = 0;  // that they belong to
  std::mutex mutex_;
  std::condition_variable begins_, ends_;
  const Work* work_ = nullptr;  // what is to be done; null: nothing, or all parts are taken
  int count_ = 0, next_ = 0;    // of its parts; the first that nobody has taken
  int busy_ = 0;                // others that are at work
  bool closes_ = false;
};

}  // namespace coapt
