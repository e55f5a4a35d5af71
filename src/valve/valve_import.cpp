#include "valve/valve_import.hpp"

#include "core/error.hpp"
#include "formats/fe_readers.hpp"
#include "formats/lower_extension.hpp"
#include "formats/utf8.hpp"
#include "formats/whole_file.hpp"

namespace coapt {

bool is_model_file(const std::filesystem::path& path) {
  return formats::lower_extension(path) == ".inp" || formats::lower_extension(path) == ".feb";
}

ValveModel read_model(const std::filesystem::path& path) {
  if (!is_model_file(path))
    throw InputError(path.string() + ": the extension '" + formats::lower_extension(path) +
                     "' is no finite-element model; use .inp or .feb");
  const std::string bytes = formats::as_utf8(formats::read_whole(path));
  formats::FeModel model = formats::lower_extension(path) == ".inp"
                               ? formats::read_abaqus(bytes, path.string())
                               : formats::read_febio(bytes, path.string());
  ValveModel result;
  result.valve = formats::valve_of(model);
  if (result.valve.name.empty()) result.valve.name = formats::as_utf8(path.stem().string());
  result.has_contact = model.has_contact;
  result.is_pressure_dead = model.is_pressure_dead;
  result.warnings = std::move(model.warnings);
  return result;
}

}  // namespace coapt
