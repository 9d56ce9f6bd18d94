// scenes/completion.cpp - the three scripts. Each is generated whole: a user's shell never starts the program to complete it.
#include "scenes/completion.h"
#include <algorithm>
#include <cctype>
#include <functional>
#include <sstream>
#include <stdexcept>
#include "scenes/command_tree.h"

namespace skred {
namespace {

using Kind = ValueHint::Kind;

std::string join(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

// 'text' as one word of bash and zsh; fish differs in how it escapes a quote inside quotes.
std::string sh_quoted(const std::string& text) { return "'" + replaced(text, "'", "'\\''") + "'"; }
std::string fish_quoted(const std::string& text) { return "'" + replaced(replaced(text, "\\", "\\\\"), "'", "\\'") + "'"; }

std::string identifier(std::string text) {   // a part of a shell function's name
  std::replace_if(text.begin(), text.end(), [](unsigned char c) { return !std::isalnum(c); }, '_');
  return text;
}

std::vector<std::string> subcommand_names(const Command& command) {
  std::vector<std::string> names;
  for (const auto& sub : command.subcommands) names.push_back(sub.path.back());
  return names;
}

void for_each_command(const Command& command, const std::function<void(const Command&)>& visit) {
  visit(command);
  for (const auto& sub : command.subcommands) for_each_command(sub, visit);
}

// ---- bash: one function walks the words before the cursor, then offers what can stand there.

std::string bash_path(const Command& command) { return command.path.empty() ? "" : "/" + join(command.path, "/"); }

std::string bash_offer(const ValueHint& hint) {
  switch (hint.kind) {
    case Kind::choices: return "words " + sh_quoted(join(hint.choices, " "));
    case Kind::files: return "files";
    case Kind::folders: return "folders";
    case Kind::scenes: return "scenes";
    case Kind::nothing: break;
  }
  return "nothing";
}

std::string bash_script(const Command& root, const std::string& program) {
  std::ostringstream walk, values, options, arguments;   // branches of the four `case` statements below
  const auto offers = [](const std::string& pattern, const std::string& offer) {
    return "      " + pattern + ") offer=" + sh_quoted(offer) + " ;;\n";
  };
  const auto offered_words = [](const std::vector<std::string>& words) { return "words " + sh_quoted(join(words, " ")); };
  for_each_command(root, [&](const Command& command) {
    const std::string path = bash_path(command);
    std::vector<std::string> all_names;
    for (const auto& option : command.options) {
      all_names.insert(all_names.end(), option.names.begin(), option.names.end());
      if (!option.takes_value) continue;
      std::vector<std::string> patterns;
      for (const auto& name : option.names) patterns.push_back(sh_quoted(path + " " + name));
      walk << "        " << join(patterns, "|") << ") option=$word ;;\n";
      values << offers(join(patterns, "|"), bash_offer(option.value));
    }
    for (const auto& sub : command.subcommands)
      walk << "        " << sh_quoted(path + " " + sub.path.back()) << ") command=" << sh_quoted(bash_path(sub))
           << " argument=0 ;;\n";
    if (!all_names.empty()) options << offers(sh_quoted(path), offered_words(all_names));
    if (!command.subcommands.empty()) {
      arguments << offers(sh_quoted(path + " 0"), offered_words(subcommand_names(command)));
      return;
    }
    for (std::size_t k = 0; k < command.arguments.size(); ++k) {
      const bool repeats = command.last_argument_repeats && k + 1 == command.arguments.size();
      arguments << offers(sh_quoted(path + " ") + (repeats ? "*" : std::to_string(k)), bash_offer(command.arguments[k]));
    }
  });

  const std::string function = "_" + identifier(program);
  std::ostringstream out;
  out << "# Completion of " << program << " for bash. Use: eval \"$(" << program << " completion bash)\"\n"
      << function << R"bash(() {
  local current=${COMP_WORDS[COMP_CWORD]} command= option= offer=nothing argument=0 joined= word i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    word=${COMP_WORDS[i]}
    # bash splits words at = and :. After an option the sign comes before its value, elsewhere inside a word.
    if [[ $word == [=:] ]]; then [[ -n $option ]] || joined=1
    elif [[ -n $joined ]]; then joined=
    elif [[ -n $option ]]; then option=
    else
      case "$command $word" in
)bash" << walk.str() << R"bash(        *' -'*) ;;
        *) ((++argument)) ;;
      esac
    fi
  done
  [[ $current != [=:] ]] || { [[ -n $option ]] || joined=1; current=; }
  if [[ -n $joined ]]; then return
  elif [[ -n $option ]]; then
    case "$command $option" in
)bash" << values.str() << R"bash(    esac
  elif [[ $current == -* ]]; then
    case $command in
)bash" << options.str() << R"bash(    esac
  else
    case "$command $argument" in
)bash" << arguments.str() << R"bash(    esac
  fi
  case $offer in
    words*) eval "mapfile -t COMPREPLY < <(compgen -W ${offer#words } -- \"\$current\")" ;;
    files) compopt -o default ;;   # readline completes, with ~ and quotes
    folders) compopt -o dirnames ;;
    scenes)
      compopt -o filenames
      mapfile -t COMPREPLY < <(compgen -f -X '!*.yaml' -- "$current"; compgen -d -- "$current") ;;
  esac
}
complete -F )bash" << function << " " << program << "\n";
  return out.str();
}

// ---- zsh: one function per command, described to _arguments.

