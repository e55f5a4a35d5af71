#include "scene/file/parameters.hpp"

#include "core/bounded_int.hpp"

#include <limits>
#include <stdexcept>

namespace coapt {

std::string Parameters::where(const std::string& key) const {
  // Keys of the file itself follow its name, keys of an object the path of that object.
  return where_ + (where_.find(": ") == std::string::npos ? ": " : ".") + key;
}

template <typename T>
const T& Parameters::get(const std::string& key) const {
  const auto found = values_.find(key);
  if (found == values_.end()) throw std::logic_error("no parameter " + key + " in " + where_);
  const T* value = std::get_if<T>(&found->second);
  if (value == nullptr) throw std::logic_error("parameter " + key + " in " + where_ + " is of another kind");
  return *value;
}

double Parameters::number(const std::string& key) const { return get<double>(key); }
double Parameters::number_or(const std::string& key, double otherwise) const {
  return has(key) ? number(key) : otherwise;
}
int Parameters::integer(const std::string& key) const {
  return bounded_int(get<double>(key), std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
}
bool Parameters::flag(const std::string& key) const { return get<bool>(key); }
const std::string& Parameters::text(const std::string& key) const { return get<std::string>(key); }
const Vec3& Parameters::vector(const std::string& key) const { return get<Vec3>(key); }
const std::vector<double>& Parameters::numbers(const std::string& key) const {
  return get<std::vector<double>>(key);
}
const std::vector<std::string>& Parameters::texts(const std::string& key) const {
  return get<std::vector<std::string>>(key);
}
const NodeSelection& Parameters::nodes(const std::string& key) const { return get<NodeSelection>(key); }
const std::vector<MoveTarget>& Parameters::targets(const std::string& key) const {
  return get<std::vector<MoveTarget>>(key);
}
const LineThrough& Parameters::line(const std::string& key) const { return get<LineThrough>(key); }
const SurfaceDirection& Parameters::direction(const std::string& key) const {
  return get<SurfaceDirection>(key);
}
const std::map<std::string, NodeSelection>& Parameters::selections(const std::string& key) const {
  return get<std::map<std::string, NodeSelection>>(key);
}
const Parameters& Parameters::object(const std::string& key) const { return objects(key).at(0); }
const std::vector<Parameters>& Parameters::objects(const std::string& key) const {
  return get<std::vector<Parameters>>(key);
}

void Parameters::set(const std::string& key, ParameterValue value) {
  values_.insert_or_assign(key, std::move(value));
}

void Parameters::scale(const std::string& key, double factor) {
  set(key, number(key) * factor);
  factors_.try_emplace(key, 1).first->second *= factor;
}

double Parameters::factor(const std::string& key) const {
  const auto found = factors_.find(key);
  return found == factors_.end() ? 1 : found->second;
}

}  // namespace coapt
