#!/usr/bin/env bash
# make bench-regress_baseline: config/baselines/NAME.csv anew from config/NAME.yaml with
# other seeds, from 1001 on, and more of them. NAMES="regress-quick regress-long",
# SEEDS=128 may be set. To be run when a change of statistics is meant, from a clean commit:
# the baseline names it.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

for name in ${NAMES:-regress-quick regress-long}; do
    reseed "config/$name.yaml" 1001 "${SEEDS:-128}" >"$work/$name.yaml"
    # Runs of another commit would be taken for this one's.
    rm -rf "results/$name-baseline"
    "$etalon" bench "$work/$name.yaml" --force -o "results/$name-baseline" | tail -n 1
    "$etalon" regress "results/$name-baseline" --baseline "config/baselines/$name.csv" --update
done
