#include "core/thread_team.hpp"

#include <algorithm>
#include <exception>

#ifdef __linux__
#include <sched.h>
#endif
#ifndef _WIN32
#include <unistd.h>
#endif

namespace coapt {
namespace {

// Of threads that are not there after fork().
void forget(std::vector<std::jthread>& threads) {
  for (std::jthread& thread : threads) thread.detach();
  threads.clear();
}

}  // namespace

int available_processors() {
#ifdef __linux__
  cpu_set_t set;
  if (sched_getaffinity(0, sizeof set, &set) == 0) return std::max(1, CPU_COUNT(&set));
#endif
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

bool ThreadTeam::is_copy() const {
#ifndef _WIN32
  return !others_.empty() && process_ != getpid();
#else
  return false;
#endif
}

ThreadTeam::~ThreadTeam() {
  if (is_copy()) forget(others_);
  {
    const std::lock_guard lock(mutex_);
    closes_ = true;
  }
  begins_.notify_all();
  others_.clear();  // joins them while what they wait for is still there
}

void ThreadTeam::start() {
#ifndef _WIN32
  process_ = getpid();
#endif
  try {
    for (int thread = 1; thread < size_; ++thread) others_.emplace_back([this, thread] { serve(thread); });
  } catch (const std::system_error&) {
    // No more threads to be had: those there are do the work.
  }
}

void ThreadTeam::run(int count, const Work& work) {
  if (size_ == 1 || count <= 1) {
    for (int part = 0; part < count; ++part) work(part, 0);
    return;
  }
  if (is_copy()) forget(others_);
  if (others_.empty()) start();
  std::exception_ptr failure;
  const Work kept = [&](int part, int thread) {
    try {
      work(part, thread);
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    const std::lock_guard lock(mutex_);
    work_ = &kept;
    count_ = count;
    next_ = 0;
  }
  begins_.notify_all();
  take_parts(kept, count, 0);
  {
    std::unique_lock lock(mutex_);
    work_ = nullptr;
    ends_.wait(lock, [this] { return busy_ == 0; });
  }
  if (failure) std::rethrow_exception(failure);
}

void ThreadTeam::take_parts(const Work& work, int count, int thread) {
  while (true) {
    int part = 0;
    {
      const std::lock_guard lock(mutex_);
      part = next_++;
    }
    if (part >= count) return;
    work(part, thread);
  }
}

void ThreadTeam::serve(int thread) {
  std::unique_lock lock(mutex_);
  while (true) {
    begins_.wait(lock, [this] { return closes_ || (work_ != nullptr && next_ < count_); });
    if (closes_) return;
    ++busy_;
    const Work& work = *work_;
    const int count = count_;
    lock.unlock();
    take_parts(work, count, thread);
    lock.lock();
    if (--busy_ == 0) ends_.notify_one();
  }
}

}  // namespace coapt
