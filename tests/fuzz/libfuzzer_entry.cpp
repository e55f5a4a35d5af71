#include "core/error.hpp"
#include "fuzz/changed_tree.hpp"
#include "fuzz/fuzz_target.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

// Names and shapes are libFuzzer's.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);
extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* bytes, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size, std::size_t most,
                                               unsigned seed);

// What is thrown beside InputError ends the process, and is so reported.
int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    coapt::fuzz::run_target({reinterpret_cast<const char*>(bytes), size});
  } catch (const coapt::InputError&) {
  }
  return 0;
}

#ifdef COAPT_FUZZ_TREES
// Of inputs that are trees three in four are changed as trees, the others by libFuzzer's own ways.
std::size_t LLVMFuzzerCustomMutator(std::uint8_t* bytes, std::size_t size, std::size_t most, unsigned seed) {
  if (seed % 4 != 0) {
    const std::string tree = coapt::fuzz::changed_tree({reinterpret_cast<const char*>(bytes), size}, seed);
    if (!tree.empty() && tree.size() <= most) {
      std::copy(tree.begin(), tree.end(), bytes);
      return tree.size();
    }
  }
  return LLVMFuzzerMutate(bytes, size, most);
}
#endif
