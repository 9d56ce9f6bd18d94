// scenes/node.cpp - from YAML text to the tree.
#include "scenes/node.h"
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

namespace skred {
namespace {

std::size_t size_of(const Node& n) {
  std::size_t count = 1;
  for (const Node& i : n.items) count += size_of(i);
  for (const Node::Entry& e : n.entries) count += size_of(e.value);
  return count;
}

class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(int source, Diagnostics& diagnostics) : source_(source), diagnostics_(diagnostics) {}
  Node root;

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    Node n;
    n.at = at(mark);
    finish({std::move(n), anchor, {}, false});
  }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, const std::string& value) override {
    Node n = plain(value);
    n.quoted = tag == "!";                                   // yaml-cpp's tag of a scalar in quotes or of a block
    n.at = at(mark);
    finish({std::move(n), anchor, {}, false});
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    constexpr std::size_t most = 1'000'000;                  // nested aliases grow without bound
    Node n;
    if (const auto found = anchors_.find(anchor); found == anchors_.end()) {
      diagnostics_.error(at(mark), "this alias stands inside of what it stands for");
    } else if ((copied_ += size_of(found->second)) > most) {
      throw YAML::ParserException(mark, "the aliases stand for more than a million values");
    } else {
      n = found->second;
    }
    n.at = at(mark);
    finish({std::move(n), 0, {}, false});
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    start(mark, anchor, Node::Kind::list);
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, YAML::EmitterStyle::value) override {
    start(mark, anchor, Node::Kind::map);
  }
  void OnSequenceEnd() override { end(); }
  void OnMapEnd() override { end(); }

 private:
  struct Open { Node node; YAML::anchor_t anchor; std::string key; bool has_key; Mark key_at = {}; };

  Mark at(const YAML::Mark& mark) const { return {source_, mark.line, mark.column}; }
  void start(const YAML::Mark& mark, YAML::anchor_t anchor, Node::Kind kind) {
    Node n;
    n.kind = kind;
    n.at = at(mark);
    open_.push_back({std::move(n), anchor, {}, false});
  }
  void end() {
    Open done = std::move(open_.back());
    open_.pop_back();
    finish(std::move(done));
  }
  void finish(Open done) {
    if (done.anchor) anchors_[done.anchor] = done.node;
    if (open_.empty()) { root = std::move(done.node); return; }
    Open& parent = open_.back();
    if (parent.node.kind == Node::Kind::list) {
      parent.node.items.push_back(std::move(done.node));
    } else if (!parent.has_key) {
      if (done.node.kind != Node::Kind::scalar) diagnostics_.error(done.node.at, "a key must be a word");
      parent.key = done.node.text;
      parent.key_at = done.node.at;
      parent.has_key = true;
    } else {
      parent.has_key = false;
      if (const Node::Entry* first = parent.node.find(parent.key)) {
        diagnostics_.error(parent.key_at, "key '" + parent.key + "' is given twice, first in line " +
                                              std::to_string(first->at.line + 1));
        return;
      }
      parent.node.entries.push_back({std::move(parent.key), parent.key_at, std::move(done.node)});
    }
  }

  int source_;
  Diagnostics& diagnostics_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, Node> anchors_;
  std::size_t copied_ = 0;
};

}  // namespace

const Node::Entry* Node::find(std::string_view key) const {
  for (const Entry& e : entries)
    if (e.key == key) return &e;
  return nullptr;
}
Node::Entry* Node::find(std::string_view key) { return const_cast<Entry*>(std::as_const(*this).find(key)); }

Node plain(std::string text) {
  Node n;
  n.kind = Node::Kind::scalar;
  n.text = std::move(text);
  return n;
}

Node text_node(std::string text) {
  Node n = plain(std::move(text));
  n.quoted = true;
  return n;
}

Node number_node(double value) { return plain(number_text(value)); }

Node list_node(std::vector<Node> items) {
  Node n;
  n.kind = Node::Kind::list;
  n.items = std::move(items);
  return n;
}

Node map_node(std::vector<std::pair<std::string, Node>> entries) {
  Node n;
  n.kind = Node::Kind::map;
  for (auto& [key, value] : entries) n.entries.push_back({key, {}, std::move(value)});
  return n;
}

std::string number_text(double value) {
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  char buffer[32];
  std::string text(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
  // YAML 1.1 readers, PyYAML among them, take 1e-05 for a word and 1.0e-05 for a number.
  if (const auto e = text.find('e'); e != std::string::npos && text.find('.') == std::string::npos) text.insert(e, ".0");
  return text;
}

Node parse_yaml(const std::string& text, int source, Diagnostics& diagnostics) {
  TreeBuilder builder(source, diagnostics);
  try {
    std::istringstream in(text);
    YAML::Parser parser(in);
    parser.HandleNextDocument(builder);
    Node root = std::move(builder.root);
    if (TreeBuilder rest(source, diagnostics); parser.HandleNextDocument(rest))
      diagnostics.error(rest.root.at, "a second YAML document begins here; a scene is one document");
    return root;
  } catch (const YAML::Exception& e) {
    const bool known = e.mark.line >= 0;
    diagnostics.error({source, known ? e.mark.line : 0, known ? e.mark.column : 0}, "YAML syntax: " + e.msg);
    return {};
  }
}

}  // namespace skred
