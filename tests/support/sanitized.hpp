// Whether this build carries sanitizers, which make it some ten times slower: tests then leave out their
// heaviest refinement levels.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // GCC
#define COAPT_IS_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)  // Clang
#define COAPT_IS_SANITIZED 1
#endif
#endif
#ifndef COAPT_IS_SANITIZED
#define COAPT_IS_SANITIZED 0
#endif

namespace coapt {

constexpr bool is_sanitized() { return COAPT_IS_SANITIZED == 1; }

}  // namespace coapt
