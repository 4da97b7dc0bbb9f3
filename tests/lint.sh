#!/usr/bin/env bash
# make lint: each check runs even if one before it failed; the status tells of all.
# ANALYZE=no leaves out the path-sensitive checks of clang-tidy, seven eighths of its time.
set -u
cd "$(dirname "$0")/.." || exit 1

failed=0
check() {
    local name=$1 begin=$SECONDS
    shift
    if "$@"; then
        echo "ok    $name ($((SECONDS - begin)) s)"
    else
        echo "FAIL  $name"
        failed=1
    fi
}

tidy() {
    local gen checks=()
    [ "${ANALYZE:-yes}" = yes ] || checks=('--checks=-clang-analyzer-*')
    gen=$(dirname "$(ls build/*/gen/build_info.h | head -n 1)")
    # clang-tidy counts the warnings it suppressed on stderr; its findings are on stdout.
    find src -name '*.c' | sort | xargs -n 4 -P "$(nproc)" sh -c 'clang-tidy --quiet '"${checks[*]}"' "$@" -- -std=c11 \
        -D_GNU_SOURCE -Isrc -I'"$gen"' -isystem /usr/include/OpenEXR \
        -isystem /usr/include/Imath -fopenmp 2>/dev/null' tidy
}

cpp() {
    cppcheck --quiet --std=c11 --error-exitcode=1 --inline-suppr -j "$(nproc)" \
        --enable=warning,performance,portability --suppress=missingIncludeSystem -D__GNUC__ -Isrc src
}

# What git leaves of a conflict.
no_marks() {
    ! git grep -nE "^(<<<<<<<|>>>>>>>|\\|\\|\\|\\|\\|\\|\\|) " -- .
}

shopt -s nullglob
# The short ones beside the two long ones, which divide their work by files.
{
    check "no marks of a merge" no_marks
    check "format" clang-format --dry-run -Werror src/*/*.[ch] src/*/*/*.[ch] tests/*/*.[ch] bench/*.c
    check "layers" tests/check_layers.sh
    check "layers, self-test" tests/check_layers_test.sh
    check "references" tests/check_refs.sh
    check "map" tests/check_map.sh
    check "links of pages" tests/check_links.sh
    check "mutants can be planted" bench/mutants.sh --check
    exit $failed
} &
short=$!
check "cppcheck" cpp
check "clang-tidy" tidy
wait $short || failed=1
exit $failed
