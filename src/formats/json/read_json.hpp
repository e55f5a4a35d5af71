// JSON files with // comments, read whole and strictly.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace coapt {

using Json = nlohmann::json;

// Parses `text`; `file` names it in messages. Throws InputError with line and column where the text is
// not JSON, where an object has a key twice, or where it nests deeper than 64.
Json parse_json(const std::string& text, const std::string& file);

// The text of a file of at most 64 MB. Throws InputError.
std::string read_text(const std::filesystem::path& path);

// Both together.
Json read_json(const std::filesystem::path& path);

}  // namespace coapt
