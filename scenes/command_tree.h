// scenes/command_tree.h - what completion knows of a command line: its commands, options and the values they take.
#pragma once
#include <string>
#include <vector>
#include <CLI/CLI.hpp>

namespace skred {

// What a shell can offer for a value; choices where there are any.
struct ValueHint {
  enum class Kind { nothing, choices, files, folders, scenes } kind = Kind::nothing;
  std::vector<std::string> choices;
  std::string name;                 // placeholder for messages, e.g. "FLOAT"
};

struct CommandOption {
  std::vector<std::string> names;   // as typed: "-m", "--method"
  std::string description;          // one line
  bool takes_value = false;
  bool repeatable = false;
  ValueHint value;
};

struct Command {
  std::vector<std::string> path;    // subcommands from the root, e.g. {"run"}; empty for the program itself
  std::string description;
  std::vector<CommandOption> options;
  std::vector<ValueHint> arguments; // positional, in order
  bool last_argument_repeats = false;
  std::vector<Command> subcommands;
};

// Without the hidden (empty group) and the disabled; members of option groups count as the command's own.
Command command_tree(const CLI::App& app);

}  // namespace skred
