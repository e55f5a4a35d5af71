#include "formats/json/suggestion.hpp"

#include <algorithm>

namespace coapt {
namespace {

// Whether the word is one of the parts of the name between underscores, but for a letter or two: "lenth" of
// "length_scale".
bool is_part(std::string_view word, std::string_view name) {
  constexpr size_t kShortest = 4;  // that says anything
  if (word.size() < kShortest) return false;
  for (size_t from = 0; from <= name.size();) {
    const size_t end = std::min(name.find('_', from), name.size());
    if (end - from >= kShortest &&
        edit_distance(word, name.substr(from, end - from)) <= static_cast<int>(word.size() / kShortest))
      return true;
    from = end + 1;
  }
  return false;
}

}  // namespace

// Optimal string alignment; three rows of the table are enough.
int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) last[j] = static_cast<int>(j);
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::string suggestion(std::string_view word, const std::vector<std::string>& names) {
  constexpr size_t kLongestWord = 100;  // the table grows with the square of the length
  if (word.size() > kLongestWord) return "";
  const std::string* best = nullptr;
  int least = std::max<int>(2, static_cast<int>(word.size()) / 3) + 1;
  for (const std::string& name : names) {
    const int distance = edit_distance(word, name);
    if (distance >= least || distance >= static_cast<int>(name.size())) continue;
    least = distance;
    best = &name;
  }
  if (best == nullptr)
    for (const std::string& name : names)
      if (best == nullptr && is_part(word, name)) best = &name;
  return best == nullptr ? "" : "; did you mean \"" + *best + "\"?";
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

}  // namespace coapt
