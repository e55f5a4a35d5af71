// One reader and one writer per file format. Readers take the whole file as bytes and its name for the
// messages; writers return the bytes. All throw InputError as read_mesh and write_mesh say.
#pragma once

#include "formats/mesh_io.hpp"

#include <string>
#include <string_view>

namespace coapt::formats {

MeshFile read_obj(std::string_view bytes, const std::string& file);
MeshFile read_ply(std::string_view bytes, const std::string& file);
MeshFile read_stl(std::string_view bytes, const std::string& file);
MeshFile read_off(std::string_view bytes, const std::string& file);
MeshFile read_vtp(std::string_view bytes, const std::string& file);

using Coding = MeshCoding;

// `remark` is a comment of one line in the header; empty: none.
std::string write_obj(const TriangleMesh& mesh, const std::string& remark = "");
std::string write_ply(const TriangleMesh& mesh, Coding coding, const std::string& remark = "");
std::string write_stl(const TriangleMesh& mesh, Coding coding, const std::string& remark = "");
std::string write_off(const TriangleMesh& mesh, const std::string& remark = "");

}  // namespace coapt::formats
