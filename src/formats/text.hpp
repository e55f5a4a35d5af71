// Lines, words and numbers of a text file, independent of the locale.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace coapt::formats {

// Walks through the lines of a text. A carriage return at the end of a line counts as white space.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  // False at the end of the text. With `joins`, a line that ends in a backslash goes on in the next one.
  bool next(std::string_view& line, bool joins = false);

  int number() const { return number_; }           // of the line's first physical line, from 1
  std::string_view rest() const { return rest_; }  // what has not been read yet

 private:
  std::string_view rest_;
  int number_ = 0;
  int lines_read_ = 0;
};

// The next word of `rest`, which is shortened by it; empty at the end.
std::string_view next_word(std::string_view& rest);

std::string_view trimmed(std::string_view text);

// Reads a finite number. Returns nothing on success, otherwise the reason with the word quoted.
std::optional<std::string> read_number(std::string_view word, double& value);
std::optional<std::string> read_integer(std::string_view word, long long& value);

// The word in quotes, shortened and without control characters: fit for a message.
std::string quoted(std::string_view word);

// Appends a number in the shortest form that reads back to the same bits.
void append_number(std::string& text, double value);
void append_number(std::string& text, float value);
void append_number(std::string& text, long long value);

// True for bytes that no text file contains (a zero byte, or many control characters near the start).
bool looks_binary(std::string_view bytes);

}  // namespace coapt::formats
