#include "fuzz/fuzz_target.hpp"

#include <fstream>
#include <unistd.h>

namespace coapt::fuzz {

Scratch::Scratch()
    : folder_(std::filesystem::temp_directory_path() / ("coapt-fuzz-" + std::to_string(::getpid()))) {
  std::filesystem::create_directories(folder_);
}

Scratch::~Scratch() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

std::filesystem::path Scratch::write(const std::string& name, std::string_view bytes) const {
  std::filesystem::remove(folder_ /
                          name);  // a file that is cut to nothing and written again waits for the disk
  std::ofstream file(folder_ / name, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error("cannot write " + (folder_ / name).string());
  return folder_ / name;
}

}  // namespace coapt::fuzz
