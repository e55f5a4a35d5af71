#include "solve/resumable_record.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>

namespace coapt {
namespace {

constexpr std::array kStatuses = {Status::Converged, Status::IterationLimit,   Status::TimeLimit,
                                  Status::Stalled,   Status::LineSearchFailed, Status::NonFinite,
                                  Status::Cancelled, Status::NoEquilibrium};

// What differs, each with a remedy.
std::vector<std::string> differences(const std::string& file, const Json& known, const Identity& identity) {
  std::map<std::string, std::string> rest = known.get<std::map<std::string, std::string>>();
  std::vector<std::string> defects;
  for (const IdentityItem& item : identity) {
    const auto there = rest.find(item.key);
    const std::string value = there == rest.end() ? "" : there->second;
    if (value == item.value) continue;
    const auto shown = [](const std::string& text) { return text.empty() ? "none" : text; };
    defects.push_back(file + ": is of another " + item.key +
                      (item.is_fingerprint
                           ? ", or it or a file that it names has changed since"
                           : " (" + shown(value) + " there, " + shown(item.value) + " here)") +
                      "; " + item.remedy);
  }
  return defects;
}

}  // namespace

void write_record(const std::filesystem::path& path, const Seal& seal, const Identity& identity,
                  const Json& record) {
  Json own = Json::object();
  for (const IdentityItem& item : identity) own[item.key] = item.value;
  write_checksummed(path, seal, {{"identity", own}, {"record", record}});
}

void read_record(const std::filesystem::path& path, const Seal& seal, const Identity& identity,
                 const std::function<void(const Json&)>& take) {
  const std::string file = path.string();
  const Json json = read_checksummed(path, seal);
  std::vector<std::string> defects;
  try {
    defects = differences(file, json.at("identity"), identity);
    if (defects.empty()) take(json.at("record"));
  } catch (const std::exception& error) {  // of the library, or of a number that is none
    defects = {file + ": does not hold what a " + std::string(seal.what) + " holds (" + error.what() + ")" +
               std::string(seal.remedy)};
  }
  if (!defects.empty()) throw InputError(std::move(defects));
}

std::vector<double> numbers_of(const Eigen::Ref<const Vector>& values) {
  return {values.begin(), values.end()};
}

Vector vector_of(const Json& json) {
  const auto values = json.get<std::vector<double>>();
  Vector vector = Eigen::Map<const Vector>(values.data(), std::ssize(values));
  if (!vector.allFinite()) throw std::domain_error("numbers that are not finite");
  return vector;
}

Points points_of(const Json& json) {
  const Vector numbers = vector_of(json);
  if (numbers.size() % 3 != 0) throw std::domain_error("positions that are none");
  return numbers.reshaped(3, numbers.size() / 3);
}

Status status_of(const Json& json) {
  const auto name = json.get<std::string>();
  const auto* status = std::find_if(kStatuses.begin(), kStatuses.end(),
                                    [&](Status known) { return status_name(known) == name; });
  if (status == kStatuses.end()) throw std::domain_error("the status \"" + name + "\"");
  return *status;
}

}  // namespace coapt
