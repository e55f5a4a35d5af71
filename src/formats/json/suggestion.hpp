// "did you mean": the nearest of the known names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace coapt {

// Edits (insert, delete, replace a letter, swap two neighbours) that turn one word into the other.
int edit_distance(std::string_view a, std::string_view b);

// `; did you mean "young"?` where one of the names, or else one of its parts between
// underscores, is near enough to be meant; otherwise an empty text.
std::string suggestion(std::string_view word, const std::vector<std::string>& names);

// "a, b, c"; "none" for an empty list.
std::string listed(const std::vector<std::string>& names);

}  // namespace coapt
