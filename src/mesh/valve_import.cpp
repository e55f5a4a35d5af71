#include "mesh/valve_import.hpp"

#include "core/error.hpp"
#include "mesh/formats/fe_readers.hpp"
#include "mesh/formats/lower_extension.hpp"
#include "mesh/formats/whole_file.hpp"

#include <algorithm>
#include <cctype>

namespace coapt {
namespace {

bool is_utf8(const std::string& bytes) {
  int following = 0;                      // bytes of the character that are still to come
  unsigned char low = 0x80, high = 0xBF;  // of the next one
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (following > 0) {
      if (byte < low || byte > high) return false;
      low = 0x80;
      high = 0xBF;
      --following;
    } else if (byte >= 0x80) {
      if (byte < 0xC2 || byte > 0xF4) return false;
      following = byte < 0xE0 ? 1 : byte < 0xF0 ? 2 : 3;
      if (byte == 0xE0) low = 0xA0;   // shorter forms exist
      if (byte == 0xED) high = 0x9F;  // surrogates
      if (byte == 0xF0) low = 0x90;
      if (byte == 0xF4) high = 0x8F;
    }
  }
  return following == 0;
}

// Older programs write Latin-1: names keep their letters.
std::string utf8_from_latin1(const std::string& bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xC0 | (byte >> 6));
      text += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return text;
}

}  // namespace

bool is_model_file(const std::filesystem::path& path) {
  return formats::lower_extension(path) == ".inp" || formats::lower_extension(path) == ".feb";
}

ValveModel read_model(const std::filesystem::path& path) {
  if (!is_model_file(path))
    throw InputError(path.string() + ": the extension '" + formats::lower_extension(path) +
                     "' is no finite-element model; use .inp or .feb");
  std::string bytes = formats::read_whole(path);
  if (!is_utf8(bytes)) bytes = utf8_from_latin1(bytes);
  formats::FeModel model = formats::lower_extension(path) == ".inp"
                               ? formats::read_abaqus(bytes, path.string())
                               : formats::read_febio(bytes, path.string());
  ValveModel result;
  result.valve = formats::valve_of(model);
  if (result.valve.name.empty()) result.valve.name = path.stem().string();
  result.has_contact = model.has_contact;
  result.is_pressure_dead = model.is_pressure_dead;
  result.warnings = std::move(model.warnings);
  return result;
}

}  // namespace coapt