std::string zsh_function(const std::string& program, const Command& command) {
  std::string name = "_" + identifier(program);
  for (const auto& part : command.path) name += "_" + identifier(part);
  return name;
}

// Text inside the brackets or between the colons of an _arguments specification.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_value(const ValueHint& hint) {
  const std::string message = ":" + zsh_text(hint.name.empty() ? "value" : hint.name) + ":";
  switch (hint.kind) {
    case Kind::choices: return message + "(" + zsh_text(join(hint.choices, " ")) + ")";
    case Kind::files: return message + "_files";
    case Kind::folders: return message + "_files -/";
    case Kind::scenes: return message + "_files -g \"*.yaml\"";
    case Kind::nothing: break;
  }
  return message + " ";
}

std::string zsh_script(const Command& root, const std::string& program) {
  std::ostringstream out;
  out << "#compdef " << program << "\n"
      << "# Completion of " << program << " for zsh. Use: eval \"$(" << program << " completion zsh)\"\n";
  for_each_command(root, [&](const Command& command) {
    out << zsh_function(program, command) << "() {\n  local curcontext=\"$curcontext\" state line ret=1\n"
        << "  typeset -A opt_args\n  _arguments -C -s";
    for (const auto& option : command.options) {
      for (const auto& name : option.names) {
        const bool is_long = name.starts_with("--");
        std::string spec = option.repeatable ? "*" : "(" + join(option.names, " ") + ")";
        spec += name + (option.takes_value ? (is_long ? "=" : "+") : "") + "[" + zsh_text(option.description) + "]";
        if (option.takes_value) spec += zsh_value(option.value);
        out << " \\\n    " << sh_quoted(spec);
      }
    }
    if (!command.subcommands.empty()) {
      out << " \\\n    '1:command:->command' \\\n    '*::argument:->argument' && ret=0\n"
          << "  case $state in\n    command)\n      local -a names=(";
      for (const auto& sub : command.subcommands)
        out << "\n        " << sh_quoted(replaced(sub.path.back(), ":", "\\:") + ":" + sub.description);
      out << ")\n      _describe -t commands command names && ret=0 ;;\n    argument)\n      curcontext=\"${curcontext%:*:*}:"
          << zsh_function(program, command) << "-$line[1]:\"\n      case $line[1] in\n";
      for (const auto& sub : command.subcommands)
        out << "        " << sh_quoted(sub.path.back()) << ") " << zsh_function(program, sub) << " && ret=0 ;;\n";
      out << "      esac ;;\n  esac\n  return ret\n}\n";
      return;
    }
    for (std::size_t k = 0; k < command.arguments.size(); ++k) {
      const bool repeats = command.last_argument_repeats && k + 1 == command.arguments.size();
      out << " \\\n    " << sh_quoted((repeats ? "*" : std::to_string(k + 1)) + zsh_value(command.arguments[k]));
    }
    out << " && ret=0\n  return ret\n}\n";
  });
  // As a file on $fpath the text is the body of the function itself; evaluated, it registers it.
  const std::string function = zsh_function(program, root);
  out << "if [[ $funcstack[1] == " << function << " ]]; then " << function << " \"$@\"; "
      << "else compdef " << function << " " << program << "; fi\n";
  return out.str();
}

// ---- fish: one `complete` line per thing, under the condition that its command is being typed.

std::string fish_offer(const ValueHint& hint) {
  switch (hint.kind) {
    case Kind::choices: return " -a " + fish_quoted(join(hint.choices, " "));
    case Kind::files: return " -F";
    case Kind::folders: return " -a '(__fish_complete_directories)'";
    case Kind::scenes: return " -a '(__fish_complete_suffix .yaml)'";
    case Kind::nothing: break;
  }
  return "";
}

std::string fish_script(const Command& root, const std::string& program) {
  std::ostringstream out;
  out << "# Completion of " << program << " for fish. Use: " << program << " completion fish | source\n"
      << "complete -c " << program << " -f\n";
  for_each_command(root, [&](const Command& command) {
    std::vector<std::string> conditions;
    for (const auto& part : command.path) conditions.push_back("__fish_seen_subcommand_from " + part);
    if (!command.subcommands.empty())
      conditions.push_back("not __fish_seen_subcommand_from " + join(subcommand_names(command), " "));
    const std::string start =
        "complete -c " + program + (conditions.empty() ? "" : " -n " + fish_quoted(join(conditions, "; and ")));
    for (const auto& sub : command.subcommands)
      out << start << " -a " << fish_quoted(sub.path.back()) << " -d " << fish_quoted(sub.description) << "\n";
    for (const auto& option : command.options) {
      out << start;
      for (const auto& name : option.names) out << (name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1));
      if (option.takes_value) out << (option.value.kind == Kind::files ? " -r" : " -x") << fish_offer(option.value);
      out << " -d " << fish_quoted(option.description) << "\n";
    }
    if (command.subcommands.empty())
      for (const auto& argument : command.arguments)
        if (argument.kind != Kind::nothing) out << start << fish_offer(argument) << "\n";
  });
  return out.str();
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  const Command root = command_tree(app);
  if (shell == "bash") return bash_script(root, app.get_name());
  if (shell == "zsh") return zsh_script(root, app.get_name());
  if (shell == "fish") return fish_script(root, app.get_name());
  throw std::invalid_argument("completion for '" + shell + "' is not known; choose bash, zsh or fish");
}

}  // namespace skred
