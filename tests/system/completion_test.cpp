// tests/system/completion_test.cpp - the completion scripts of a small command line, exercised in the shells themselves.
#include "engine/io/temporary_folder.h"
#include "scenes/completion.h"
#include <gmock/gmock.h>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <CLI/CLI.hpp>

using namespace skred;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::UnorderedElementsAre;

namespace {

// A folder of its own with a.yaml, b.txt and the folder sub; gone at the end.
struct Completion : testing::Test {
  CLI::App app{"toy: it's [one] tool", "toy"};
  std::string method, text, where, scene, shell;
  std::vector<std::string> overrides;
  int count = 0;
  double time = 0;
  bool quiet = false;
  TemporaryFolder own;
  const std::filesystem::path& folder = own.path;

  Completion() {
    auto* run = app.add_subcommand("run", "run a scene: the user's [choice]");
    run->add_option("scene", scene, "scene file");
    run->add_option("-m,--method", method, "which method")->check(CLI::IsMember({"sdem", "ndem"}));
    run->add_option("--threads", text, "threads")->type_name("N|auto|half");
    run->add_option("--end-time", time, "last time [s]");
    run->add_option("--set", overrides, "override")->type_name("PATH=VALUE")->expected(1)->take_all();
    run->add_option("--output", where, "folder")->type_name("DIR");
    run->add_option("--summary", text, "file");
    run->add_flag("-q,--quiet", quiet, "say less");
    run->add_option("--secret", count, "not shown")->group("");
    auto* completion = app.add_subcommand("completion", "print a script");
    completion->add_option("shell", shell, "which")->check(CLI::IsMember({"bash", "zsh"}));
    auto* list = app.add_subcommand("list", "lists");
    list->add_subcommand("models", "contact models");
    list->add_subcommand("units", "units")->add_option("--of", text, "kind")->type_name("time|mass");
    app.add_subcommand("internal", "not shown")->group("");

    std::filesystem::create_directory(folder / "sub");
    std::ofstream(folder / "a.yaml"), std::ofstream(folder / "b.txt");
  }

  // Lines that `program FILE` prints in the folder, FILE holding `script`; a failing shell is a failed test.
  std::vector<std::string> lines_of(const std::string& program, const std::string& script) const {
    std::ofstream(folder / ".script") << script;
    const std::string command = "cd " + folder.string() + " && " + program + " .script 2>&1";
    std::vector<std::string> lines;
    FILE* pipe = popen(command.c_str(), "r");
    for (char line[4096]; std::fgets(line, sizeof line, pipe);) lines.emplace_back(line, std::string_view(line).find('\n'));
    EXPECT_EQ(pclose(pipe), 0) << testing::PrintToString(lines);
    return lines;
  }

