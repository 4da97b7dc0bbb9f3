#!/usr/bin/env bash
# make bench-keep_all: what leaving out what a scene does not need changes: nothing in the
# mean (z of b, both runs with a seed of their own), and how much time. MPP=64 may be set.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
shared=../shared/scenes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

row() { # row SCENE INTEGRATOR BUILDER OPTIONS...
    local scene=$1 integrator=$2 builder=$3 keep
    shift 3
    for keep in false true; do
        "$etalon" render "$scene" -i "$integrator" --set builder="$builder" "$@" \
            --mpp "${MPP:-64}" --seed $([ $keep = true ] && echo 2 || echo 1) \
            --set keep_all=$keep --stats "$work/$keep.yaml" -o "$work/$keep.exr" \
            >/dev/null 2>&1
    done
    for key in b b_se seconds_cpu paths bootstrap_paths; do
        local lean_$key="$(value $key "$work/false.yaml")"
        local all_$key="$(value $key "$work/true.yaml")"
    done
    "$etalon" compare "$work/false.exr" "$work/true.exr" >"$work/compare"
    awk -v name="${scene#"$shared"/}" -v what="$integrator/$builder" -v b="$lean_b" \
        -v se="$lean_b_se" -v c="$all_b" -v ce="$all_b_se" -v t="$lean_seconds_cpu" \
        -v u="$all_seconds_cpu" -v m="$(value mean_ratio "$work/compare")" 'BEGIN {
        printf "%-26s %-12s %.6f +- %.6f %.6f +- %.6f %6.2f %8.5f %8.2f %8.2f %6.3f\n", name,
            what, b, se, c, ce, (b - c) / sqrt(se * se + ce * ce), m, t, u, u / t }'
    echo "    left out: $(value left_out "$work/false.yaml")"
}

printf '%-26s %-12s %20s %20s %6s %8s %8s %8s %6s\n' scene design 'b, lean' 'b, keep_all' z \
    'image' 'CPU s' 'all' 'ratio'
for design in 'pssmlt bdpt' 'pssmlt pt' 'bdpt bdpt'; do
    row scenes/cornell/scene.yaml $design --size 128x128
    [ -e $shared ] || continue
    row $shared/peer-box/diffuse.pbrt $design --size 128x128 --max-depth 6
    row $shared/coffee-pbrt3/scene.pbrt $design --size 120x150 --max-depth 12
done
