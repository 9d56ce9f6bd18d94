// scenes/node.h - a YAML document as a tree that remembers where everything was written.
//
// Built from yaml-cpp's events, since its own tree accepts a key given twice and forgets where keys and quotes stood.
// The same tree is written back as YAML (resolved scenes) and as JSON (the schema).
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include "scenes/diagnostic.h"

namespace skred {

struct Node {
  enum class Kind { nothing, scalar, list, map };
  struct Entry;

  Kind kind = Kind::nothing;
  std::string text;              // scalar
  bool quoted = false;           // scalar: a string in quotes, never a number
  Mark at;
  std::vector<Node> items;       // list
  std::vector<Entry> entries;    // map, in the order written

  const Entry* find(std::string_view key) const;   // nullptr if there is none
  Entry* find(std::string_view key);
};

struct Node::Entry { std::string key; Mark at; Node value; };

Node plain(std::string text);                            // true, auto, ...
Node text_node(std::string text);                        // a string
Node number_node(double value);                          // reads back as the same bits; .inf for infinity
Node list_node(std::vector<Node> items);
Node map_node(std::vector<std::pair<std::string, Node>> entries);

std::string number_text(double value);                   // shortest decimal that reads back as the same bits

// The document in `text`, which is source `source` of `diagnostics`. Errors - syntax, a key given twice, more than one
// document - are added there. An empty document gives Kind::nothing.
Node parse_yaml(const std::string& text, int source, Diagnostics& diagnostics);

std::string to_yaml(const Node&);                        // block style; lists of scalars on one line
std::string to_yaml_line(const Node&);                   // flow style, no line break
std::string to_json(const Node&);                        // indented by two

}  // namespace skred
