#!/usr/bin/env bash
# make bench-zsolnai13_table1: the experiment of config/zsolnai13-table1.yaml, and from its
# rows what [Zsolnai13] has as Table 1, with what each way to set p_l costs. Left in
# results/zsolnai13-table1/table.md and table.csv. Rows that are there already are not run
# again.
#
# ONLY=seed=1 runs one seed of eight (12 minutes with JOBS=2, the default); ONLY=none runs
# nothing. WORK=1, for a machine that others use: budgets in mutations, of 2 to 9 CPU
# seconds; errors are then compared at equal CPU time, whatever the wall time was.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
results=${RESULTS:-results/zsolnai13-table1}
config=config/zsolnai13-table1.yaml
need ../shared/scenes/{lux-luxtime,coffee-pbrt3,veach-bidir-mitsuba,veach-ajar-mitsuba} \
    ../shared/scenes/living-room-pbrt3

run() { # run CONFIG FOLDER
    "$etalon" bench "$1" --jobs "${JOBS:-2}" --only "${ONLY:-*}" --output "$2" \
        --references results/references
    echo
}

# by_work INTEGRATOR COLUMN: the experiment for that integrator alone, with its column of
# mutations per pixel.
by_work() {
    awk -v integrator="$1" -v column="$2" -v root="$PWD" -v budgets="luxtime 140 350 250 \
            interior 57 330 230 chess 260 640 450 splash 200 520 360 light-tube 89 530 360 \
            glass-ball 370 800 560 pool 45 270 180 twin-lamps 480 900 640 shells 110 660 450 \
            door 25 150 100 glass-caustic 200 1200 810 coffee 180 430 300 \
            veach-bidir 53 310 210 veach-ajar 48 280 190 living-room 49 290 200" '
        BEGIN {
            count = split(budgets, word, " ")
            for (i = 1; i < count; i += 4) budget[word[i]] = word[i + column]
        }
        /^budget:/ { next }
        /integrator: (pss|m|pf)mlt/ && !index($0, "{integrator: " integrator ",") { next }
        { sub(/\.\.\/scenes/, root "/scenes"); sub(/\.\.\/\.\.\/shared/, root "/../shared"); print }
        $1 == "label:" { print "    mutations_per_pixel: " budget[$2] }' $config
}

folders=$results
if [ -n "${WORK:-}" ]; then
    folders=
    mkdir -p "$results"
    for design in pssmlt:1 mmlt:2 pfmlt:3; do
        folder=$results/${design%:*}
        folders="$folders $folder"
        by_work "${design%:*}" "${design#*:}" >"$results/${design%:*}.yaml"
        [ "${ONLY:-}" = none ] || run "$results/${design%:*}.yaml" "$folder"
    done
elif [ "${ONLY:-}" != none ]; then
    run $config "$results"
fi
for folder in $folders; do
    [ -e "$folder/runs.csv" ] || continue
    columns "$folder/runs.csv" scene_label integrator budget_seconds p_l_source rule p_l \
        seed relmse_trimmed reference_relmse_trimmed seconds_cpu eta_l_run eta_s_run \
        eta_0_run p_l_zsolnai2013 predicted_relmse_at_p_l predicted_halves_regret \
        predicted_p predicted_relmse predicted_cost mutations_per_pixel
done | awk -v csv="$results/table.csv" -f bench/zsolnai13_table1.awk | tee "$results/table.md"
