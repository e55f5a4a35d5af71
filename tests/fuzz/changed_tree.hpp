// Inputs that are trees, changed as trees: what comes out is well-formed, so that it passes the parser and
// tries what reads the tree.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace coapt::fuzz {

// JSON (with comments) or CBOR with one to four of its places changed: a value replaced by a word or by
// another value of the tree or put in a list, an entry left out, doubled or called by another key of the
// tree, a number moved a little, far or across zero. In the form of the input, JSON without its comments.
// Empty where the input is neither, is too long or nested too deep to be copied by recursion. The same for
// the same input and seed, on every machine.
std::string changed_tree(std::string_view text, std::size_t seed);

}  // namespace coapt::fuzz
