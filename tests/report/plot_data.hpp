// What the plots of a page are drawn from. Empty in a build without uPlot.
#pragma once

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace coapt {

inline std::vector<nlohmann::json> plot_data(const std::string& page) {
  const std::string opening = "<script type=\"application/json\">", closing = "</script>";
  std::vector<nlohmann::json> plots;
  for (size_t at = page.find("<div class=\"chart\""); at != std::string::npos;
       at = page.find("<div class=\"chart\"", at + 1)) {
    const size_t from = page.find(opening, at) + opening.size();
    plots.push_back(nlohmann::json::parse(page.substr(from, page.find(closing, from) - from)));
  }
  return plots;
}

}  // namespace coapt
