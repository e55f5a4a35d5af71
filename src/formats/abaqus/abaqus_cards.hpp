// An Abaqus input file as a list of keywords with their data lines.
#pragma once

#include "formats/defects.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace coapt::formats {

struct AbaqusLine {
  int number = 0;                        // from 1
  std::vector<std::string_view> fields;  // between commas, trimmed; a comma at the end adds none
  bool goes_on = false;                  // ends in a comma
};

struct AbaqusCard {
  std::string keyword;  // upper case, single blanks: "SOLID SECTION"
  int line = 0;
  std::vector<std::pair<std::string, std::string>> parameters;  // key in upper case, value without quotes
  std::vector<AbaqusLine> data;

  bool has(std::string_view key) const { return find(key) != nullptr; }
  const std::string* find(std::string_view key) const;
  std::string text(std::string_view key) const;   // as written; empty where it is absent
  std::string upper(std::string_view key) const;  // names are the same in any case
};

// Fields point into `bytes`. Comments are left out; a keyword line that ends in a comma goes on in the next.
// Defects are added: data before the first keyword, a star without a keyword.
std::vector<AbaqusCard> abaqus_cards(std::string_view bytes, Defects& defects);

std::string upper_case(std::string_view text);

// A number as the format writes it ("1.D-3" too); an empty field is 0. A defect is added naming the line.
std::optional<double> abaqus_number(std::string_view field, int line, Defects& defects);
std::optional<long long> abaqus_integer(std::string_view field, int line, Defects& defects);

}  // namespace coapt::formats
