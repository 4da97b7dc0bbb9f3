#!/usr/bin/env bash
# make bench-long_run: half an hour of mmlt on living-room and on door, side by side, each
# on THREADS=1, with its heap watched (heap_watch, heap_count) and, where perf is allowed
# to, sampled by perf. Nothing may grow, no statistic drift, nothing be non-finite
# (drift.c says by which tests). Into results/long-run/: of each scene samples of memory,
# error log, blocks of statistics, picture, profile and plots; verdict.txt of both. The
# status is 1 unless both pass.
#
# SECONDS_EACH=1800 SCENES="living-room door" SIZE=320x180 BLOCKS=30 EVERY=1 (s, samples)
# WARM_UP=60 (s, at most a tenth of the run) REFERENCE_SECONDS=60 OUT=results/long-run
# BOOTSTRAP=3000000 may be set. References are kept. JUDGE=1 judges again what is there.
#
# BOOTSTRAP: of the program's default, 1600 paths for each length of living-room, some 27
# carry light, and 64 chains start from these: they are far from equilibrium, and the
# share of proposals that fail rises by 0.2 % in half an hour (brightness does not).
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
bench=${BENCH:-build/release/bench}
out=${OUT:-results/long-run}
seconds=${SECONDS_EACH:-1800}
size=${SIZE:-320x180}
blocks=${BLOCKS:-30}
threads=${THREADS:-1}
warm_up=$(awk "BEGIN { w = ${WARM_UP:-60}; print w < $seconds / 10 ? w : $seconds / 10 }")
rows_every=$(awk "BEGIN { print $seconds / ($blocks * 6) }")
declare -A scene=(
    [living-room]=../shared/scenes/living-room-pbrt3/scene.pbrt
    [door]=scenes/door/scene.yaml
)
mkdir -p "$out"

# Where the processor's counters are not to be had, as in most virtual machines, perf
# samples by the clock.
event=
if perf stat -x, -e cycles:u true 2>&1 | grep -q '^[0-9]'; then
    event=cycles:u
elif perf stat -x, -e cpu-clock true 2>&1 | grep -q '^[0-9]'; then
    event=cpu-clock
fi

reference() { # reference NAME
    [ -e "$out/$1-reference.exr" ] ||
        "$etalon" render "${scene[$1]}" -i bdpt --size "$size" --threads 1 \
            --seed 1000000001 --seconds "${REFERENCE_SECONDS:-60}" \
            -o "$out/$1-reference.exr" >/dev/null 2>&1
}

long_run() { # long_run NAME
    local file=$out/$1 perf=()
    reference "$1"
    if [ -n "$event" ]; then
        perf=(perf record -q -F 49 -e "$event" -o "$file.perf" --)
    fi
    "${perf[@]}" "$bench/heap_watch" "$bench/heap_count.so" "$file-samples.csv" \
        "${EVERY:-1}" "$etalon" render "${scene[$1]}" -i mmlt --size "$size" \
        --threads "$threads" --seconds "$seconds" \
        --set bootstrap="${BOOTSTRAP:-3000000}" --reference "$file-reference.exr" \
        --errors "$file-errors.csv" --errors-every "$rows_every" --stats "$file.yaml" \
        -o "$file.exr" >"$file.log" 2>&1
}

# profile NAME: functions by their share of the samples, in the first and the last third.
profile() {
    local third
    [ -n "$event" ] || return 0
    for third in 0%-33% 67%-100%; do
        perf report -i "$out/$1.perf" --stdio --no-children -F overhead,dso,sym \
            --time $third 2>/dev/null | awk '/^ +[0-9.]+%/ { s[$NF ~ /^0x/ ? $2 : $NF] += $1 }
                END { for (name in s) print s[name], name }' |
            sort -rn | head -n 14 >"$out/$1.$third"
    done
    echo "perf ($event), % of samples in the first and the last third"
    awk 'NR == FNR { first[$2] = $1; next }
        { printf "  %-32s %8s %8s\n", $2, first[$2], $1 }' \
        "$out/$1.0%-33%" "$out/$1.67%-100%"
    rm -f "$out/$1.0%-33%" "$out/$1.67%-100%"
}

judge() { # judge NAME: what there is to say, and 1 if something is wrong
    local file=$out/$1 wrong=0
    echo "== $1: $(value paths "$file.yaml") mutations, \
$(value seconds_cpu "$file.yaml") CPU s in $(value seconds_total "$file.yaml") s"
    [ -n "$event" ] || echo "perf is not here, or not allowed"
    [ "$event" = cycles:u ] || echo "no counters of the processor on this machine"
    "$bench/drift" memory "$file-samples.csv" "$file-errors.csv" "$warm_up" "$blocks" ||
        wrong=1
    "$bench/drift" statistics "$file-errors.csv" "$warm_up" "$blocks" \
        "$file-blocks.csv" || wrong=1
    profile "$1"
    "$etalon" compare "$file.exr" "$file.exr" >"$file-compare.yaml"
    local bad
    bad="$(value n_nonfinite "$file.yaml") $(value n_saturated "$file.yaml") \
$(value n_nonfinite "$file-compare.yaml")"
    echo "non-finite contributions, saturated pixels, non-finite pixels: $bad"
    [ "$bad" = "0 0 0" ] || wrong=1
    gnuplot -e "out='$file'; name='$1'" bench/plot_long_run.gp
    rsvg-convert "$file.svg" -o "$file.png"
    echo "$1: $([ $wrong = 0 ] && echo passed || echo FAILED)"
    return $wrong
}

jobs=()
for name in ${SCENES:-living-room door}; do
    need "${scene[$name]}"
    [ -z "${JUDGE:-}" ] || continue
    long_run "$name" &
    jobs+=($!)
done
failed=0
for job in "${jobs[@]}"; do
    wait "$job" || failed=1
done
if [ $failed = 1 ]; then
    tail -n 3 "$out"/*.log
    exit 1
fi
for name in ${SCENES:-living-room door}; do
    judge "$name" || true
done | tee "$out/verdict.txt"
! grep -q FAILED "$out/verdict.txt"
