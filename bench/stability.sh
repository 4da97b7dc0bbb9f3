#!/usr/bin/env bash
# Sweeps of numerical stability over all integrators, into results/stability/ (some ten
# minutes of one core). Ends with 1 if a case failed.
set -eu
cd "$(dirname "$0")/.."

out=results/stability
mkdir -p "$out"
status=0
"${BENCH:-build/release/bench}/stability" "$out" "$@" || status=$?
echo "$out/table.md, $out/table.csv, $out/index.html"
exit $status
