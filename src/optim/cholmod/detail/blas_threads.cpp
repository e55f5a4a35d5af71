#include "optim/cholmod/detail/blas_threads.hpp"

#include "optim/cholmod/cholmod_factorisation.hpp"

#include <dlfcn.h>

// Declared here: where the header that declares them lies differs between distributions.
extern "C" {
void openblas_set_num_threads(int count);
int openblas_get_num_threads();
}

namespace coapt {
namespace detail {

BlasThreads::BlasThreads(int count) : before_(openblas_get_num_threads()) {
  if (before_ != count) openblas_set_num_threads(count);
}

BlasThreads::~BlasThreads() {
  if (openblas_get_num_threads() != before_) openblas_set_num_threads(before_);
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
