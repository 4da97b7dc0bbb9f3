#!/usr/bin/env bash
# run_tests.sh TEST...: runs programs and scripts, two at a time (JOBS), goes on after a
# failure and prints one line a test with its time and CPU time, and their sum; what a test
# says is shown only if it fails. Status 77 means skipped, its last line says why. A test finds the program under
# test in $ETALON and a folder of its own, removed afterwards, in $TEST_TMP.
set -u
cd "$(dirname "$0")/.." || exit 1

run_one() {
    local test=$1 work=$2
    local name=${test#build/} out=$work/out.$BASHPID times=$work/time.$BASHPID
    export TEST_TMP=$work/tmp.$BASHPID
    mkdir -p "$TEST_TMP"
    local status=0 spent kind TIMEFORMAT='%R %U %S'
    { time timeout -k 5 "$TEST_TIMEOUT" "$test" >"$out" 2>&1 </dev/null || status=$?; } \
        2>"$times"
    spent=$(awk '{ printf "%7.2f s %7.2f CPU s", $1, $2 + $3 }' "$times")
    rm -rf "$TEST_TMP"
    # One printf a test: lines of two tests never mix.
    case $status in
    0) kind=passed text="ok     $spent  $name" ;;
    77) kind=skipped text="skip   $spent  $name: $(tail -n 1 "$out")" ;;
    124) kind=failed text="FAIL   $spent  $name: still running after $TEST_TIMEOUT s" ;;
    *) kind=failed text="FAIL   $spent  $name: status $status" ;;
    esac
    [ $kind = failed ] && [ -s "$out" ] && text+=$'\n'$(sed 's/^/    | /' "$out")
    printf '%s\n' "$text"
    echo $kind >"$work/result.$BASHPID"
    rm -f "$out"
}
export -f run_one
# As etalon sets them by starting itself once more, which would be half of a short run.
export GOMP_SPINCOUNT=1000 KMP_BLOCKTIME=0
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0
export TEST_TIMEOUT=${TEST_TIMEOUT:-$([ -n "${ETALON_LONG:-}" ] && echo 3600 || echo 600)}

# In memory if there is room: tests write thousands of files, each of which the program has
# the system write to disk before it goes on.
[ -z "${TMPDIR:-}" ] && [ -w /dev/shm ] &&
    [ "$(df --output=avail -k /dev/shm | tail -n 1)" -gt 1000000 ] && export TMPDIR=/dev/shm
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
[ $# -eq 0 ] || printf '%s\0' "$@" |
    xargs -0 -n 1 -P "${JOBS:-2}" bash -c 'run_one "$1" "$0"' "$work"

count() {
    cat "$work"/result.* 2>/dev/null | grep -c "^$1\$"
}
passed=$(count passed) failed=$(count failed) skipped=$(count skipped)
# A test whose runner died left no result: it has failed.
failed=$((failed + $# - passed - failed - skipped))
line="$passed passed, $failed failed"
[ "$skipped" -gt 0 ] && line+=", $skipped skipped"
line+="; $(cat "$work"/time.* 2>/dev/null | awk '{ s += $2 + $3 } END { printf "%.0f", s }') CPU s"
echo "$line"
[ "$failed" -eq 0 ]
