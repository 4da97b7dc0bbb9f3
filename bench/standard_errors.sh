#!/usr/bin/env bash
# make bench-standard_errors: standard errors of the statistics against their spread over
# SEEDS=40 seeds, a row for every figure (bench/standard_errors.c says what stands in it),
# into results/standard_errors/table.csv. Small pictures at 64 mutations a pixel, one
# thread. Ends with 1 if an error is wrong by more than chance and no run said that it
# cannot be trusted.
#   INTEGRATORS="pssmlt mmlt pfmlt" BOOTSTRAPS="5000 100000" SCENES="cornell ..." choose.
#   SHARES=2 runs two processes of the same program side by side, each on every other cell
#   (scene, integrator, bootstrap); the table is that of all.
#   TABLE=1 renders nothing and tells what the table that there is says.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C

program=${BENCH:-build/release/bench}/standard_errors
shared=${SHARED:-../shared}/scenes
seeds=${SEEDS:-40}
shares=${SHARES:-1}
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
header=scene,integrator,bootstrap,figure,mean,sd,se,ratio,ratio_sure,sure,held,word,unsure,reason

# Scene, integrator and bootstrap, a line each.
cells() {
    local name integrator bootstrap
    for name in ${SCENES:-cornell door glass-caustic glass coffee}; do
        if [ ! -e "${scene[$name]%% *}" ]; then
            echo "${scene[$name]%% *} is not there: skipped" >&2
            continue
        fi
        for integrator in ${INTEGRATORS:-pssmlt mmlt pfmlt}; do
            for bootstrap in ${BOOTSTRAPS:-5000 100000}; do
                echo "$name $integrator $bootstrap"
            done
        done
    done
}

# run_share I: every cell whose number is I modulo SHARES; its rows go to a part. What
# stays empty was not rendered at all.
run_share() {
    local name integrator bootstrap file size options number=0 part
    while read -r name integrator bootstrap; do
        part=$out/part.$(printf %03d "$number")
        [ $((number++ % shares)) -eq "$1" ] || continue
        read -r file size options <<<"${scene[$name]}"
        # shellcheck disable=SC2086 # options are words
        "$program" "$file" "$seeds" "$name,$integrator,$bootstrap" "size=$size" $options \
            "integrator=$integrator" "bootstrap=$bootstrap" mutations_per_pixel=64 \
            threads=1 2>"$part.err" >"$part" || true
        [ -s "$part" ] || { echo "$name $integrator $bootstrap: $(tail -n 1 "$part.err")" >&2; }
        echo "$(date +%T) $name $integrator $bootstrap: $(wc -l <"$part") figures" >&2
    done < <(cells)
}

if [ -z "${TABLE:-}" ]; then
    rm -f "$out"/part.*
    pids=()
    trap 'kill "${pids[@]}" 2>/dev/null; exit 130' INT TERM
    for ((i = 0; i < shares; i++)); do
        run_share "$i" &
        pids+=($!)
    done
    wait "${pids[@]}"
    { echo "$header"; cat "$out"/part.[0-9][0-9][0-9]; } >"$table"
fi

# The ratio by cell and figure, what is outside [.8, 1.25] with its word; how many rows
# have which; how often the 99 % intervals hold the mean of all seeds.
awk -F, -v seeds="$seeds" '
    function short(name) {
        sub(/acceptance/, "accept", name)
        sub(/failure_rate/, "fail", name)
        sub(/_start/, "_0", name)
        return name
    }
    NR == 1 { next }
    {
        cell = $1 "," $2 "," $3
        if (!(cell in known)) { known[cell] = 1; order[++cells] = cell }
        if (!($4 in column)) { column[$4] = 1; names[++figures] = $4 }
        ratio[cell, $4] = $8
        word[$12]++
        rows++
        if ($12 != "ok")
            others[++outside] = sprintf("%-34s %-18s %8s  %s%s", cell, $4, $8, $12,
                $13 > 0 ? " (p_l unsure in " $13 " of " seeds " runs)" : "")
        if ($13 > 0 && $4 == "p_l") {
            r = $0
            sub(/^[^"]*/, "", r)
            reasons[cell] = r
        }
        if ($4 ~ /^(r|p_l|r_run|b)$/) { held[$4] += $11; of[$4] += seeds }
    }
    END {
        printf "sd over seeds / mean standard error\n%-28s", "cell"
        for (f = 1; f <= figures; f++) printf " %9.9s", short(names[f])
        print ""
        for (c = 1; c <= cells; c++) {
            printf "%-28s", order[c]
            for (f = 1; f <= figures; f++) printf " %9s", ratio[order[c], names[f]]
            print ""
        }
        print "\noutside [.8, 1.25]:"
        for (i = 1; i <= outside; i++) print others[i]
        print "\nwhere p_l is unsure, as the first such run says:"
        for (c = 1; c <= cells; c++)
            if (order[c] in reasons) printf "%s: %s\n", order[c], reasons[order[c]]
        print ""
        for (w in word) printf "%s: %d of %d rows\n", w, word[w], rows
        for (f in held)
            printf "99 %% intervals of %s hold the mean of all seeds: %.1f %%\n", f, 100 * held[f] / of[f]
        exit word["FAIL"] > 0 || rows == 0
    }' "$table"
