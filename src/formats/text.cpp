#include "formats/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <system_error>

namespace coapt::formats {
namespace {

bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

bool is_control(char c) { return (static_cast<unsigned char>(c) < 0x20 && !is_space(c)) || c == 0x7f; }

template <class Number>
void append(std::string& text, Number value) {
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  text.append(buffer, end);
}

std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

}  // namespace

bool Lines::next(std::string_view& line, bool joins) {
  if (rest_.empty()) return false;
  number_ = lines_read_ + 1;
  size_t from = 0;
  while (true) {
    const void* found = std::memchr(rest_.data() + from, '\n', rest_.size() - from);
    const size_t end =
        found ? static_cast<size_t>(static_cast<const char*>(found) - rest_.data()) : rest_.size();
    ++lines_read_;
    size_t last = end;
    if (last > from && rest_[last - 1] == '\r') --last;
    line = rest_.substr(0, end);
    const size_t next = std::min(end + 1, rest_.size());
    if (!joins || last == from || rest_[last - 1] != '\\' || next == rest_.size()) {
      rest_.remove_prefix(next);
      return true;
    }
    from = next;
  }
}

std::string_view next_word(std::string_view& rest) {
  // A backslash stands for white space only where it joins two lines.
  const auto separates = [&](size_t i) {
    return is_space(rest[i]) ||
           (rest[i] == '\\' && i + 1 < rest.size() && (rest[i + 1] == '\n' || rest[i + 1] == '\r'));
  };
  size_t begin = 0;
  while (begin < rest.size() && separates(begin)) ++begin;
  size_t end = begin;
  while (end < rest.size() && !separates(end)) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::optional<std::string> read_number(std::string_view word, double& value) {
  const std::string_view digits = without_plus(word);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  const bool whole = end == digits.data() + digits.size();
  if (error == std::errc::invalid_argument || !whole) {
    const bool comma = word.find(',') != std::string_view::npos;
    return quoted(word) + " is not a number" + (comma ? "; write a decimal point, not a comma" : "");
  }
  if (error == std::errc::result_out_of_range) {  // either too large, or so small that it is zero
    if (digits.find("e-") == std::string_view::npos && digits.find("E-") == std::string_view::npos)
      return quoted(word) + " is too large for double precision";
    value = 0;
  }
  if (!std::isfinite(value)) return quoted(word) + " is not a finite number";
  return std::nullopt;
}

std::optional<std::string> read_integer(std::string_view word, long long& value) {
  const std::string_view digits = without_plus(word);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range) return quoted(word) + " is out of range";
  if (error != std::errc() || end != digits.data() + digits.size())
    return quoted(word) + " is not a whole number";
  return std::nullopt;
}

std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 40)) text += is_control(c) || (c & '\x80') ? '?' : c;
  return text + (word.size() > 40 ? "...'" : "'");
}

void append_number(std::string& text, double value) { append(text, value); }
void append_number(std::string& text, float value) { append(text, value); }
void append_number(std::string& text, long long value) { append(text, value); }

bool looks_binary(std::string_view bytes) {
  if (bytes.find('\0') != std::string_view::npos) return true;
  const std::string_view head = bytes.substr(0, 1024);
  return static_cast<size_t>(std::count_if(head.begin(), head.end(), is_control)) * 50 > head.size();
}

}  // namespace coapt::formats
