#!/usr/bin/env bash
# make bench-same_bits: pictures by 1, 2 and 3 threads, pixel by pixel; statistics too.
# SCENE (peer-box glass where it is there, else our own cornell), SIZE=128x128, MPP=16 may
# be set.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
peer=../shared/scenes/peer-box/glass.pbrt
scene=${SCENE:-$([ -e $peer ] && echo $peer || echo scenes/cornell/scene.yaml)}
mpp=${MPP:-16}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

check() { # check NAME OPTIONS...
    local name=$1 threads verdict=same
    shift
    for threads in 1 2 3; do
        "$etalon" render "$scene" --size "${SIZE:-128x128}" --max-depth 6 --mpp "$mpp" \
            --threads $threads "$@" --stats "$work/$threads.yaml" -o "$work/$threads.exr" \
            >/dev/null 2>&1
        # What a run has beside its picture: all but the number of threads and the times.
        grep -vE '^(threads|seconds|left_out)' "$work/$threads.yaml" >"$work/$threads.kept"
        "$etalon" compare "$work/$threads.exr" "$work/1.exr" >"$work/compare"
        [ "$(value rmse "$work/compare")" = 0 ] &&
            [ "$(value n_nonfinite "$work/compare")" = 0 ] &&
            cmp -s "$work/$threads.kept" "$work/1.kept" || verdict=DIFFERENT
    done
    [ $verdict = same ] || failed=1
    printf '%-44s %s\n' "$name" $verdict
}

echo "$scene, ${SIZE:-128x128}, $mpp mutations (samples) a pixel, 1, 2 and 3 threads"
for builder in bdpt pt; do
    for estimator in kelemen plain; do
        for kernel in exponential gaussian; do
            check "pssmlt over $builder, $estimator, $kernel" -i pssmlt \
                --set builder=$builder --set estimator=$estimator --set kernel=$kernel
        done
    done
done
for estimator in kelemen plain; do
    for direct in joint separate; do
        check "mmlt, $estimator, $direct" -i mmlt --set estimator=$estimator \
            --set direct=$direct
    done
done
check "mmlt, p_l per length" -i mmlt --set per=length
check "mmlt, chains by brightness" -i mmlt --set allocation=brightness
for mode in exact counted paper; do
    check "rjmlt, $mode$([ $mode = paper ] && echo " (biased)")" -i rjmlt --set mode=$mode
    check "pfmlt, $mode$([ $mode = paper ] && echo " (biased)")" -i pfmlt --set mode=$mode
done
check bdpt -i bdpt
check pt -i pt
exit $failed
