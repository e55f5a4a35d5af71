// Whether this build carries sanitizers, which make it some ten times slower: tests then leave out their
// heaviest refinement levels.
#pragma once

namespace coapt {

constexpr bool is_sanitized() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  return true;
#else
  return false;
#endif
}

}  // namespace coapt
