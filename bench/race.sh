#!/usr/bin/env bash
# make bench-race: what the choice of -i auto costs. WHAT="measure errors choose table"
# (default: choose table):
#   measure  SEEDS runs from 101 on of each of METHODS="pt bdpt pssmlt mmlt pfmlt", each of
#            BUDGET=5 CPU seconds (pt, bdpt: half of it); pictures and rows in $OUT/runs-BUDGET. What is there is
#            not made again, so that SEEDS may grow. 200 CPU seconds a scene for 8 seeds.
#            A method with settings is written as bdpt:film_sampling=adaptive.
#            RUN="nice" is put before each command of at most SEEDS runs.
#   errors   of all these pictures, a row for each run (bench/race.c): CELLS, which is
#            results/smlt/cells.csv by default
#   choose   the pilots alone, by SEEDS=8 seeds from FIRST=1 on, for a budget of that many
#            seconds: $OUT/choices.csv. Half a minute of CPU time for 20 scenes.
#   table    from both: how many times the error of the best method auto has at equal work
#            (bench/race.awk). COLUMN=7: by relMSE of all pixels.
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
seconds=${BUDGET:-5}
seeds=${SEEDS:-8}
runs=$out/runs-$seconds
mkdir -p "$runs"

# Settings of a scene beside its size.
options() {
    case $1 in
    box) echo max_depth=6 ;;
    coffee | living-room | veach-* | bathroom | staircase) echo max_depth=12 ;;
    esac
}

# Samples a pixel that bdpt has in the budget, by its runs if there are some.
bdpt_samples() {
    if cat "$out"/runs-*/"$1".bdpt.csv >"$out/bdpt.csv" 2>/dev/null; then
        awk -F, "{ s += \$3 / \$5 } END { printf \"%d\", $seconds * s / NR }" "$out/bdpt.csv"
        return
    fi
    # shellcheck disable=SC2046
    render_small "$2" "$3" 12 1 -i bdpt $(options "$1" | sed 's/^/--set /')
    awk "BEGIN { printf \"%d\", 12 * $seconds / $(value seconds_cpu "$out/run.yaml") }"
}

list() {
    scenes glass-ball pool torus door glass-caustic interior coffee living-room veach-bidir \
        veach-ajar water-glass splash light-tube shells cornell box twin-lamps bathroom chess staircase
}

# measure NAME FILE SIZE METHOD: the runs that are missing
measure() {
    local name=$4 rows budget=seconds=$seconds made
    name=${name//:/-}
    name=${name//=/-}
    rows=$runs/$1.$name.csv
    touch "$rows"
    made=$(wc -l <"$rows")
    if ((made > 0)); then budget=mutations_per_pixel=$(head -1 "$rows" | cut -d, -f3); fi
    ((made < seeds)) || return 0
    case $4:$made in # their error is in inverse proportion to time
    pt:0 | bdpt:0) budget=seconds=$(awk "BEGIN { print $seconds / 2 }") ;;
    esac
    # shellcheck disable=SC2046,SC2086 # options and the words of RUN
    ${RUN:-} "$program" render "$2" "$1" "$name" $((101 + made)) $((seeds - made)) "$runs" \
        "size=$3" threads=1 $(options "$1") "integrator=${4%%:*}" "$budget" \
        $(cut -d: -sf2- <<<"$4" | tr : " ") >>"$rows"
}

# Error by the automatic p_l over that by the best one, of the scenes that were measured.
regrets() {
    awk -f bench/student.awk -f bench/p_curve.awk results/zsolnai13-table1/curves.csv \
        results/zsolnai13-table1/starts.csv |
        awk -F ' *[|] *' '$3 ~ /mlt$/ { split($12, r, /[* ]+/)
            print $2 "," $3 "," (r[1] == "" ? r[2] : r[1]) }'
}

for what in ${WHAT:-choose table}; do
    case $what in
    measure)
        while read -r name file size _; do
            for method in ${METHODS:-pt bdpt pssmlt mmlt pfmlt}; do
                measure "$name" "$file" "$size" "$method" </dev/null
            done
        done < <(list)
        ;;
    errors)
        while read -r name _; do
            cat "$runs/$name".*.csv | "$program" errors "$runs"
        done < <(list) >"$cells"
        ;;
    choose)
        rm -f "$out/choices.csv"
        while read -r name file size _; do
            # shellcheck disable=SC2046
            "$program" choose "$file" "$name" "$(bdpt_samples "$name" "$file" "$size")" \
                "${FIRST:-1}" "$seeds" "size=$size" threads=1 $(options "$name") |
                sed "s/^/$seconds,/" >>"$out/choices.csv"
        done < <(list)
        ;;
    table)
        regrets >"$out/regrets.csv"
        awk -v "column=${COLUMN:-6}" -f bench/student.awk -f bench/race.awk "$cells" \
            "$out/regrets.csv" "${CHOICES:-$out/choices.csv}" | tee "$out/table.md"
        ;;
    esac
done
