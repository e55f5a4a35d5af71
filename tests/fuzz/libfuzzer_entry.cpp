#include "core/error.hpp"
#include "fuzz/fuzz_target.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

// The name and the shape are libFuzzer's. What is thrown beside InputError ends the process, and is so
// reported.
int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    coapt::fuzz::run_target({reinterpret_cast<const char*>(bytes), size});
  } catch (const coapt::InputError&) {
  }
  return 0;
}
