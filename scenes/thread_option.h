// scenes/thread_option.h - what --threads takes.
#pragma once
#include <string>
#include <vector>

namespace skred {

inline constexpr int most_threads = 1024;

// "4", or "auto", which says in `reason` how it came to its number. Throws UsageError.
int parse_threads(const std::string& text, std::string& reason);

// "1,2,auto": ascending, each once. Throws UsageError.
std::vector<int> parse_thread_list(const std::string& text);

std::vector<std::string> split_list(const std::string& text);   // at the commas

}  // namespace skred
