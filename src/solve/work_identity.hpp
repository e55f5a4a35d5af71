// By what work is recognised that a file keeps while it goes on.
#pragma once

#include <string>
#include <vector>

namespace coapt {

// What work has in common with that which takes it up.
struct IdentityItem {
  std::string key;          // "tolerance"
  std::string value;        // as text; of a file its fingerprint
  std::string remedy = {};  // "give the same with --tolerance"
  bool is_fingerprint = false;
};
using Identity = std::vector<IdentityItem>;

}  // namespace coapt
