// The page of a run with pictures that whoever started it has made.
#pragma once

#include "run/run.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace coapt {

struct PageImage {
  std::filesystem::path file;  // PNG
  std::string caption;         // what it shows
};

// Writes report.html into the folder of the run again, with the pictures below the shape under this title.
// Nothing is done where the run has no page. Throws InputError for a picture that cannot be read, OutputError
// where the page cannot be written. Pre: the run wrote its files.
void write_pictured_page(const RunReport& solved, const std::string& title,
                         const std::vector<PageImage>& pictures);

}  // namespace coapt
