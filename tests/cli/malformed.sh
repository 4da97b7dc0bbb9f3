#!/usr/bin/env bash
# What is malformed: inputs of every kind, options, settings and outputs. The lists are in
# tests/malformed/. MALFORMED_TABLE=FILE: the rows are left there, for bench/malformed.sh.
set -u
root=$(cd "$(dirname "$0")/../.." && pwd)
. "$root/tests/malformed/lib.bash"
. "$root/tests/malformed/inputs.bash"
for list in ${MALFORMED_LISTS:-command_line outputs scene_yaml pbrt mitsuba meshes pictures \
    checkpoints tables}; do
    . "$root/tests/malformed/$list.bash"
done
[ -z "${MALFORMED_TABLE:-}" ] || cp rows "$MALFORMED_TABLE"
finish
