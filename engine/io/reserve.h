// engine/io/reserve.h - asks for disk space before a file is touched.
#pragma once
#include <cstddef>
#include <string>

namespace skred {

// Makes sure that a file can grow by `bytes`: the blocks are set aside behind its end, its size stays. Throws IoError
// "FILE: cannot write ACTION: No space left on device (...)" on a full disk or a used-up quota, with the file unharmed. Where the
// file system cannot set space aside, the free space is compared.
void reserve_space(const std::string& file, std::size_t bytes, const std::string& action);

}  // namespace skred
