#!/usr/bin/env bash
# make bench-race: what the choice of -i auto costs. WHAT="measure choose table" (default:
# choose table):
#   measure  errors of pt, bdpt, pssmlt and mmlt at BUDGET=2.5 CPU seconds, three seeds
#            each, and of mixes of two of them: results/smlt/cells.csv, a row for each run
#            (bench/race.c). Scenes that the file has are not measured again. 40 CPU
#            seconds a scene.
#   choose   the pilots alone, by SEEDS=6 seeds from FIRST=1 on, for a budget of that many
#            seconds: $OUT/choices.csv. Half a minute of CPU time for 19 scenes.
#   table    from both: how many times the error of the best method the chosen one has, at
#            equal work.
# SCENES="door pool" chooses scenes.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
. bench/small_scenes.bash
export LC_ALL=C OMP_NUM_THREADS=1

etalon=${ETALON:-build/release/etalon}
program=${BENCH:-build/release/bench}/race
cells=${CELLS:-results/smlt/cells.csv}
out=${OUT:-results/race}
seconds=${BUDGET:-2.5}
mkdir -p "$out"

# Settings of a scene beside its size.
options() {
    case $1 in
    box) echo max_depth=6 ;;
    coffee | living-room | veach-* | bathroom) echo max_depth=12 ;;
    esac
}

# Samples a pixel that bdpt has in the budget.
bdpt_samples() {
    render_small "$1" "$2" 12 1 -i bdpt
    awk "BEGIN { printf \"%d\", 12 * $seconds / $(value seconds_cpu "$out/run.yaml") }"
}

list() {
    scenes glass-ball pool torus door glass-caustic interior coffee living-room veach-bidir \
        veach-ajar water-glass splash light-tube shells cornell box twin-lamps bathroom chess
}

for what in ${WHAT:-choose table}; do
    case $what in
    measure)
        touch "$cells"
        while read -r name file size _; do
            grep -q "^$name," "$cells" && continue
            # shellcheck disable=SC2046 # options are words
            "$program" measure "$file" "$name" "$seconds" 101 "size=$size" threads=1 \
                $(options "$name") >"$cells.part"
            cat "$cells.part" >>"$cells"
            rm "$cells.part"
        done < <(list)
        ;;
    choose)
        rm -f "$out/choices.csv"
        while read -r name file size _; do
            # shellcheck disable=SC2046
            "$program" choose "$file" "$name" "$(bdpt_samples "$file" "$size")" \
                "${FIRST:-1}" "${SEEDS:-6}" "size=$size" threads=1 $(options "$name") |
                sed "s/^/$seconds,/" >>"$out/choices.csv"
        done < <(list)
        ;;
    table)
        awk -f bench/student.awk -f bench/race.awk "$cells" "${CHOICES:-$out/choices.csv}" | tee "$out/table.md"
        ;;
    esac
done
