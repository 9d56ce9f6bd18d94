// tests/scenes/scene_tool.cpp - for schema_check.py: the schema, scenes as JSON, and what the reader says of them.
#include <fstream>
#include <iostream>
#include <sstream>
#include "scenes/node.h"
#include "scenes/read_scene.h"
#include "scenes/schema.h"

using namespace skred;

// scene_tool schema | json FILE | check FILE | resolve FILE
int main(int argc, char** argv) {
  const std::string verb = argc > 1 ? argv[1] : "", path = argc > 2 ? argv[2] : "";
  try {
    if (verb == "schema") std::cout << json_schema();
    if (verb == "check") read_scene(path);
    if (verb == "resolve") std::cout << resolved_yaml(read_scene(path));
    if (verb == "json") {
      std::ostringstream text;
      text << std::ifstream(path).rdbuf();
      Diagnostics d;
      const Node root = parse_yaml(text.str(), d.add_file(path, text.str()), d);
      d.throw_if_any();
      std::cout << to_json(root);
    }
    return 0;
  } catch (const SceneError& e) {
    std::cerr << e.what() << "\n";
    return 3;
  }
}
