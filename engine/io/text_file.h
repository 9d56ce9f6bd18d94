// engine/io/text_file.h - a text file that is either whole or not there.
#pragma once
#include <filesystem>
#include <string_view>

namespace skred {

enum class Sync { no, yes };             // wait until the disk has it: survives a power cut, costs milliseconds

// Writes beside the file under the name "PATH.tmp" and renames: a reader, and a run that is killed, see the old text or the
// new one. Throws IoError with the system's reason; the old file then stays.
void write_text_atomically(const std::filesystem::path& path, std::string_view text, Sync sync = Sync::yes);

}  // namespace skred
