#include "formats/json/closed_curve.hpp"

#include "core/error.hpp"
#include "core/number_text.hpp"
#include "formats/json/markups.hpp"
#include "formats/json/read_points.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace coapt {
namespace {

Markup curve_of(const std::filesystem::path& path) {
  if (!is_markup_file(path))
    return {.name = path.stem().string(), .type = "Curve", .points = read_csv(path.string())};
  const std::vector<Markup> markups = read_markups(path);
  for (const char* type : {"ClosedCurve", "Curve", "Fiducial"})
    for (const Markup& markup : markups)
      if (markup.type == type && markup.points.cols() > 0) return markup;
  throw InputError(path.string() + ": holds no curve and no list of points");
}

void refuse_open(const Points& x, const std::string& name) {
  constexpr double kWidest = 3;  // gap, in parts of the longest side
  const Eigen::Index n = x.cols();
  if (n < 3) return;  // too few for a curve of any kind
  double longest = 0;
  for (Eigen::Index k = 0; k + 1 < n; ++k) longest = std::max(longest, (x.col(k + 1) - x.col(k)).norm());
  const double gap = (x.col(n - 1) - x.col(0)).norm();
  if (gap <= kWidest * longest) return;
  throw InputError(name + ": the curve is open: its ends are " + number_text(gap) +
                   " mm apart, its neighbours at most " + number_text(longest) + " mm; close it");
}

}  // namespace

Points read_closed_curve(const std::filesystem::path& path) {
  Markup curve = curve_of(path);
  if (curve.type != "ClosedCurve") refuse_open(curve.points, path.string());
  return std::move(curve.points);
}

}  // namespace coapt
