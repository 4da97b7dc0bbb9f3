#!/usr/bin/env bash
# make bench-standard_errors: standard errors of the statistics against their spread over
# SEEDS=40 seeds, a row for every figure (bench/standard_errors.c says what stands in it),
# into results/standard_errors/table.csv. Small pictures at 64 mutations a pixel: some ten
# minutes of one core. Ends with 1 if an error is wrong by more than chance and no run
# said that it cannot be trusted.
#   INTEGRATORS="pssmlt mmlt pfmlt" BOOTSTRAPS="5000 100000" SCENES="cornell ..." choose.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

program=${BENCH:-build/release/bench}/standard_errors
shared=../shared/scenes
seeds=${SEEDS:-40}
declare -A scene=(
    [cornell]="scenes/cornell/scene.yaml 32x32"
    [door]="scenes/door/scene.yaml 40x30"
    [glass-caustic]="scenes/glass-caustic/scene.yaml 40x30"
    [glass]="$shared/peer-box/glass.pbrt 32x32 max_depth=6"
    [coffee]="$shared/coffee-pbrt3/scene.pbrt 28x35 max_depth=12"
)
out=${OUT:-results/standard_errors}
mkdir -p "$out"
table=$out/table.csv
header=scene,integrator,bootstrap,figure,mean,sd,se,ratio,ratio_sure,sure,held,word
echo "$header" | tee "$table"
status=0
for name in ${SCENES:-cornell door glass-caustic glass coffee}; do
    read -r file size options <<<"${scene[$name]}"
    if [ ! -e "$file" ]; then
        echo "$file is not there: skipped" >&2
        continue
    fi
    for integrator in ${INTEGRATORS:-pssmlt mmlt pfmlt}; do
        for bootstrap in ${BOOTSTRAPS:-5000 100000}; do
            "$program" "$file" "$seeds" "$name,$integrator,$bootstrap" "size=$size" $options \
                integrator=$integrator bootstrap=$bootstrap mutations_per_pixel=64 \
                threads=1 2>/dev/null | tee -a "$table" || status=1
        done
    done
done
awk -F, -v seeds="$seeds" '
    NR > 1 { word[$12]++; n++; if ($4 ~ /^(r|p_l|r_run)$/) { held[$4] += $11; of[$4] += seeds } }
    END {
        for (w in word) printf "%s: %d of %d rows\n", w, word[w], n
        for (f in held) printf "99 %% intervals of %s hold the grand mean: %.1f %%\n", f, 100 * held[f] / of[f]
    }' "$table"
exit $status
