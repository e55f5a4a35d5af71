#include "core/error.hpp"
#include "formats/vtk/vtp_writer.hpp"
#include "support/mesh_samples.hpp"

#include <gtest/gtest.h>

namespace coapt {
namespace {

VtpSurface decorated_sheet() {
  const TriangleMesh mesh = wavy_sheet(3);
  VtpSurface surface;
  surface.vertices = mesh.vertices;
  surface.triangles = mesh.triangles;
  surface.lines.resize(2, 2);
  surface.lines << 0, 1, 5, 7;
  surface.point_arrays = {{"displacement", mesh.vertices * 2, false},
                          {"id <&>", Eigen::RowVectorXd::LinSpaced(16, 0, 15), true}};
  surface.triangle_arrays = {{"region", Eigen::RowVectorXd::LinSpaced(18, 0, 17), true}};
  surface.line_arrays = {{"force", Eigen::RowVector2d(1.5, 2.5), false}};
  surface.texts = {{"units", {"mm"}}, {"region_names", {"a", "b"}}};
  return surface;
}

TEST(VtpWriter, RefusesArraysThatDoNotFit) {
  const ScratchFolder scratch;
  VtpSurface surface = decorated_sheet();
  surface.point_arrays.push_back({"short", Eigen::MatrixXd::Zero(1, 3), false});
  surface.line_arrays.push_back({"force", Eigen::MatrixXd::Zero(1, 2), false});
  try {
    write_vtp(scratch.path("a.vtp"), surface);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 2u);
  }
  EXPECT_EQ(scratch.file_count(), 0u);
}

#ifdef COAPT_HAS_PUGIXML
TEST(VtpWriter, WritesWhatTheReaderReadsWithLinesAndArrays) {
  const ScratchFolder scratch;
  const VtpSurface surface = decorated_sheet();
  for (const MeshCoding coding : {MeshCoding::Ascii, MeshCoding::Binary}) {
    write_vtp(scratch.path("a.vtp"), surface, coding);
    const MeshFile file = read_mesh(scratch.path("a.vtp"));
    EXPECT_EQ(file.mesh.vertices, surface.vertices);
    EXPECT_EQ(file.mesh.triangles, surface.triangles);
    ASSERT_EQ(file.mesh.regions.size(), 18u);  // the values of the triangles, not those of the lines
    EXPECT_EQ(file.mesh.regions[17], 17);
    EXPECT_EQ(file.mesh.region_names[1], "b");
    EXPECT_EQ(file.warnings.size(), 1u);  // two lines left out
  }
}

std::string square(const std::string& root, const std::string& points, const std::string& connectivity,
                   const std::string& offsets) {
  return "<VTKFile type=\"PolyData\" " + root +
         "><PolyData><Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points>" +
         "<DataArray type=\"Float32\" NumberOfComponents=\"3\" " + points + "</DataArray></Points><Polys>" +
         "<DataArray type=\"Int32\" Name=\"connectivity\" " + connectivity + "</DataArray>" +
         "<DataArray type=\"Int32\" Name=\"offsets\" " + offsets +
         "</DataArray></Polys></Piece></PolyData></VTKFile>";
}

TEST(VtpReader, ReadsInlineBase64) {
  const ScratchFolder scratch;
  // Sizes (UInt32, little endian) and data in one run of base64: 36 bytes of points, 0 1 2, and 3.
  const auto path = scratch.file(
      "a.vtp", square("byte_order=\"LittleEndian\"",
                      "format=\"binary\"> JAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAIA/AAAAAA== ",
                      "format=\"binary\">DAAAAAAAAAABAAAAAgAAAA==", "format=\"binary\">BAAAAAMAAAA="));
  const MeshFile file = read_mesh(path);
  Points wanted(3, 3);
  wanted << 0, 1, 1, 0, 0, 1, 0, 0, 0;
  EXPECT_EQ(file.mesh.vertices, wanted);
}

TEST(VtpReader, ComparesItsCountsAndRefusesCornersThatAreNotWhole) {
  const ScratchFolder scratch;
  const auto refusal = [&](const std::string& points, const std::string& connectivity,
                           const std::string& offsets) -> std::string {
    try {
      read_mesh(
          scratch.file("a.vtp", square("", "format=\"ascii\">" + points, "format=\"ascii\">" + connectivity,
                                       "format=\"ascii\">" + offsets)));
      return "accepted";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  const std::string three = "0 0 0 1 0 0 0 1 0";
  EXPECT_EQ(refusal(three, "0 1 2", "3"), "accepted");
  EXPECT_NE(refusal(three + " 5 5 5", "0 1 2", "3").find("NumberOfPoints is '3', but the file holds 4"),
            std::string::npos);
  EXPECT_NE(refusal(three, "0 1 2 0 2 1", "3 6").find("NumberOfPolys is '1', but the file holds 2"),
            std::string::npos);
  EXPECT_NE(refusal(three, "0 1 2 0", "3").find("corners behind the last offset"), std::string::npos);
  EXPECT_NE(refusal(three, "0 1.5 2", "3").find("not whole"), std::string::npos);
}

TEST(VtpReader, RefusesFalseSizesAndBadNumbers) {
  const ScratchFolder scratch;
  const auto path =
      scratch.file("a.vtp", square("header_type=\"UInt64\"", "format=\"binary\">//////////8AAAAA",
                                   "format=\"ascii\">0 1 zwei", "format=\"ascii\">3"));
  try {
    read_mesh(path);
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_EQ(error.defects().size(), 3u) << error.what();
    EXPECT_NE(std::string(error.what()).find("million numbers, the most that are read"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("'zwei' is not a number"), std::string::npos);
  }
}
#else
TEST(VtpReader, SaysWhichPackageIsMissing) {
  const ScratchFolder scratch;
  write_vtp(scratch.path("a.vtp"), decorated_sheet());
  try {
    read_mesh(scratch.path("a.vtp"));
    FAIL() << "no error";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("libpugixml-dev"), std::string::npos);
  }
}
#endif

}  // namespace
}  // namespace coapt
