#!/usr/bin/env bash
# tests/system/launcher_test.sh CASE - tests of ./skred on a checkout of a few files: the real launcher and package lists,
# a project without a compiler whose "program" is a shell script, and, where packages are concerned, a PATH on which
# dpkg-query, apt-get and sudo only write down what they were asked. `list` prints the cases.
set -euo pipefail

source_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
# shellcheck source=tests/system/shell_checks.sh
source "$source_root/tests/system/shell_checks.sh"
unset SKRED_BUILD_DIR
export HOME=$scratch/home XDG_CACHE_HOME=$scratch/cache
repo="$scratch/a checkout"   # with a space: paths have to be quoted everywhere
mkdir -p "$HOME" "$scratch/fake" "$repo/.ci" "$repo/scenes"

cp "$source_root/skred" "$repo/"
cp "$source_root"/.ci/packages-* "$repo/.ci/"
cat >"$repo/CMakeLists.txt" <<'END'
cmake_minimum_required(VERSION 3.22)
project(skred LANGUAGES NONE)
option(SKRED_TESTS "build the tests" ON)
add_custom_command(OUTPUT scenes/skred DEPENDS scenes/program.sh
  COMMAND sh -n ${CMAKE_SOURCE_DIR}/scenes/program.sh
  COMMAND sh -c "echo built >> compilations" COMMAND sleep 0.2
  COMMAND cp ${CMAKE_SOURCE_DIR}/scenes/program.sh scenes/skred VERBATIM)
add_custom_target(program ALL DEPENDS scenes/skred)
file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/scenes)
if(SKRED_TESTS)
  enable_testing()
  add_custom_target(tests ALL COMMAND sh -c "echo tests built >> compilations" VERBATIM)
  add_test(NAME quick COMMAND true)
  add_test(NAME long COMMAND true)
  add_test(NAME broken COMMAND false)
  set_tests_properties(long broken PROPERTIES LABELS slow)
endif()
END
cat >"$repo/scenes/program.sh" <<'END'
#!/bin/sh
[ "$1" != exit ] || exit "$2"
pwd
printf '<%s>' "$@"
END
chmod +x "$repo/scenes/program.sh"

fake() { printf '#!/bin/bash\n%s\n' "$2" >"$scratch/fake/$1"; chmod +x "$scratch/fake/$1"; }
# Everything that is asked for is installed, unless a line "Package" stands in the file named missing.
touch "$scratch/missing"
fake dpkg-query "shift 3; for p; do grep -qx \"\$p\" '$scratch/missing' || echo \"installed \$p\"; done
[[ ! -s '$scratch/missing' ]]"
fake apt-get "echo \"apt-get \$*\" >>'$scratch/asked'; [[ \$* != *install* ]] || : >'$scratch/missing'"
fake sudo "echo \"sudo \$1 \$2\" >>'$scratch/asked'; exec \"\$@\""
real_path=$PATH
export PATH=$scratch/fake:$PATH
cd "$scratch"
compilations() { grep -c '^built' "${1:-$repo/build}/compilations"; }

# An unprivileged user where the test itself runs as root.
as_user() {
  if ((EUID == 0)); then chown -R nobody "$scratch"; setpriv --reuid=nobody --clear-groups "$@"; else "$@"; fi
}

case_builds_once_and_passes_arguments() {
  mkdir "$scratch/elsewhere" && cd "$scratch/elsewhere"
  run "$repo/skred" run 'a b.yaml' '' '*'
  equal "$code" 0 "exit code"
  equal "$(cat "$scratch/out")" "$scratch/elsewhere"$'\n<run><a b.yaml><><*>' "standard output, from the caller's folder"
  says "building in $repo/build (the first time"
  run "$repo/skred" run
  silent
  equal "$(compilations)" 1 "compilations"
  ! grep -q 'tests built' "$repo/build/compilations" || fail "the tests were built for the program's sake"
  ln -s "$repo/skred" link && run ./link run
  equal "$code" 0 "exit code through a symbolic link"
  run "$repo/skred" exit 4
  equal "$code" 4 "the program's exit code"
}

case_rebuilds_what_changed() {
  run "$repo/skred" run
  sed -i 's/pwd/echo new/' "$repo/scenes/program.sh"
  run "$repo/skred"
  equal "$(head -n 1 "$scratch/out")" new "output of the new program"
  says 'building in'
}

case_shows_why_a_build_failed() {
  echo 'if' >>"$repo/scenes/program.sh"
  run "$repo/skred" run
  equal "$code" 1 "exit code"
  says 'Syntax error'
  says 'the build failed'
}

case_moved_checkout_is_configured_again() {
  run "$repo/skred" run
  mv "$repo" "$scratch/moved"
  run "$scratch/moved/skred" run
  equal "$code" 0 "exit code after the move"
}

case_two_at_once_build_once() {
  "$repo/skred" run >"$scratch/first" 2>&1 & local first=$!
  run "$repo/skred" run
  wait "$first" || fail "the first one: $(cat "$scratch/first")"
  equal "$code" 0 "exit code of the second"
  equal "$(compilations)" 1 "compilations"
  grep -q 'waiting for another' "$scratch/first" "$scratch/err" || fail "neither waited"
}

