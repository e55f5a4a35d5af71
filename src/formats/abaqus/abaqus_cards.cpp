#include "formats/abaqus/abaqus_cards.hpp"

#include "formats/text.hpp"

#include <algorithm>
#include <cctype>

namespace coapt::formats {
namespace {

// Splits at commas that stand outside quotes.
std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  bool is_quoted = false;
  size_t begin = 0;
  for (size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] == '"') is_quoted = !is_quoted;
    if (i < line.size() && (line[i] != ',' || is_quoted)) continue;
    fields.push_back(trimmed(line.substr(begin, i - begin)));
    begin = i + 1;
  }
  if (!fields.empty() && fields.back().empty()) fields.pop_back();
  return fields;
}

std::string single_blanks(std::string_view text) {
  std::string result;
  for (std::string_view word = next_word(text); !word.empty(); word = next_word(text))
    result.append(result.empty() ? "" : " ").append(word);
  return result;
}

std::string without_quotes(std::string_view text) {
  if (text.size() >= 2 && text.front() == '"' && text.back() == '"') text = text.substr(1, text.size() - 2);
  return std::string(text);
}

bool ends_in_comma(std::string_view line) {
  const std::string_view text = trimmed(line);
  return !text.empty() && text.back() == ',';
}

void add_parameters(const std::vector<std::string_view>& fields, size_t first, AbaqusCard& card) {
  for (size_t k = first; k < fields.size(); ++k) {
    const size_t equal = fields[k].find('=');
    const std::string key = upper_case(single_blanks(fields[k].substr(0, equal)));
    const std::string_view value =
        equal == std::string_view::npos ? "" : trimmed(fields[k].substr(equal + 1));
    card.parameters.emplace_back(key, without_quotes(value));
  }
}

}  // namespace

std::string upper_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return result;
}

const std::string* AbaqusCard::find(std::string_view key) const {
  for (const auto& [name, value] : parameters)
    if (name == key) return &value;
  return nullptr;
}

std::string AbaqusCard::text(std::string_view key) const {
  const std::string* value = find(key);
  return value == nullptr ? "" : *value;
}

std::string AbaqusCard::upper(std::string_view key) const { return upper_case(text(key)); }

std::vector<AbaqusCard> abaqus_cards(std::string_view bytes, Defects& defects) {
  std::vector<AbaqusCard> cards;
  Lines lines(bytes);
  std::string_view line;
  bool in_keyword = false;  // whose line ended in a comma
  while (lines.next(line)) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.starts_with("**")) continue;
    if (in_keyword && text[0] != '*') {
      add_parameters(split(text), 0, cards.back());
      in_keyword = ends_in_comma(text);
      continue;
    }
    if (text[0] == '*') {
      const std::vector<std::string_view> fields = split(text.substr(1));
      AbaqusCard card;
      card.line = lines.number();
      if (!fields.empty()) card.keyword = upper_case(single_blanks(fields[0]));
      if (card.keyword.empty()) defects.add("line", card.line, "a star without a keyword");
      add_parameters(fields, 1, card);
      cards.push_back(std::move(card));
      in_keyword = ends_in_comma(text);
      continue;
    }
    if (cards.empty()) {
      defects.add("line", lines.number(), "data before the first keyword; is this an Abaqus input file?");
      return cards;
    }
    cards.back().data.push_back({lines.number(), split(text), ends_in_comma(text)});
  }
  return cards;
}

std::optional<double> abaqus_number(std::string_view field, int line, Defects& defects) {
  if (field.empty()) return 0.0;
  std::string digits(field);
  std::replace_if(
      digits.begin(), digits.end(), [](char c) { return c == 'D' || c == 'd'; }, 'e');
  double value = 0;
  if (const auto reason = read_number(digits, value)) {
    defects.add("line", line, formats::quoted(field) + reason->substr(formats::quoted(digits).size()));
    return std::nullopt;
  }
  return value;
}

std::optional<long long> abaqus_integer(std::string_view field, int line, Defects& defects) {
  long long value = 0;
  if (const auto reason = read_integer(field, value)) {
    defects.add("line", line, *reason);
    return std::nullopt;
  }
  return value;
}

}  // namespace coapt::formats
