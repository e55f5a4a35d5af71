// That a program and the library agree on how Eigen aligns memory. Flags such as -march=native change it:
// what one of them allocates the other frees wrongly, or reads by instructions that want another alignment,
// and EIGEN_MAX_ALIGN_BYTES does not cure it, as Eigen allocates by EIGEN_DEFAULT_ALIGN_BYTES, which follows
// the processor. Part of types.hpp, so that who includes any header of the library learns of it from the
// linker and not from a crash.
#pragma once

#include <Eigen/Core>

namespace coapt {

// True. Defined in the library for the alignments that it was built with [bytes], and for no others: where
// this is an undefined reference, compile the program without its flags for a processor (-march=native,
// -mavx), or the library with them too.
template <int Greatest, int Allocated>
bool library_is_built_for_eigen_alignment();

// Asks the linker, in every program that includes this header.
inline const bool kHasAlignmentOfLibrary =
    library_is_built_for_eigen_alignment<EIGEN_MAX_ALIGN_BYTES, EIGEN_DEFAULT_ALIGN_BYTES>();

}  // namespace coapt
