#include "results/frames.hpp"

#include "core/number_text.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "formats/whole_file.hpp"

#include <cstdio>
#include <system_error>
#include <vector>

namespace coapt {
namespace {

namespace fs = std::filesystem;

VtpSurface frame(const Model& model, const Points& x) {
  VtpSurface surface;
  surface.vertices = x.colwise() + model.origin;
  surface.triangles = model.mesh.triangles;
  surface.lines.resize(2, std::ssize(model.lines));
  for (size_t k = 0; k < model.lines.size(); ++k)
    surface.lines.col(static_cast<Eigen::Index>(k)) << model.lines[k].a, model.lines[k].b;
  surface.point_arrays.push_back({"displacement", x - model.X});
  surface.texts.push_back({"units", {"mm"}});
  return surface;
}

}  // namespace

void remove_frames(const fs::path& folder) {
  if (!fs::exists(folder / "frames.pvd")) return;
  std::error_code ignored;
  std::vector<fs::path> frames;
  for (const auto& file : fs::directory_iterator(folder / "frames", ignored))
    if (file.path().filename().string().starts_with("frame_")) frames.push_back(file.path());
  for (const fs::path& file : frames) fs::remove(file, ignored);
  fs::remove(folder / "frames", ignored);  // unless something else is in it
  fs::remove(folder / "frames.pvd", ignored);
}

FrameWriter::FrameWriter(const fs::path& folder, int every, const Model& model)
    : folder_(folder), every_(every), model_(model) {
  std::error_code error;
  fs::create_directories(folder / "frames", error);
  if (error)
    throw InputError((folder / "frames").string() + ": cannot be used for frames: " + error.message());
}

void FrameWriter::see(const Iteration& iteration, const Vector& q) {
  if (q.size() != model_.objective->unknown_count() || seen_++ % every_ != 0) return;
  const double time = iteration.time > 0 ? iteration.time : static_cast<double>(seen_ - 1);
  if (count_ > 0 && time <= last_time_) return;  // a round of a motion begins where the one before ended
  last_time_ = time;
  char name[32];
  std::snprintf(name, sizeof name, "frames/frame_%06d.vtp", count_++);
  // A frame that is lost, as on a full disk, does not end the run that it shows.
  if (failure_) return;
  try {
    write_vtp(folder_ / name, frame(model_, model_.objective->positions(q)));
  } catch (const OutputError& error) {
    failure_ = error;
    return;
  }
  entries_ += "    <DataSet timestep=\"" + number_text(time, 9) + "\" file=\"" + name + "\"/>\n";
}

void FrameWriter::finish() const {
  if (failure_) throw OutputError(*failure_);
  formats::write_whole(
      folder_ / "frames.pvd",
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n  <Collection>\n" + entries_ +
          "  </Collection>\n</VTKFile>\n");
}

}  // namespace coapt
