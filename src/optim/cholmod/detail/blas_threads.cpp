#include "optim/cholmod/detail/blas_threads.hpp"

#include "optim/cholmod/cholmod_factorisation.hpp"

#include <dlfcn.h>
#include <mutex>

// Declared here: where the header that declares them lies differs between distributions.
extern "C" {
void openblas_set_num_threads(int count);
int openblas_get_num_threads();
}

namespace coapt {
namespace detail {

namespace {

// OpenBLAS knows one number for the process. It is put back when the last scope that set it ends: not sooner,
// or a scope in another thread would go on with the number from before, and differ in its last bits.
struct Shared {
  std::mutex mutex;
  int scopes = 0, before = 0, levels_before = 0;
};

// CHOLMOD copies each supernode in an OpenMP region of four threads, whose waking costs more than twice what
// the factorisation does. With no active level its regions run in the caller's thread. Looked up, not linked:
// a CHOLMOD without OpenMP brings no such library along.
using SetLevels = void (*)(int);
using GetLevels = int (*)();

SetLevels set_openmp_levels() {
  static const auto kFunction = reinterpret_cast<SetLevels>(dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"));
  return kFunction;
}

GetLevels get_openmp_levels() {
  static const auto kFunction = reinterpret_cast<GetLevels>(dlsym(RTLD_DEFAULT, "omp_get_max_active_levels"));
  return kFunction;
}

bool has_openmp() { return set_openmp_levels() != nullptr && get_openmp_levels() != nullptr; }

Shared& shared() {
  static Shared instance;
  return instance;
}

}  // namespace

BlasThreads::BlasThreads(int count) {
  Shared& all = shared();
  const std::lock_guard lock(all.mutex);
  if (all.scopes++ == 0) {
    all.before = openblas_get_num_threads();
    if (has_openmp()) {
      all.levels_before = get_openmp_levels()();
      set_openmp_levels()(0);
    }
  }
  if (openblas_get_num_threads() != count) openblas_set_num_threads(count);
}

BlasThreads::~BlasThreads() {
  Shared& all = shared();
  const std::lock_guard lock(all.mutex);
  if (--all.scopes > 0) return;
  if (openblas_get_num_threads() != all.before) openblas_set_num_threads(all.before);
  if (has_openmp()) set_openmp_levels()(all.levels_before);
}

}  // namespace detail

std::string blas_library() {
  Dl_info info;
  const void* kernel = dlsym(RTLD_DEFAULT, "dgemm_");  // the search that the loader makes for CHOLMOD
  if (kernel == nullptr || dladdr(kernel, &info) == 0) return "";
  const std::string path = info.dli_fname;
  return path.substr(path.rfind('/') + 1);
}

}  // namespace coapt
