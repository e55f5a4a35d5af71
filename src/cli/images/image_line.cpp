#include "cli/images/image_line.hpp"

#include "cli/images/image_distance.hpp"
#include "core/number_text.hpp"
#include "formats/vtk/vtp_writer.hpp"

#include <cmath>
#include <utility>

namespace coapt::cli {
namespace {

constexpr int kArmPoints = 6;  // of a mark, to each side

double from_predicted(const LineInImage& piece, Eigen::Index n) {
  return (piece.predicted.colwise() - piece.found.col(n)).colwise().norm().minCoeff();
}

}  // namespace

std::vector<Points> pieces_of(const std::vector<Seam>& line, const Vec3& shift) {
  std::vector<Points> pieces;
  for (const Seam& seam : line) pieces.emplace_back(seam.points.colwise() + shift);
  return pieces;
}

ImageLine compared_line(std::vector<LineInImage> pieces, const RigidMotion& motion) {
  ImageLine line;
  std::vector<double> apart;
  double places = 0;
  for (LineInImage& piece : pieces) {
    piece.predicted = motion.apply(piece.predicted);
    piece.found = motion.apply(piece.found);
    places += static_cast<double>(piece.predicted.cols());
    for (Eigen::Index n = 0; n < piece.predicted.cols(); ++n)
      if (piece.is_shown[static_cast<size_t>(n)] != 0) apart.push_back(from_predicted(piece, n));
  }
  if (places > 0) line.shown_share = static_cast<double>(apart.size()) / places;
  line.to_predicted = figures_of(std::move(apart));
  line.pieces = std::move(pieces);
  return line;
}

std::string sentence_on(const ImageLine& line) {
  if (line.pieces.empty()) return "coaptation line: the solved leaflets have none";
  const std::string share = fixed_text(100 * line.shown_share, 0) + " %";
  if (line.shown_share == 0)
    return "coaptation line: the closed image shows nothing like these leaflets along it";
  return "coaptation line: the closed image shows " + share + " of it, mean " +
         number_text(line.to_predicted.mean, 2) + ", 95 % " + number_text(line.to_predicted.p95, 2) +
         " mm from where it was predicted";
}

Points marks_of(const std::vector<LineInImage>& pieces, double arm) {
  std::vector<Vec3> marks;
  for (const LineInImage& piece : pieces)
    for (Eigen::Index n = 0; n < piece.found.cols(); ++n) {
      if (piece.is_shown[static_cast<size_t>(n)] == 0) continue;
      for (int axis = 0; axis < 3; ++axis)
        for (int k = -kArmPoints; k <= kArmPoints; ++k)
          marks.emplace_back(piece.found.col(n) + k * arm / kArmPoints * Vec3::Unit(axis));
    }
  Points points(3, static_cast<Eigen::Index>(marks.size()));
  for (size_t n = 0; n < marks.size(); ++n) points.col(static_cast<Eigen::Index>(n)) = marks[n];
  return points;
}

void write_image_line(const std::filesystem::path& folder, const ImageLine& line) {
  Eigen::Index places = 0;
  for (const LineInImage& piece : line.pieces) places += piece.predicted.cols();
  VtpSurface surface;
  surface.vertices.resize(3, 2 * places);
  Eigen::MatrixXd likeness(1, 2 * places), apart(1, 2 * places);
  std::vector<std::array<int, 3>> stretches;  // two points, 1 in the image
  Eigen::Index at = 0;
  for (const LineInImage& piece : line.pieces)
    for (Eigen::Index n = 0; n < piece.predicted.cols(); ++n, ++at) {
      const auto is_shown = [&](Eigen::Index k) { return piece.is_shown[static_cast<size_t>(k)] != 0; };
      const Eigen::Index other = places + at;
      surface.vertices.col(at) = piece.predicted.col(n);
      surface.vertices.col(other) = piece.found.col(n);
      likeness(at) = likeness(other) = piece.likeness[n];
      apart(at) = apart(other) = is_shown(n) ? from_predicted(piece, n) : kNaN;
      if (n == 0) continue;
      stretches.push_back({static_cast<int>(at) - 1, static_cast<int>(at), 0});
      if (is_shown(n - 1) && is_shown(n))
        stretches.push_back({static_cast<int>(other) - 1, static_cast<int>(other), 1});
    }
  surface.lines.resize(2, static_cast<Eigen::Index>(stretches.size()));
  Eigen::MatrixXd in_image(1, surface.lines.cols());
  for (Eigen::Index n = 0; n < surface.lines.cols(); ++n) {
    const auto& [a, b, what] = stretches[static_cast<size_t>(n)];
    surface.lines.col(n) << a, b;
    in_image(n) = what;
  }
  surface.line_arrays.push_back({"in_image", in_image, true});
  surface.point_arrays = {{"likeness", likeness}, {"distance_mm", apart}};
  surface.texts.push_back({"units", {"mm"}});
  write_vtp(folder / "coaptation_lines.vtp", surface);
}

}  // namespace coapt::cli
