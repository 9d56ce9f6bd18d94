// scenes/command_tree.cpp - reads the option tree of CLI11.
#include "scenes/command_tree.h"
#include <algorithm>
#include <cctype>

namespace skred {
namespace {

using Kind = ValueHint::Kind;

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == separator) parts.emplace_back();
    else parts.back() += c;
  }
  return parts;
}

std::string one_line(std::string text) {
  text.erase(std::find(text.begin(), text.end(), '\n'), text.end());
  return text;
}

bool is_placeholder(const std::string& word) {
  return std::none_of(word.begin(), word.end(), [](unsigned char c) { return std::islower(c); });
}

// Choices inside the braces of a validator's description: {a,b} of a set, {a->1,b->2} of a map.
std::vector<std::string> listed_choices(const std::string& type) {
  const auto open = type.find('{'), close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos || close == open + 1) return {};
  auto choices = split(type.substr(open + 1, close - open - 1), ',');
  for (auto& choice : choices) choice = choice.substr(0, choice.find("->"));
  return choices;
}

// CLI11 keeps validators to itself, but the type name that its help shows carries their descriptions: "TEXT:{sdem,ndem}".
ValueHint hint(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto parts = split(type, ':');
  ValueHint hint{.kind = Kind::nothing, .choices = listed_choices(type), .name = parts.front()};
  if (hint.choices.empty() && hint.name.find('|') != std::string::npos) {
    hint.choices = split(hint.name, '|');
    std::erase_if(hint.choices, is_placeholder);
  }
  const auto has = [&](std::initializer_list<const char*> names) {
    return std::find_first_of(parts.begin(), parts.end(), names.begin(), names.end()) != parts.end();
  };
  if (!hint.choices.empty()) hint.kind = Kind::choices;
  else if (has({"SCENE"}) || CLI::detail::to_lower(option.get_name(true)) == "scene") hint.kind = Kind::scenes;
  else if (has({"DIR"})) hint.kind = Kind::folders;
  else if (has({"TEXT", "FILE", "PATH", "PATH(existing)", "PATH(non-existing)"})) hint.kind = Kind::files;
  return hint;
}

void collect_options(const CLI::App& app, Command& command) {
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_group().empty()) continue;
    const bool many = option->get_expected_max() > 1 || option->get_multi_option_policy() == CLI::MultiOptionPolicy::TakeAll;
    if (option->nonpositional()) {
      CommandOption out{.description = one_line(option->get_description()), .takes_value = option->get_items_expected_max() > 0,
                        .repeatable = many};
      for (const auto& name : option->get_snames()) out.names.push_back("-" + name);
      for (const auto& name : option->get_lnames()) out.names.push_back("--" + name);
      if (out.takes_value) out.value = hint(*option);
      command.options.push_back(std::move(out));
    }
    if (option->get_positional()) {
      command.arguments.push_back(hint(*option));
      command.last_argument_repeats = many;
    }
  }
}

void collect(const CLI::App& app, Command& command) {
  collect_options(app, command);
  for (const CLI::App* child : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (child->get_disabled() || child->get_group().empty()) continue;
    if (child->get_name().empty()) {   // an option group
      collect(*child, command);
      continue;
    }
    Command sub{.path = command.path, .description = one_line(child->get_description())};
    sub.path.push_back(child->get_name());
    collect(*child, sub);
    command.subcommands.push_back(std::move(sub));
  }
}

}  // namespace

Command command_tree(const CLI::App& app) {
  Command root{.description = one_line(app.get_description())};
  collect(app, root);
  return root;
}

}  // namespace skred
