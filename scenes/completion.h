// scenes/completion.h - command-line completion for bash, zsh and fish, made from the option tree of CLI11.
//
// CLI11 2.1 has none of its own. What is offered after an option or as an argument follows from what CLI11 shows in its help:
//   CLI::IsMember, or a type name with alternatives ("sdem|ndem")    the choices; upper-case alternatives ("N|auto") are
//                                                                    placeholders and left out
//   type name or argument "SCENE"                                    files *.yaml, and folders on the way to them
//   type name DIR, CLI::ExistingDirectory                            folders
//   type name TEXT, FILE or PATH, CLI::ExistingFile                  files
//   any other type name (FLOAT, SECONDS, ...)                        nothing
#pragma once
#include <string>
#include <CLI/CLI.hpp>

namespace skred {

// A script for `shell` ("bash", "zsh" or "fish"; anything else throws std::invalid_argument) that completes the program named
// app.get_name(): its subcommands at any depth, their options, option values and arguments. Hidden and disabled ones are left
// out. The user evaluates it: eval "$(skred completion bash)", eval "$(skred completion zsh)", skred completion fish | source.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace skred
