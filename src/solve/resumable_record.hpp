// Work that a file keeps while it goes on, and that is taken up again from there: what it is of, and how far
// it has come.
#pragma once

#include "core/types.hpp"
#include "formats/json/checksummed_cbor.hpp"
#include "optim/solver.hpp"
#include "solve/work_identity.hpp"

#include <filesystem>
#include <functional>
#include <vector>

namespace coapt {

// The file appears whole or not at all, and is on the disk when this returns. Throws InputError where it
// cannot be written.
void write_record(const std::filesystem::path& path, const Seal& seal, const Identity& identity,
                  const Json& record);

// `take` reads the record; whatever it throws is told as an InputError of the file. Throws InputError where
// there is no file, where it is none of these, damaged, cut off or of another format, and, with all that
// differs, where it is of other work.
void read_record(const std::filesystem::path& path, const Seal& seal, const Identity& identity,
                 const std::function<void(const Json&)>& take);

// Parts of a record. What is none of these throws an exception of the JSON library or std::domain_error.
std::vector<double> numbers_of(const Eigen::Ref<const Vector>& values);
Vector vector_of(const Json& json);  // finite
Points points_of(const Json& json);  // finite, from 3 x n numbers in a row
Status status_of(const Json& json);  // from its name

}  // namespace coapt
