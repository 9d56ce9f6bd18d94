#include "scenes/thread_option.h"
#include <algorithm>
#include <fmt/format.h>
#include "scenes/errors.h"
#include "tasks/simulation.h"

namespace skred {

int parse_threads(const std::string& text, std::string& reason) {
  if (text == "auto") {
    const ThreadChoice c = automatic_threads();
    reason = c.reason;
    return c.threads;
  }
  std::size_t end = 0;
  long n = 0;
  try {
    n = std::stol(text, &end);
  } catch (const std::exception&) {
  }
  if (end != text.size() || n < 1 || n > most_threads)
    throw UsageError(fmt::format("--threads: '{}' is not allowed: 1 .. {} or 'auto'", text, most_threads));
  return static_cast<int>(n);
}

std::vector<int> parse_thread_list(const std::string& text) {
  std::vector<int> out;
  std::string reason;
  for (const std::string& word : split_list(text)) out.push_back(parse_threads(word, reason));
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

std::vector<std::string> split_list(const std::string& text) {
  std::vector<std::string> out(1);
  for (const char c : text) {
    if (c == ',') out.emplace_back();
    else out.back() += c;
  }
  return out;
}

}  // namespace skred
