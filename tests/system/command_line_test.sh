#!/usr/bin/env bash
# tests/system/command_line_test.sh CASE PROGRAM - the program's command line: exit codes, messages, what goes to which stream,
# output folders, interruption. `list` prints the cases.
set -euo pipefail

source_root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
# shellcheck source=tests/system/shell_checks.sh
source "$source_root/tests/system/shell_checks.sh"
program=${2-}
hello=$source_root/scenes/hello.yaml
cd "$scratch"

skred() { run "$program" "$@"; }
exits() { equal "$code" "$1" "exit code of '$2'"; }

case_help_and_version() {
  skred --help
  exits 0 --help
  silent
  local verb
  for verb in run bench graph validate schema models explain completion; do
    prints "  $verb "
    skred "$verb" --help
    exits 0 "$verb --help"
    skred --help
  done
  skred --version
  exits 0 --version
  grep -qE '^skred [0-9]+\.[0-9]+\.[0-9]+$' out || fail "no version"
}

case_usage_errors() {
  skred;                                        exits 2 "no verb"
  skred simulate "$hello";                      exits 2 "an unknown verb"
  skred run;                                    exits 2 "run without a scene"
  skred run "$hello" --sead 3;                  exits 2 "an unknown option"; says --sead
  skred run "$hello" --method dem;              exits 2 "an unknown method"; says 'dem not in {sdem,ndem}'
  skred run "$hello" --threads 0;               exits 2 "no threads"; says "'0' is not allowed"
  skred run "$hello" --threads 10000;           exits 2 "too many threads"; says "'10000' is not allowed"
  skred run "$hello" --threads two;             exits 2 "a word of threads"; says "'two' is not allowed"
  skred run "$hello" --vector wide;             exits 2 "an unknown vector path"; says "'wide' is not allowed; this machine has auto, scalar"
  skred bench --vector wide;                    exits 2 "an unknown vector path of bench"; says "'wide' is not allowed"
  skred run "$hello" --trace-steps 5:5;         exits 2 "an empty range"; says '--trace-steps'
  skred run "$hello" --set a;                   exits 2 "an override without value"; says '--set'
  skred graph "$hello" --format png;            exits 2 "an unknown format"
  equal "$(ls)" "$(printf 'err\nout')" "files left behind"
}

case_scene_errors() {
  skred run nowhere.yaml
  exits 3 "a missing scene"; says nowhere.yaml
  printf 'name: x\nend_tiem: 1\n' >wrong.yaml
  skred validate wrong.yaml
  exits 3 "a wrong key"; says 'wrong.yaml:2:1: error:'; says end_time
  skred validate "$hello" --set nosuch=1
  exits 3 "an unknown override"; says '--set nosuch=1: error:'
  skred run "$hello" --time-step 1
  exits 3 "a time step beyond the limit"; says 'too large'
  equal "$(ls)" "$(printf 'err\nout\nwrong.yaml')" "files left behind"
}

case_shipped_scenes_are_valid() {
  local scene
  for scene in "$source_root"/scenes/*.yaml; do
    skred validate "$scene"
    exits 0 "validate $scene"
  done
}

case_run_fills_a_folder() {
  skred run "$hello" --output r --summary s.json --quiet --end-time 0.1
  exits 0 run
  silent
  local file
  for file in trajectory.h5 trajectory.xdmf statistics.h5 statistics.csv summary.json scene.resolved.yaml log.txt; do
    [[ -s r/$file ]] || fail "no r/$file"
  done
  cmp r/summary.json s.json
  # The resolved scene is a scene, and the same one.
  skred run r/scene.resolved.yaml --output again --quiet
  exits 0 "the resolved scene"
  equal "$(grep state_hash again/summary.json)" "$(grep state_hash r/summary.json)" "state hash of the resolved scene"
}

case_results_are_not_overwritten() {
  skred run "$hello" --output r --quiet --end-time 0.01
  cp r/summary.json before
  skred run "$hello" --output r --quiet --end-time 0.02
  exits 5 "a folder in use"; says 'not empty'
  cmp before r/summary.json
  skred run "$hello" --output r --quiet --end-time 0.02 --overwrite
  exits 0 --overwrite
  ! cmp -s before r/summary.json || fail "nothing was written"
}

case_unwritable_output() {
  skred run "$hello" --output /proc/skred
  exits 5 "a folder that cannot be made"; says /proc/skred
  code=0; "$program" schema >/dev/full 2>err || code=$?
  exits 5 "a full disk behind standard output"; says 'cannot be written'
}

case_standard_output_is_clean() {
  skred graph "$hello" --format dot
  exits 0 graph
  silent
  equal "$(head -n 1 out)" 'digraph step {' "first line"
  skred schema
  silent
  /usr/bin/python3 -c 'import json, sys; json.load(sys.stdin)' <out || fail "the schema is not JSON"
}

case_completion_scripts_load() {
  skred completion bash
  exits 0 "completion bash"
  cp out script
  equal "$(bash -c 'source ./script; COMP_WORDS=(skred run x.yaml --method n); COMP_CWORD=4; _skred; echo "${COMPREPLY[*]}"')" \
        ndem "completion of --method n"
  equal "$(bash -c 'source ./script; COMP_WORDS=(skred bench --vector ""); COMP_CWORD=3; _skred; echo "${COMPREPLY[*]}"')" \
        "auto scalar sse2 avx2 avx512" "completion of --vector"
  local shell
  for shell in zsh fish; do
    skred completion $shell
    exits 0 "completion $shell"
    ! command -v $shell >/dev/null || $shell -n out
  done
}

# Started with the signal at its default: a shell gives its background jobs SIGINT ignored.
start_long_run() {
  env --default-signal=INT "$program" run "$hello" --output r --end-time 1e6 >out 2>err </dev/null &
  pid=$!
  for _ in {1..300}; do [[ ! -s r/trajectory.h5 ]] || break; sleep 0.1; done
  [[ -s r/trajectory.h5 ]] || fail "the run did not start"
  sleep 0.3
}

case_interrupt_ends_with_results() {
  start_long_run
  kill -INT $pid
  code=0; wait $pid || code=$?
  exits 130 "an interrupted run"
  grep -q interrupted out err || fail "it does not say that it was interrupted"
  grep -q state_hash r/summary.json || fail "no summary"
  /usr/bin/python3 -c 'import h5py; h5py.File("r/trajectory.h5")' || fail "the trajectory cannot be read"
}

run_case "${1-}"
