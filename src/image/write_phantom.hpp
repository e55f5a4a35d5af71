// The files of a phantom: its image, and its truth beside it.
#pragma once

#include "image/phantom.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

// Names of the files that write_phantom() writes.
std::vector<std::string> phantom_files();

// Into a folder that is there: image.nrrd (8 bits), labels.nrrd (PhantomLabel, 8 bits), surface.obj and
// surface.vtp (middle surface; with thickness [mm] at vertices, dropout on triangles, and the chords as
// lines), annulus.mrk.json and free_edge.mrk.json (curves of 3D Slicer); all in LPS [mm]. Throws InputError
// where one cannot be written.
void write_phantom(const std::filesystem::path& folder, const PhantomValve& valve,
                   const PhantomPattern& pattern, const Phantom& phantom, const PhantomOptions& options);

}  // namespace coapt
