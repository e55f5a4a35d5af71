// What a page with a 3-D view holds of it, as JSON.
#pragma once

#include "core/types.hpp"
#include "formats/json/base64.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <vector>

namespace coapt {

// What the 3-D view of the page is given.
inline nlohmann::json shape_data(const std::string& page) {
  const std::string opening = "id=\"shape-data\">";
  const size_t from = page.find(opening) + opening.size(), to = page.find("</script>", from);
  const std::string data = page.substr(from, to - from);
  EXPECT_EQ(data.find('<'), std::string::npos) << "it could end the script";
  return nlohmann::json::parse(data);
}

inline std::string floats(const Eigen::MatrixXd& numbers) {
  const Eigen::MatrixXf singles = numbers.cast<float>();
  return base64(std::span<const float>(singles.data(), static_cast<size_t>(singles.size())));
}

// As the view has them, which adds the shift between two origins: here nothing, but -0 becomes 0.
inline std::string nodes(const Points& x) { return floats(x.array() + 0.0); }

// The numbers of the states that each sequence ends with.
inline std::vector<size_t> ends(const nlohmann::json& shapes) {
  std::vector<size_t> all;
  size_t count = 0;
  for (const nlohmann::json& sequence : shapes.at("sequences"))
    all.push_back((count += sequence.at("states").get<size_t>()) - 1);
  return all;
}

// Of a state, or of the earlier one that it names.
inline std::string nodes_of(const nlohmann::json& shapes, size_t state) {
  const nlohmann::json& own = shapes.at("states").at(state).at("nodes");
  return own.is_number() ? nodes_of(shapes, own.get<size_t>()) : own.get<std::string>();
}

inline std::vector<std::string> sequence_labels(const nlohmann::json& shapes) {
  std::vector<std::string> all;
  for (const nlohmann::json& sequence : shapes.at("sequences")) all.push_back(sequence.at("label"));
  return all;
}

}  // namespace coapt
