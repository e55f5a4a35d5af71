// Files that went through an accident, by a fixed sequence.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace coapt::fuzz {

// The damaged copy number `index` of one of the seeds: bytes changed, cut out, doubled or put in, words that
// readers stumble over, the end of another seed; every other copy of a tree is changed as a tree
// (changed_tree.hpp), of a volume in its header (changed_header.hpp). The same for the same seeds and index,
// on every machine. Pre: at least one seed.
std::string damaged(const std::vector<std::string>& seeds, std::size_t index);

}  // namespace coapt::fuzz