case_other_build_folder() {
  cd "$scratch"
  SKRED_BUILD_DIR=elsewhere/b run "$repo/skred" run
  equal "$code" 0 "exit code"
  equal "$(compilations "$scratch/elsewhere/b")" 1 "compilations"
  [[ ! -e $repo/build ]] || fail "build/ was made nevertheless"
}

case_read_only_checkout_builds_in_the_cache() {
  chmod -R a-w "$repo"
  run as_user "$repo/skred" run
  chmod -R u+w "$repo"
  equal "$code" 0 "exit code"
  says "building in $XDG_CACHE_HOME/skred/build-"
}

case_unwritable_build_folder() {
  SKRED_BUILD_DIR=/proc/skred run "$repo/skred" run
  equal "$code" 5 "exit code"
  says 'cannot write to /proc/skred; SKRED_BUILD_DIR names another build folder'
}

case_installs_only_what_is_missing() {
  printf '%s\n' libfcl-dev ninja-build libgtest-dev >"$scratch/missing"
  ((EUID == 0)) || fake sudo 'exec "$@"'
  run "$repo/skred" run
  equal "$code" 0 "exit code"
  says 'installing the missing Debian packages'
  equal "$(grep -o 'install --.*' "$scratch/asked")" 'install --no-install-recommends ninja-build libfcl-dev' "request to apt-get"
  run "$repo/skred" run
  equal "$(wc -l <"$scratch/asked")" 2 "calls of apt-get, one update and one install"
}

case_tests_need_more_packages() {
  echo python3-h5py >"$scratch/missing"
  ((EUID == 0)) || fake sudo 'exec "$@"'
  run "$repo/skred" run
  [[ ! -e $scratch/asked ]] || fail "running the program asked for a package of the tests"
  run "$repo/skred" test
  grep -q 'install --no-install-recommends python3-h5py$' "$scratch/asked" || fail "the tests did not"
}

case_user_installs_with_sudo() {
  echo libfcl-dev >"$scratch/missing"
  run as_user "$repo/skred" run
  equal "$code" 0 "exit code"
  grep -q '^sudo apt-get -q' "$scratch/asked" || fail "sudo was not asked"
}

# The tools the launcher needs, and no sudo nor apt-get but the ones asked for.
only_tools() {
  mkdir "$scratch/bin"
  local tool
  for tool in bash sh env echo cat cp grep sed awk xargs tr cut head tail wc mkdir rm dirname readlink realpath nproc flock \
              cksum sleep mktemp cmake ctest ninja c++; do
    ln -s "$(PATH=$real_path type -P "$tool")" "$scratch/bin/$tool" 2>/dev/null || true
  done
  for tool; do ln -s "$scratch/fake/$tool" "$scratch/bin/$tool"; done
}

case_user_without_sudo_is_told_the_names() {
  printf '%s\n' libfcl-dev libtbb-dev >"$scratch/missing"
  only_tools dpkg-query apt-get
  run as_user env PATH="$scratch/bin" "$repo/skred" run
  equal "$code" 5 "exit code"
  says 'needs root: libtbb-dev libfcl-dev'
}

case_no_network() {
  echo libfcl-dev >"$scratch/missing"
  fake apt-get '[[ $* != *install* ]] || { echo "E: Failed to fetch http://debian/x.deb  Temporary failure" >&2; exit 100; }'
  ((EUID == 0)) || fake sudo 'exec "$@"'
  run "$repo/skred" run
  equal "$code" 5 "exit code"
  says 'E: Failed to fetch http://debian/x.deb'
  says 'could not be installed (no network'
  says 'libfcl-dev'
}

case_other_system_is_told_the_names() {
  only_tools
  rm "$scratch/bin/ninja"
  run env PATH="$scratch/bin" "$repo/skred" run
  equal "$code" 5 "exit code"
  says 'not found: ninja'
  says 'by their Debian names: g++ cmake ninja-build'
  ln -s "$(PATH=$real_path type -P ninja)" "$scratch/bin/ninja"
  run env PATH="$scratch/bin" "$repo/skred" run
  equal "$code" 0 "exit code once everything is there"
  sed -i 's/project.*/&\nfind_package(Nonexistent REQUIRED)/' "$repo/CMakeLists.txt"
  rm -r "$repo/build"
  run env PATH="$scratch/bin" "$repo/skred" run
  equal "$code" 5 "exit code when CMake misses a library"
  says 'Nonexistent'
  says 'by their Debian names'
}

case_test_selects_by_label() {
  run "$repo/skred" run
  run "$repo/skred" test
  equal "$code" 0 "exit code of the quick tests"
  grep -q '100% tests passed, 0 tests failed out of 1' "$scratch/out" || fail "not the quick test alone"
  grep -q '^tests built' "$repo/build/compilations" || fail "the tests were not built"
  equal "$(compilations)" 1 "compilations of the program"
  run "$repo/skred" test --slow -R long
  grep -q '100% tests passed, 0 tests failed out of 1' "$scratch/out" || fail "--slow -R long is not one test"
  run "$repo/skred" test --all
  grep -q '1 tests failed out of 3' "$scratch/out" || fail "--all is not all three"
  ((code != 0)) || fail "a failing test gave exit code 0"
}

run_case "${1-}"
