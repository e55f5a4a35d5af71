#include "core/alignment.hpp"

namespace coapt {

template <int Greatest, int Allocated>
bool library_is_built_for_eigen_alignment() {
  return true;
}

template bool library_is_built_for_eigen_alignment<EIGEN_MAX_ALIGN_BYTES, EIGEN_DEFAULT_ALIGN_BYTES>();

}  // namespace coapt
