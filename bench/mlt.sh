#!/usr/bin/env bash
# make bench-mlt: mlt beside pssmlt, mmlt and bdpt, on small pictures at about equal CPU
# time; then mlt with further ways to choose its mutations and what they delete, over more
# seeds. A row of results/mlt/table.csv for each run, and results/mlt/table.md: errors as
# means over seeds; of further ways the error times CPU seconds over that of mlt as it is,
# with a 95 % interval by Student's t of the logarithms over seeds.
#
#   SECONDS_EACH=3 SEEDS="1 2 3"       CPU seconds of a run, seeds
#   VARIANT_SEEDS="1 2 3 4 5 6"        seeds of further ways; empty: none
#   SCENES="box door"                  some of the scenes only; rows are appended
#
# References are made once and kept in results/mlt/references; remove them to get new ones.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
out=${OUT:-results/mlt}
seconds=${SECONDS_EACH:-3}
seeds=${SEEDS:-1 2 3}
variant_seeds=${VARIANT_SEEDS-1 2 3 4 5 6}
shared=../shared/scenes
methods=("-i bdpt" "-i pssmlt" "-i mmlt" "-i mlt")
variants=("-i mlt" "-i mlt --set deletion=weighted" "-i mlt --set mutation_weights=measured")
mkdir -p "$out/references"

# name, scene, size, integrator and samples a pixel of its reference, whether further ways
# are tried
scenes() {
    cat <<END
box $shared/peer-box/diffuse.pbrt 60x48 bdpt 2500 yes
glass $shared/peer-box/glass.pbrt 60x48 bdpt 2500 no
coffee $shared/coffee-pbrt3/scene.pbrt 48x60 pt 8000 no
veach-bidir $shared/veach-bidir-mitsuba/scene.xml 64x36 bdpt 2500 yes
veach-ajar $shared/veach-ajar-mitsuba/scene.xml 64x36 mmlt 16000 no
door scenes/door/scene.yaml 60x45 mmlt 20000 yes
torus $shared/torus-dpt/h2mc.xml 48x48 mmlt 16000 no
glass-caustic scenes/glass-caustic/scene.yaml 60x45 mmlt 20000 yes
END
}

# render FILE SIZE MPP SEED METHOD...: statistics in $out/run.yaml, picture beside it
render() {
    local file=$1 size=$2 mpp=$3 seed=$4
    shift 4
    "$etalon" render "$file" --size "$size" --threads 1 --mpp "$mpp" --seed "$seed" "$@" \
        --stats "$out/run.yaml" -o "$out/run.exr" >/dev/null 2>&1
}

# row NAME METHOD SEED: of table.csv
row() {
    "$etalon" compare "$out/run.exr" "$out/references/$1.exr" >"$out/compare.yaml"
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
        if [ -z "$mpp" ]; then
            # shellcheck disable=SC2086
            render "$file" "$size" 32 99 $method --set bootstrap=4000
            mpp=$(awk "BEGIN { m = 32 * $seconds / $(value seconds_cpu "$out/run.yaml")
                print m < 16 ? 16 : m }")
        fi
        # shellcheck disable=SC2086
        render "$file" "$size" "$mpp" "$seed" $method
        row "$name" "$method" "$seed"
    done
}

[ -s "$out/table.csv" ] || echo scene,method,seed,relmse,relmse_trimmed,mutations_per_pixel,seconds_cpu,p_l,p_l_reason,by_move,proposed_by_move,acceptance_by_move,failures_class_by_move,failures_blocked_by_move,work_by_move,weight_by_move >"$out/table.csv"
while read -r name file size integrator spp further; do
    case " ${SCENES:-$name} " in *" $name "*) ;; *) continue ;; esac
    [ -e "$file" ] || continue
    reference=$out/references/$name.exr
    [ -s "$reference" ] || "$etalon" render "$file" --size "$size" --threads 1 --seed 777 \
        -i "$integrator" --mpp "$spp" -o "$reference" >/dev/null 2>&1
    for method in "${methods[@]}"; do
        # shellcheck disable=SC2086
        measure "$name" "$file" "$size" "$method" $seeds
    done
    [ "$further" = yes ] || continue
    for method in "${variants[@]}"; do
        # shellcheck disable=SC2086
        measure "$name" "$file" "$size" "$method" $variant_seeds
    done
done < <(scenes)

columns "$out/table.csv" scene method seed relmse relmse_trimmed seconds_cpu p_l by_move \
    acceptance_by_move | awk -F '\t' -v seeds=" $seeds " '
    # Quantile .975 of t with n degrees of freedom, within 1 % from n = 3 on.
    function t95(n) {
        return n == 1 ? 12.706 : n == 2 ? 4.303 : 1.96 + 2.37 / n + 2.82 / n ^ 2 + 2.5 / n ^ 3
    }
    # Of the logarithm of (trimmed error x CPU) over that of mlt, seed by seed.
    function ratio(scene, method,    i, n, d, s, q, m, h) {
        for (i = 1; i <= 100; i++) {
            if (!((scene, method, i) in cost) || !((scene, "mlt", i) in cost)) continue
            d = log(cost[scene, method, i] / cost[scene, "mlt", i])
            n++; s += d; q += d * d
        }
        if (n < 2) return "-"
        m = s / n
        h = t95(n - 1) * sqrt((q - n * m * m) / (n - 1) / n)
        return sprintf("%.2f (%.2f to %.2f, %d seeds)", exp(m), exp(m - h), exp(m + h), n)
    }
    {
        k = $1 SUBSEP $2
        cost[$1, $2, $3] = $5 * $6
        moves[k] = $8; accepted[k] = $9
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
    }' >"$out/table.md"
cat "$out/table.md"
