// Private to this room: four numbers side by side, and code for the processor at hand, with vectors of four
// and fused multiplication where it has them.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__)
#define COAPT_WIDE __attribute__((target("avx2,fma")))
#define COAPT_INLINE inline __attribute__((always_inline))
#else
#define COAPT_INLINE inline
#endif

namespace coapt {

// Anywhere in memory.
using Quad = double __attribute__((vector_size(32)));
COAPT_INLINE void load(Quad& quad, const double* from) { __builtin_memcpy(&quad, from, sizeof quad); }
COAPT_INLINE void store(double* to, const Quad& quad) { __builtin_memcpy(to, &quad, sizeof quad); }

#ifdef COAPT_WIDE
inline bool is_wide() {
  static const bool kIsWide = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  return kIsWide;
}
#endif

}  // namespace coapt
