#include "fuzz/damage.hpp"

#include "fuzz/changed_header.hpp"
#include "fuzz/changed_tree.hpp"

#include <algorithm>
#include <array>
#include <random>
#include <string_view>

namespace coapt::fuzz {
namespace {

constexpr std::array<std::string_view, 24> kWords = {
    "0",          "-1",         "1",          "nan",  "inf",   "1e308", "-1e308", "1e-320",
    "2147483647", "2147483648", "4294967295", "1e15", "99999", "null",  "\"\"",   "[]",
    "{}",         "[[",         "*",          "\n",   " ",     "<a>",   "\xff",   "9223372036854775807"};

// Whole numbers below `bound`; std::uniform_int_distribution differs between standard libraries.
std::size_t below(std::mt19937& random, std::size_t bound) { return bound == 0 ? 0 : random() % bound; }

void damage_once(std::string& text, const std::vector<std::string>& seeds, std::mt19937& random) {
  const std::size_t place = below(random, text.size() + 1);
  const std::size_t length = std::min(text.size() - place, below(random, 12));
  switch (below(random, 7)) {
    case 0:
      if (place < text.size()) text[place] = static_cast<char>(below(random, 256));
      break;
    case 1:
      if (place < text.size()) text[place] = static_cast<char>(text[place] ^ (1 << below(random, 8)));
      break;
    case 2:
      text.erase(place, length);
      break;
    case 3:
      text.insert(place, text.substr(place, length));
      break;
    case 4:
      text.replace(place, length, kWords[below(random, kWords.size())]);
      break;
    case 5:
      text.insert(place, kWords[below(random, kWords.size())]);
      break;
    default: {
      const std::string& other = seeds[below(random, seeds.size())];
      text = text.substr(0, place) + other.substr(below(random, other.size() + 1));
    }
  }
}

}  // namespace

std::string damaged(const std::vector<std::string>& seeds, std::size_t index) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(index));
  std::string text = seeds[below(random, seeds.size())];
  if (index % 2 == 1) {
    if (std::string volume = changed_header(text, index); !volume.empty()) return volume;
#ifdef COAPT_FUZZ_TREES
    if (std::string tree = changed_tree(text, random()); !tree.empty()) return tree;
#endif
  }
  for (std::size_t k = 0, times = 1 + below(random, 6); k < times; ++k) damage_once(text, seeds, random);
  return text;
}

}  // namespace coapt::fuzz
