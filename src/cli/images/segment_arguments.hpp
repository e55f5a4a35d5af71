// The arguments of the commands that find leaflets in a volume, and what they have in common.
#pragma once

#include "image/segment/segment_leaflets.hpp"

#include <filesystem>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace coapt::cli {

struct SegmentArguments {
  std::string volume, annulus, papillary, mask, seeds, shape, output, edge_length = "1.2mm";
  std::string method, inhibition, edge;  // add_segment_options sets the defaults
  std::optional<int> frame;
  std::optional<double> threshold, dynamic_range;
  std::string blur;  // empty: found
  bool keeps_evidence = false, has_second_route = false;
};

void add_segment_options(CLI::App& command, SegmentArguments& arguments);

// Finds the leaflets in the volume, which was read from arguments.volume; tells of phases on a terminal and
// prints what was found, with warnings. Throws InputError that names the file.
Segmentation find_leaflets(const SegmentArguments& arguments, const Volume& volume);

// The volume of a file [mm], with warnings printed; frame_option: by which a user chooses the frame.
Volume printed_volume(const std::string& path, const std::optional<int>& frame,
                      const std::string& frame_option = "--frame");

}  // namespace coapt::cli
