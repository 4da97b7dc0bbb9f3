#!/usr/bin/env bash
# make bench-mlt: mlt beside pssmlt, mmlt and bdpt, on small pictures at about equal CPU
# time; then mlt with further ways to choose its mutations and what they delete, over more
# seeds. A row of results/mlt/table.csv for each run, and results/mlt/table.md: errors as
# means over seeds; of further ways the error times CPU seconds over that of mlt as it is,
# with a 95 % interval by Student's t of the logarithms over seeds.
#
#   SECONDS_EACH=3 SEEDS="1 2 3"       CPU seconds of a run, seeds
#   VARIANT_SEEDS="1 2 3 4 5 6"        seeds of further ways; empty: none
#   METHODS="-i mmlt;-i mlt"           what is measured on all scenes
#   VARIANTS="-i mlt --set lens_area=.1;..." FURTHER="box door"    further ways, and where
#   SCENES="box door"                  some of the scenes only; rows are appended
#
# References are made once and kept in results/mlt/references; remove them to get new ones.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
. bench/small_scenes.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
out=${OUT:-results/mlt}
seconds=${SECONDS_EACH:-3}
seeds=${SEEDS:-1 2 3}
variant_seeds=${VARIANT_SEEDS-1 2 3 4 5 6}
IFS=';' read -ra methods <<<"${METHODS:--i bdpt;-i pssmlt;-i mmlt;-i mlt}"
IFS=';' read -ra variants <<<"-i mlt;${VARIANTS:--i mlt --set deletion=weighted;-i mlt --set mutation_weights=measured}"
further=" ${FURTHER:-box veach-bidir door glass-caustic} "
mkdir -p "$out"

# row NAME METHOD SEED: of table.csv
row() {
    compare_small "$1"
    local values=() key
    for key in mutations_per_pixel seconds_cpu p_l p_l_reason by_move proposed_by_move \
        acceptance_by_move failures_class_by_move failures_blocked_by_move work_by_move \
        weight_by_move; do
        values+=("\"$(value $key "$out/run.yaml" | tr -d '",')\"")
    done
    (
        IFS=,
        echo "$1,${2#-i },$3,$(value relmse "$out/compare.yaml"),$(
            value relmse_trimmed "$out/compare.yaml"),${values[*]}"
    ) >>"$out/table.csv"
}

# measure NAME FILE SIZE METHOD SEED...: runs that are there already are not made again
measure() {
    local name=$1 file=$2 size=$3 method=$4 mpp='' seed
    shift 4
    for seed; do
        grep -q "^$name,${method#-i },$seed," "$out/table.csv" && continue
        # shellcheck disable=SC2086
        [ -n "$mpp" ] || mpp=$(budget "$file" "$size" $method)
        # shellcheck disable=SC2086
        render_small "$file" "$size" "$mpp" "$seed" $method
        row "$name" "$method" "$seed"
    done
}

[ -s "$out/table.csv" ] || echo scene,method,seed,relmse,relmse_trimmed,mutations_per_pixel,seconds_cpu,p_l,p_l_reason,by_move,proposed_by_move,acceptance_by_move,failures_class_by_move,failures_blocked_by_move,work_by_move,weight_by_move >"$out/table.csv"
while read -r name file size integrator spp; do
    make_reference "$name" "$file" "$size" "$integrator" "$spp"
    for method in "${methods[@]}"; do
        # shellcheck disable=SC2086
        measure "$name" "$file" "$size" "$method" $seeds
    done
    [[ $further == *" $name "* ]] || continue
    for method in "${variants[@]}"; do
        # shellcheck disable=SC2086
        measure "$name" "$file" "$size" "$method" $variant_seeds
    done
done < <(scenes box glass coffee veach-bidir veach-ajar door torus glass-caustic)

columns "$out/table.csv" scene method seed relmse relmse_trimmed seconds_cpu p_l by_move \
    acceptance_by_move p_l_reason | awk -F '\t' -v seeds=" $seeds " "$student_awk"'
    # Of the logarithm of (trimmed error x CPU) over that of mlt, seed by seed.
    function ratio(scene, method,    i, n, d, s, q, m, h) {
        for (i = 1; i <= 100; i++) {
            if (!((scene, method, i) in cost) || !((scene, "mlt", i) in cost)) continue
            d = log(cost[scene, method, i] / cost[scene, "mlt", i])
            n++; s += d; q += d * d
        }
        if (n < 2) return "-"
        m = s / n
        h = half_width(n, s, q)
        return sprintf("%.2f (%.2f to %.2f, %d seeds)", exp(m), exp(m - h), exp(m + h), n)
    }
    {
        k = $1 SUBSEP $2
        cost[$1, $2, $3] = $5 * $6
        moves[k] = $8; accepted[k] = $9; reason[k] = $10
        if (!(k in runs)) order[++cells] = k
        runs[k]++
        error[k] += $4; trimmed[k] += $5; cpu[k] += $6; p[k] += $7
    }
    END {
        print "| scene | method | relMSE | trimmed | CPU s | p_l | over mlt at equal time | acceptance by mutation, last seed |"
        print "|---|---|---|---|---|---|---|---|"
        for (i = 1; i <= cells; i++) {
            k = order[i]; n = runs[k]; split(k, part, SUBSEP); words = ""
            count = split(moves[k], name, " "); split(accepted[k], a, " ")
            for (j = 1; part[2] ~ /^mlt/ && j <= count; j++)
                words = words sprintf("%s%s %.3g", j > 1 ? ", " : "", name[j], a[j])
            printf "| %s | %s | %.4g | %.4g | %.2f | %.2f | %s | %s |\n", part[1], part[2],
                error[k] / n, trimmed[k] / n, cpu[k] / n, p[k] / n,
                part[2] == "mlt" ? "1" : ratio(part[1], part[2]), words
        }
        print "\n| scene | p_l of mlt | reason, last seed |\n|---|---|---|"
        for (i = 1; i <= cells; i++) {
            k = order[i]; split(k, part, SUBSEP)
            if (part[2] == "mlt")
                printf "| %s | %.2f | %s |\n", part[1], p[k] / runs[k], reason[k]
        }
    }' >"$out/table.md"
cat "$out/table.md"