  // What bash would offer at the end of the words, given as bash splits them; compopt, which works only under a keyboard,
  // prints what it is asked.
  std::vector<std::string> bash(const std::string& words) const {
    return lines_of("bash", completion_script(app, "bash") + "set -u\ncompopt() { echo \"compopt $2\"; }\n" +
                                "COMP_WORDS=(" + words + ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_toy\n" +
                                "for reply in ${COMPREPLY[@]+\"${COMPREPLY[@]}\"}; do echo \"$reply\"; done\n");
  }
  std::vector<std::string> fish(const std::string& line) const {
    return lines_of("fish --no-config",
                    completion_script(app, "fish") + "complete -C '" + line + "' | string split -f 1 \\t\ntrue\n");
  }
  static bool installed(const std::string& shell) { return std::system(("command -v " + shell + " >/dev/null").c_str()) == 0; }
};

TEST_F(Completion, BashOffersSubcommands) {
  EXPECT_THAT(bash("toy ''"), UnorderedElementsAre("run", "completion", "list"));
  EXPECT_THAT(bash("./toy r"), ElementsAre("run"));
  EXPECT_THAT(bash("toy list ''"), UnorderedElementsAre("models", "units"));
  EXPECT_THAT(bash("toy list units ''"), IsEmpty());
}

TEST_F(Completion, BashOffersOptionsOfTheSubcommand) {
  EXPECT_THAT(bash("toy run --"), UnorderedElementsAre("--help", "--method", "--threads", "--end-time", "--set", "--output",
                                                       "--summary", "--quiet"));
  EXPECT_THAT(bash("toy run -"), testing::Contains("-m"));
  EXPECT_THAT(bash("toy run x.yaml --me"), ElementsAre("--method"));
  EXPECT_THAT(bash("toy list units --o"), ElementsAre("--of"));
  EXPECT_THAT(bash("toy --me"), IsEmpty());
}

TEST_F(Completion, BashOffersChoicesOfAValue) {
  EXPECT_THAT(bash("toy run --method ''"), ElementsAre("sdem", "ndem"));
  EXPECT_THAT(bash("toy run -m n"), ElementsAre("ndem"));
  EXPECT_THAT(bash("toy run --method ="), ElementsAre("sdem", "ndem"));
  EXPECT_THAT(bash("toy run --method = s"), ElementsAre("sdem"));
  EXPECT_THAT(bash("toy run --threads ''"), ElementsAre("auto", "half"));
  EXPECT_THAT(bash("toy completion b"), ElementsAre("bash"));
  EXPECT_THAT(bash("toy list units --of ''"), ElementsAre("time", "mass"));
}

TEST_F(Completion, BashOffersFilesWhereTheyBelong) {
  EXPECT_THAT(bash("toy run ''"), UnorderedElementsAre("compopt filenames", "a.yaml", "sub"));
  EXPECT_THAT(bash("toy run --quiet ''"), UnorderedElementsAre("compopt filenames", "a.yaml", "sub"));
  EXPECT_THAT(bash("toy run --summary ''"), ElementsAre("compopt default"));
  EXPECT_THAT(bash("toy run --output ''"), ElementsAre("compopt dirnames"));
  EXPECT_THAT(bash("toy run --end-time ''"), IsEmpty());
  EXPECT_THAT(bash("toy run a.yaml ''"), IsEmpty());
}

TEST_F(Completion, BashCountsAWordSplitAtASignOnce) {
  EXPECT_THAT(bash("toy run --set a = 10 a"), ElementsAre("compopt filenames", "a.yaml"));
  EXPECT_THAT(bash("toy run --set = a = 10 a"), ElementsAre("compopt filenames", "a.yaml"));
  EXPECT_THAT(bash("toy run --set a : b a"), ElementsAre("compopt filenames", "a.yaml"));
  EXPECT_THAT(bash("toy run --set a = 1"), IsEmpty());
  EXPECT_THAT(bash("toy run --set a ="), IsEmpty());
}

TEST_F(Completion, BashScriptRegistersTheFunction) {
  EXPECT_THAT(lines_of("bash", completion_script(app, "bash") + "complete -p toy\n"), ElementsAre("complete -F _toy toy"));
}

TEST_F(Completion, FishOffersTheSame) {
  if (!installed("fish")) GTEST_SKIP() << "fish is not installed";
  EXPECT_THAT(fish("toy "), UnorderedElementsAre("run", "completion", "list"));
  EXPECT_THAT(fish("toy list "), UnorderedElementsAre("models", "units"));
  EXPECT_THAT(fish("toy run --me"), ElementsAre("--method"));
  EXPECT_THAT(fish("toy run --method "), UnorderedElementsAre("sdem", "ndem"));
  EXPECT_THAT(fish("toy run --threads="), UnorderedElementsAre("--threads=auto", "--threads=half"));
  EXPECT_THAT(fish("toy run --output "), ElementsAre("sub/"));
  EXPECT_THAT(fish("toy run --end-time "), IsEmpty());
  EXPECT_THAT(fish("toy run "), testing::Contains("a.yaml"));
  EXPECT_THAT(fish("toy completion "), UnorderedElementsAre("bash", "zsh"));
}

TEST_F(Completion, ZshScriptParsesAndDescribes) {
  const std::string script = completion_script(app, "zsh");
  EXPECT_THAT(script, testing::StartsWith("#compdef toy\n"));
  EXPECT_THAT(script, HasSubstr("'run:run a scene: the user'\\''s [choice]'"));
  EXPECT_THAT(script, HasSubstr("'(-m --method)--method=[which method]:TEXT:(sdem ndem)'"));
  EXPECT_THAT(script, HasSubstr("'(--end-time)--end-time=[last time \\[s\\]]:FLOAT: '"));
  EXPECT_THAT(script, HasSubstr("'*--set=[override]:PATH=VALUE: '"));
  EXPECT_THAT(script, HasSubstr("'1:TEXT:_files -g \"*.yaml\"'"));
  EXPECT_THAT(script, Not(HasSubstr("secret")));
  if (!installed("zsh")) GTEST_SKIP() << "zsh is not installed";
  EXPECT_THAT(lines_of("zsh -f -n", script), IsEmpty());
  // Evaluated in a running shell, as the user does, it registers the function for the program.
  const std::string prologue = "autoload -Uz compinit && compinit -D -u\n";
  EXPECT_THAT(lines_of("zsh -f", prologue + script + "echo $_comps[toy]\n"), ElementsAre("_toy"));
}

TEST_F(Completion, UnknownShellIsNamed) {
  try {
    completion_script(app, "tcsh");
    FAIL() << "no error";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "completion for 'tcsh' is not known; choose bash, zsh or fish");
  }
}

}  // namespace
