#include "fuzz/changed_tree.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace coapt::fuzz {
namespace {

using Json = nlohmann::ordered_json;

// Bytes and brackets within each other that are parsed and written by recursion here, also with the frames of
// the sanitizers.
constexpr std::size_t kLongestText = 20000, kLongestBinary = 2000;
constexpr int kDeepest = 100;

constexpr std::array<const char*, 28> kValues = {"null",
                                                 "true",
                                                 "[]",
                                                 "{}",
                                                 R"("")",
                                                 "0",
                                                 "-1",
                                                 "1",
                                                 "0.5",
                                                 "-0.0",
                                                 "1e308",
                                                 "-1e308",
                                                 "1e-320",
                                                 "2147483648",
                                                 "-2147483649",
                                                 "4294967296",
                                                 "1e15",
                                                 "[0]",
                                                 "[[0, 0, 0]]",
                                                 R"("1e308 mm")",
                                                 R"("-1 MPa")",
                                                 R"("0 mm")",
                                                 R"("1e-9 N")",
                                                 R"("1 kPa")",
                                                 R"("120 mmHg")",
                                                 R"("../x")",
                                                 R"("/dev/zero")",
                                                 R"("boundary")"};

std::size_t below(std::mt19937& random, std::size_t bound) { return bound == 0 ? 0 : random() % bound; }

bool is_too_deep(std::string_view text) {
  int depth = 0;
  for (const char c : text) {
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > kDeepest) return true;
  }
  return false;
}

struct Places {
  std::vector<Json*> all, holders;  // every value; of these what has entries
  std::vector<std::string> keys;

  explicit Places(Json& root) { add(root); }

  void add(Json& node) {
    all.push_back(&node);
    if (!node.is_structured()) return;
    if (!node.empty()) holders.push_back(&node);
    if (node.is_object())
      for (const auto& entry : node.items()) keys.push_back(entry.key());
    for (Json& child : node) add(child);
  }
};

void move_number(Json& value, std::mt19937& random) {
  if (value.is_number_integer()) {
    const auto step = static_cast<std::int64_t>(below(random, 5)) - 2;
    const auto old = value.get<std::int64_t>();
    if (std::abs(static_cast<double>(old)) < 1e15)  // so that nothing overflows
      value = below(random, 4) == 0 ? -old : old + step;
  } else if (value.is_number_float()) {
    constexpr std::array<double, 6> kFactors = {-1, 0, 1e-6, 1e6, 1 + 1e-12, 2};
    value = value.get<double>() * kFactors[below(random, kFactors.size())];
  }
}

// An object or array in place of its former self, with one entry left out, doubled or renamed.
void change_entry(Json& holder, const std::vector<std::string>& keys, std::mt19937& random) {
  const std::size_t which = below(random, holder.size()), how = below(random, 3);
  if (holder.is_array()) {
    if (how == 0)
      holder.erase(which);
    else
      holder.insert(holder.begin() + static_cast<std::ptrdiff_t>(which), Json(holder[which]));
    return;
  }
  Json changed = Json::object();
  std::size_t k = 0;
  for (const auto& [key, value] : holder.items()) {
    if (k++ != which) {
      changed[key] = value;
    } else if (how > 0 && !keys.empty()) {
      changed[keys[below(random, keys.size())]] = value;
      if (how == 2) changed[key] = value;
    }
  }
  holder = std::move(changed);
}

void change_once(Json& root, std::mt19937& random) {
  const Places places(root);
  Json& place = *places.all[below(random, places.all.size())];
  const Json& other = *places.all[below(random, places.all.size())];
  switch (below(random, 5)) {
    case 0:
      place = Json::parse(kValues[below(random, kValues.size())]);
      break;
    case 1: {
      Json copy = other;  // it may hold the place
      place = std::move(copy);
      break;
    }
    case 2:
      place = Json::array({Json(place)});
      break;
    case 3:
      move_number(place, random);
      break;
    default:
      if (!places.holders.empty())
        change_entry(*places.holders[below(random, places.holders.size())], places.keys, random);
  }
}

}  // namespace

std::string changed_tree(std::string_view text, std::size_t seed) {
  if (text.empty() || text.size() > kLongestText || is_too_deep(text)) return {};
  Json root = Json::parse(text, nullptr, false, true);
  const bool is_binary = root.is_discarded();
  if (is_binary) {
    if (text.size() > kLongestBinary) return {};
    try {
      root = Json::from_cbor(text, true, false);
    } catch (const Json::out_of_range&) {  // a length beyond all arrays is thrown in spite of `false`
      return {};
    }
  }
  if (root.is_discarded() || !root.is_structured()) return {};
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  for (std::size_t k = 0, times = 1 + below(random, 4); k < times; ++k) change_once(root, random);
  if (!is_binary) return root.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string bytes;
  Json::to_cbor(root, bytes);
  return bytes;
}

}  // namespace coapt::fuzz
