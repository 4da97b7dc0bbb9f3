#!/usr/bin/env bash
# make bench-smlt: smlt and auto beside pt, bdpt, pssmlt, mmlt and pfmlt, on small pictures
# at about equal CPU time; a row of results/smlt/table.csv for each run, and
# results/smlt/table.md: relMSE without its highest 1 %, means over the seeds, as efficiency
# 1/(relMSE x CPU seconds).
# The budget is counted in mutations, set from a short run of each, so that other work on
# the machine changes little.
#
#   SECONDS_EACH=4 SEEDS="1 2"   CPU seconds of a run, seeds
#   SCENES="box door"            some of the scenes only
#   STUCK=20                     then also the worst of so many seeds over their median
#
# References are made once and kept in results/smlt/references; remove them to get new ones.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
. bench/small_scenes.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
out=${OUT:-results/smlt}
seconds=${SECONDS_EACH:-4}
seeds=${SEEDS:-1 2}
methods=("-i pt" "-i bdpt" "-i pssmlt" "-i mmlt" "-i pfmlt" "-i auto" "-i smlt"
    "-i smlt --set builder=pt" "-i smlt --set metropolis=mmlt")
mkdir -p "$out"

# a row of table.csv
row() {
    local name=$1 method=$2 seed=$3
    compare_small "$name"
    echo "$name,${method#-i },$seed,$(value mutations_per_pixel "$out/run.yaml"),$(
        value seconds_cpu "$out/run.yaml"),$(value relmse "$out/compare.yaml"),$(
        value relmse_trimmed "$out/compare.yaml"),$(value split_floor "$out/run.yaml"),$(
        value split_ceiling "$out/run.yaml"),$(value split_passes "$out/run.yaml"),$(
        value split_relmse "$out/run.yaml"),$(value chosen "$out/run.yaml")" >>"$out/table.csv"
}

echo scene,method,seed,mutations_per_pixel,seconds_cpu,relmse,relmse_trimmed,floor,ceiling,passes,predicted,chosen >"$out/table.csv"
while read -r name file size integrator spp; do
    make_reference "$name" "$file" "$size" "$integrator" "$spp"
    for method in "${methods[@]}"; do
        # shellcheck disable=SC2086
        mpp=$(budget "$file" "$size" $method)
        for seed in $seeds; do
            # shellcheck disable=SC2086
            render_small "$file" "$size" "$mpp" "$seed" $method
            row "$name" "$method" "$seed"
        done
    done
    [ -n "${STUCK:-}" ] || continue
    for method in "-i pssmlt" "-i pssmlt --set ceiling=auto" "-i smlt" \
        "-i smlt --set passes_share=0.5 --set share_floor=4"; do
        for seed in $(seq 1 "$STUCK"); do
            # shellcheck disable=SC2086
            render_small "$file" "$size" 100 "$seed" $method
            row "$name" "stuck $method" "$seed"
        done
    done
done < <(scenes box veach-bidir glass-caustic door coffee living-room veach-ajar cornell \
    pool interior splash)

awk -F, '
    NR == 1 { next }
    $2 ~ /^stuck/ { k = $1 "," substr($2, 7); n = ++count[k]; all[k, n] = $6 + 0; next }
    {
        k = $1 SUBSEP $2
        if (!(k in runs)) { order[++cells] = k }
        runs[k]++; cpu[k] += $5; error[k] += $7; tail[k] += $6
    }
    END {
        print "| scene | method | efficiency | relMSE | trimmed | CPU s |"
        print "|---|---|---|---|---|---|"
        for (i = 1; i <= cells; i++) {
            k = order[i]; split(k, part, SUBSEP); n = runs[k]
            printf "| %s | %s | %.0f | %.4g | %.4g | %.2f |\n", part[1], part[2],
                n * n / (cpu[k] * error[k]), tail[k] / n, error[k] / n, cpu[k] / n
        }
        for (k in count) {
            n = count[k]
            for (i = 1; i <= n; i++) v[i] = all[k, i]
            for (i = 2; i <= n; i++)
                for (j = i; j > 1 && v[j - 1] > v[j]; j--) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
            printf "\n%s: worst relMSE of %d seeds %.4g, median %.4g, ratio %.3g\n", k, n, v[n],
                v[int((n + 1) / 2)], v[n] / v[int((n + 1) / 2)]
        }
    }' "$out/table.csv" >"$out/table.md"
cat "$out/table.md"
