// Runs a target on every file of its corpus and on damaged copies of them, without a fuzzing engine.
//   fuzz_NAME FOLDER COUNT [FIRST]     COUNT damaged copies, from number FIRST on
//   fuzz_NAME FILE                     one input, as an engine left it
// The input that is running lies in fuzz_NAME.FIRST.input; it stays there when the process dies of it.
#include "core/error.hpp"
#include "fuzz/damage.hpp"
#include "fuzz/fuzz_target.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr double kLongest = 20;  // of one input [s], under sanitizers on a crowded machine

std::string content(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Tally {
  long read = 0, refused = 0;
};

// False where the target broke a promise, threw what it must not, or took too long.
bool holds(const std::string& name, const std::string& bytes, const fs::path& keep, Tally& tally) {
  fs::remove(keep);  // faster than to cut it to nothing and write it again
  std::ofstream(keep, std::ios::binary) << bytes;
  const auto start = std::chrono::steady_clock::now();
  std::string defect;
  try {
    coapt::fuzz::run_target(bytes);
    ++tally.read;
  } catch (const coapt::InputError& error) {
    ++tally.refused;
    if (error.defects().empty()) defect = "refused without a reason";
  } catch (const std::exception& error) {
    defect = error.what();
  }
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (defect.empty() && seconds > kLongest) defect = "took " + std::to_string(seconds) + " s";
  if (defect.empty()) return true;
  std::printf("%s: %s; its bytes are in %s\n", name.c_str(), defect.c_str(), keep.string().c_str());
  return false;
}

std::vector<fs::path> files_of(const fs::path& folder) {
  std::vector<fs::path> paths;
  for (const auto& entry : fs::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}

int replay(const fs::path& keep, const fs::path& where, std::size_t count, std::size_t first) {
  Tally tally;
  std::vector<std::string> seeds;
  for (const fs::path& path : fs::is_directory(where) ? files_of(where) : std::vector{where}) {
    seeds.push_back(content(path));
    if (!holds(path.string(), seeds.back(), keep, tally)) return 1;
  }
  if (seeds.empty()) {
    std::printf("%s holds no seed\n", where.string().c_str());
    return 1;
  }
  if (fs::is_directory(where) && tally.read == 0) {
    std::printf("%s: no seed is read, so that no reader gets far\n", where.string().c_str());
    return 1;
  }
  for (std::size_t k = first; k < first + count; ++k)
    if (!holds("damaged copy " + std::to_string(k), coapt::fuzz::damaged(seeds, k), keep, tally)) return 1;
  std::printf("%ld read, %ld refused\n", tally.read, tally.refused);
  std::printf("stat::number_of_executed_units: %ld\n", tally.read + tally.refused);  // as libFuzzer says it
  fs::remove(keep);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::printf("usage: %s FOLDER COUNT [FIRST], or %s FILE\n", argv[0], argv[0]);
    return 2;
  }
  const auto number = [&](int k) { return argc > k ? std::strtoul(argv[k], nullptr, 10) : 0; };
  const std::string keep = fs::path(argv[0]).filename().string() + "." + std::to_string(number(3)) + ".input";
  return replay(keep, argv[1], number(2), number(3));
}
