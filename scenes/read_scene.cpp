// scenes/read_scene.cpp - text, then tree, then overrides, then parameters, then the table of keys.
#include "scenes/read_scene.h"
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include "scenes/overrides.h"
#include "scenes/schema.h"

namespace skred {
namespace {

struct Option { std::string shown, path, value; };

std::vector<Option> all_options(const ReadOptions& o) {
  std::vector<Option> out;
  for (const auto& [path, value] : o.overrides) out.push_back({"--set " + path + "=" + value, path, value});
  const auto add = [&](const char* flag, const char* path, const std::optional<std::string>& value) {
    if (value) out.push_back({std::string(flag) + " " + *value, path, *value});
  };
  add("--method", "method", o.method);
  add("--time-step", "time_step", o.time_step);
  if (o.time_step) out.push_back({"--time-step " + *o.time_step, "solver.time_step", "same"});   // an option goes before the file
  add("--end-time", "end_time", o.end_time);
  add("--seed", "seed", o.seed);
  return out;
}

// Everything in the tree of an option stands at the option.
void mark_all(Node& node, Mark at) {
  node.at = at;
  for (Node& i : node.items) mark_all(i, at);
  for (Node::Entry& e : node.entries) { e.at = at; mark_all(e.value, at); }
}

void apply(const std::vector<Option>& options, Node& root, const std::vector<std::string>& top_level, Diagnostics& diagnostics) {
  for (const Option& o : options) {
    const int source = diagnostics.add_option(o.shown);
    const std::size_t errors = diagnostics.count();
    Node value = parse_yaml(o.value, source, diagnostics);
    if (diagnostics.count() != errors) continue;
    mark_all(value, {source, 0, 0});
    set_path(root, o.path, std::move(value), top_level, diagnostics);
  }
}

// The file's name without its ending, as far as a name allows.
std::string default_name(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && !std::strchr("-_.", c)) c = '-';
  return name.empty() ? "scene" : name;
}

}  // namespace

Scene parse_scene(const std::string& text, const std::string& path, const ReadOptions& options) {
  Diagnostics diagnostics;
  const int file = diagnostics.add_file(path, text);
  Node root = parse_yaml(text, file, diagnostics);
  diagnostics.throw_if_any();
  if (root.kind == Node::Kind::nothing) diagnostics.error({file, 0, 0}, "the scene is empty");
  else if (root.kind != Node::Kind::map) diagnostics.error(root.at, "a scene is a mapping of keys, not " + what_it_is(root));
  diagnostics.throw_if_any();

  std::vector<std::string> top_level;
  for (const auto& k : scene_keys().keys) top_level.push_back(k.name);
  apply(all_options(options), root, top_level, diagnostics);
  Reader reader(diagnostics, std::filesystem::path(path).parent_path());
  if (const Node::Entry* parameters = root.find("parameters")) reader.read_parameters(parameters->value, top_level);
  Scene scene;
  scene.file = path;
  scene_keys().read(reader, root, scene, false);
  diagnostics.throw_if_any();
  scene.parameters = reader.number_parameters();
  if (scene.name.empty()) scene.name = default_name(path);
  return scene;
}

Scene read_scene(const std::string& path, const ReadOptions& options) {
  const auto fail = [&](const std::string& why) { return SceneError({{path, "cannot read the scene: " + why, "", 0}}); };
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) throw fail("it is a folder");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw fail(std::strerror(errno));
  std::ostringstream text;
  text << in.rdbuf();
  if (in.bad()) throw fail(std::strerror(errno));
  return parse_scene(text.str(), path, options);
}

}  // namespace skred
