// Four or eight numbers side by side, and code for the processor at hand, with such vectors and fused
// multiplication where it has them.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__)
#define COAPT_WIDE __attribute__((target("avx2,fma")))
#define COAPT_WIDEST __attribute__((target("avx512f,avx512vl,avx2,fma")))
#define COAPT_INLINE inline __attribute__((always_inline))
#else
#define COAPT_INLINE inline
#endif

namespace coapt {

// Anywhere in memory.
using Quad = double __attribute__((vector_size(32)));
using Octet = double __attribute__((vector_size(64)));
template <class Vector>
COAPT_INLINE void load(Vector& vector, const double* from) {
  __builtin_memcpy(&vector, from, sizeof vector);
}
template <class Vector>
COAPT_INLINE void store(double* to, const Vector& vector) {
  __builtin_memcpy(to, &vector, sizeof vector);
}

#ifdef COAPT_WIDE
inline bool is_wide() {
  static const bool kIsWide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return kIsWide;
}
inline bool is_widest() {
  static const bool kIsWidest =
      is_wide() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl");
  return kIsWidest;
}
#endif

}  // namespace coapt
