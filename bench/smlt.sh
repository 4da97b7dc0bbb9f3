#!/usr/bin/env bash
# make bench-smlt: smlt beside pt, bdpt, pssmlt and mmlt, on small pictures at about equal
# CPU time; a row of results/smlt/table.csv for each run, and results/smlt/table.md: relMSE
# without its highest 1 %, means over the seeds, as efficiency 1/(relMSE x CPU seconds).
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
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
out=${OUT:-results/smlt}
seconds=${SECONDS_EACH:-4}
seeds=${SEEDS:-1 2}
shared=../shared/scenes
methods=("-i pt" "-i bdpt" "-i pssmlt" "-i mmlt" "-i smlt" "-i smlt --set builder=pt"
    "-i smlt --set metropolis=mmlt")
mkdir -p "$out/references"

# name, scene, size, integrator and samples a pixel of its reference
scenes() {
    cat <<END
box $shared/peer-box/diffuse.pbrt 60x48 bdpt 2500
veach-bidir $shared/veach-bidir-mitsuba/scene.xml 64x36 bdpt 2500
glass-caustic scenes/glass-caustic/scene.yaml 60x45 mmlt 20000
door scenes/door/scene.yaml 60x45 mmlt 20000
coffee $shared/coffee-pbrt3/scene.pbrt 48x60 pt 8000
living-room $shared/living-room-pbrt3/scene.pbrt 64x36 bdpt 2500
veach-ajar $shared/veach-ajar-mitsuba/scene.xml 64x36 mmlt 16000
cornell scenes/cornell/scene.yaml 48x48 bdpt 2500
END
}

# render NAME FILE SIZE MPP SEED METHOD...: statistics in $out/run.yaml, picture beside it
render() {
    local file=$2 size=$3 mpp=$4 seed=$5
    shift 5
    "$etalon" render "$file" --size "$size" --threads 1 --mpp "$mpp" --seed "$seed" "$@" \
        --stats "$out/run.yaml" -o "$out/run.exr" >/dev/null 2>&1
}

# a row of table.csv
row() {
    local name=$1 method=$2 seed=$3
    "$etalon" compare "$out/run.exr" "$out/references/$name.exr" >"$out/compare.yaml"
    echo "$name,${method#-i },$seed,$(value mutations_per_pixel "$out/run.yaml"),$(
        value seconds_cpu "$out/run.yaml"),$(value relmse "$out/compare.yaml"),$(
        value relmse_trimmed "$out/compare.yaml"),$(value split_floor "$out/run.yaml"),$(
        value split_ceiling "$out/run.yaml"),$(value split_passes "$out/run.yaml"),$(
        value split_relmse "$out/run.yaml")" >>"$out/table.csv"
}

echo scene,method,seed,mutations_per_pixel,seconds_cpu,relmse,relmse_trimmed,floor,ceiling,passes,predicted >"$out/table.csv"
while read -r name file size integrator spp; do
    case " ${SCENES:-$name} " in *" $name "*) ;; *) continue ;; esac
    [ -e "$file" ] || continue
    reference=$out/references/$name.exr
    [ -s "$reference" ] || "$etalon" render "$file" --size "$size" --threads 1 --seed 777 \
        -i "$integrator" --mpp "$spp" -o "$reference" >/dev/null 2>&1
    for method in "${methods[@]}"; do
        # shellcheck disable=SC2086
        render "$name" "$file" "$size" 32 99 $method --set bootstrap=4000
        mpp=$(awk "BEGIN { m = 32 * $seconds / $(value seconds_cpu "$out/run.yaml")
            print m < 16 ? 16 : m }")
        for seed in $seeds; do
            # shellcheck disable=SC2086
            render "$name" "$file" "$size" "$mpp" "$seed" $method
            row "$name" "$method" "$seed"
        done
    done
    [ -n "${STUCK:-}" ] || continue
    for method in "-i pssmlt" "-i pssmlt --set ceiling=auto" "-i smlt" \
        "-i smlt --set passes_share=0.5 --set share_floor=4"; do
        for seed in $(seq 1 "$STUCK"); do
            # shellcheck disable=SC2086
            render "$name" "$file" "$size" 100 "$seed" $method
            row "$name" "stuck $method" "$seed"
        done
    done
done < <(scenes)

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
