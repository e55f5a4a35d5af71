#include "formats/json/read_points.hpp"

#include "core/error.hpp"
#include "formats/json/read_json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <vector>

namespace coapt {
namespace {

// Splits a line at commas, semicolons, blanks and tabs.
std::vector<std::string_view> fields(std::string_view line) {
  std::vector<std::string_view> result;
  constexpr std::string_view kSeparators = ",; \t\r";
  for (size_t begin = line.find_first_not_of(kSeparators); begin != std::string_view::npos;) {
    const size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
    result.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kSeparators, end);
  }
  return result;
}

bool read_point(const std::vector<std::string_view>& texts, Vec3& point) {
  if (texts.size() != 3) return false;
  for (int c = 0; c < 3; ++c) {
    const std::string_view text = texts[static_cast<size_t>(c)];
    const auto result = std::from_chars(text.data(), text.data() + text.size(), point[c]);
    if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || !std::isfinite(point[c]))
      return false;
  }
  return true;
}

}  // namespace

Points read_csv(const std::string& path) {
  const std::string text = read_text(path);
  std::vector<Vec3> rows;
  std::vector<std::string> defects;
  int number = 0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    const std::string_view line(text.data() + begin, end - begin);
    begin = end + 1;
    ++number;
    const auto texts = fields(line);
    Vec3 point;
    if (texts.empty() || texts[0].starts_with('#')) continue;
    if (read_point(texts, point)) {
      rows.push_back(point);
    } else if (number > 1 && defects.size() < 20) {
      defects.push_back(path + ":" + std::to_string(number) + ": expected three finite numbers x, y, z");
    }
  }
  if (rows.empty() && defects.empty()) defects.push_back(path + ": holds no position");
  if (!defects.empty()) throw InputError(defects);
  Points points(3, static_cast<Eigen::Index>(rows.size()));
  for (size_t k = 0; k < rows.size(); ++k) points.col(static_cast<Eigen::Index>(k)) = rows[k];
  return points;
}

}  // namespace coapt
