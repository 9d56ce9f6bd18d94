// scenes/overrides.cpp - finds the place that a dotted path means.
#include "scenes/overrides.h"
#include <algorithm>
#include <charconv>
#include <stdexcept>

namespace skred {

std::vector<std::string> split_path(const std::string& path) {
  std::vector<std::string> out(1);
  for (const char c : path) {
    if (c == '.') out.emplace_back();
    else out.back() += c;
  }
  return out;
}

namespace {

bool among(const std::vector<std::string>& all, const std::string& word) {
  return std::find(all.begin(), all.end(), word) != all.end();
}

std::vector<std::string> keys_of(const Node& map) {
  std::vector<std::string> out;
  for (const Node::Entry& e : map.entries) out.push_back(e.key);
  return out;
}

// The item of a list by index or by its `name`. Throws std::invalid_argument.
Node& item_of(Node& list, const std::string& word, const std::string& where) {
  std::vector<std::string> names;
  for (Node& item : list.items)
    if (Node::Entry* name = item.find("name")) {
      if (name->value.text == word) return item;
      names.push_back(name->value.text);
    }
  std::size_t index = 0;
  const auto read = std::from_chars(word.data(), word.data() + word.size(), index);
  if (read.ec == std::errc() && read.ptr == word.data() + word.size()) {
    if (index < list.items.size()) return list.items[index];
    throw std::invalid_argument(where + " has " + std::to_string(list.items.size()) +
                                " items, counted from 0; there is no " + word);
  }
  throw std::invalid_argument(where + " has no item '" + word + "'" + suggestion(word, names));
}

// Keys that are not there are added with the mark of the option, so that an unknown one is reported as the option's error.
Node& descend(Node& root, const std::vector<std::string>& words, Mark option) {
  Node* at = &root;
  std::string where;
  for (const std::string& word : words) {
    if (at->kind == Node::Kind::nothing) at->kind = Node::Kind::map;
    if (at->kind == Node::Kind::scalar)
      throw std::invalid_argument(where + " is the value '" + at->text + "'; there is no '" + word + "' in it");
    if (at->kind == Node::Kind::list) {
      at = &item_of(*at, word, where);
    } else {
      if (!at->find(word)) {
        at->entries.push_back({word, option, {}});
        at->entries.back().value.at = option;
      }
      at = &at->find(word)->value;
    }
    where += (where.empty() ? "" : ".") + word;
  }
  return *at;
}

// The words of a path, with `parameters` before a parameter's name. Throws std::invalid_argument.
std::vector<std::string> full_path(const Node& root, const std::string& path, const std::vector<std::string>& top_level) {
  std::vector<std::string> words = split_path(path);
  if (among(words, "")) throw std::invalid_argument("a path is keys joined by dots");
  const Node::Entry* parameters = root.find("parameters");
  const std::vector<std::string> names = parameters ? keys_of(parameters->value) : std::vector<std::string>();
  if (!among(top_level, words[0])) {
    if (words.size() > 1 || !among(names, words[0])) {
      std::vector<std::string> known = names;
      known.insert(known.end(), top_level.begin(), top_level.end());
      throw std::invalid_argument("there is no key or parameter '" + words[0] + "'" + suggestion(words[0], known));
    }
    words.insert(words.begin(), "parameters");
  }
  if (words[0] != "parameters" || words.size() < 2) return words;
  if (!among(names, words[1]))
    throw std::invalid_argument("there is no parameter '" + words[1] + "'" + suggestion(words[1], names));
  if (words.size() == 2 && parameters->value.find(words[1])->value.kind == Node::Kind::map) words.push_back("value");
  return words;
}

}  // namespace

void set_path(Node& root, const std::string& path, Node value, const std::vector<std::string>& top_level,
              Diagnostics& diagnostics) {
  const Mark at = value.at;
  try {
    descend(root, full_path(root, path, top_level), at) = std::move(value);
  } catch (const std::invalid_argument& e) {
    diagnostics.error(at, e.what());
  }
}

}  // namespace skred
