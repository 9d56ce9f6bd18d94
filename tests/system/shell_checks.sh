# tests/system/shell_checks.sh - what the shell tests of this folder share: a scratch folder, and checks that say what they saw.
# shellcheck shell=bash disable=SC2034

scratch=$(mktemp -d)
trap 'chmod -R u+w "$scratch"; rm -rf "$scratch"' EXIT

fail() { printf 'FAILED: %s\n' "$*" >&2; for f in "$scratch"/{out,err}; do echo "--- $f"; head -n 50 "$f"; done >&2; exit 1; }
equal() { [[ $1 == "$2" ]] || fail "$3: expected '$2', got '$1'"; }
says() { grep -qF -- "$1" "$scratch/err" || fail "standard error does not say '$1'"; }
prints() { grep -qF -- "$1" "$scratch/out" || fail "standard output does not hold '$1'"; }
silent() { [[ ! -s $scratch/err ]] || fail "standard error is not empty"; }
run() { code=0; "$@" >"$scratch/out" 2>"$scratch/err" </dev/null || code=$?; }   # sets code, out, err

run_case() {  # CASE: one of the functions case_*; `list` prints them
  local cases
  cases=$(declare -F | sed -n 's/^declare -f case_//p')
  if [[ $1 == list ]]; then echo "$cases"; return; fi
  grep -qx -- "$1" <<<"$cases" || { echo "unknown case '$1'" >&2; exit 1; }
  "case_$1"
}
