#!/usr/bin/env bash
# make bench-efficiency: relMSE times CPU seconds on the peer-box, diffuse, 256x256: pssmlt
# over both builders, mmlt with and without chains for the short paths, at p_l .3 and
# automatic. `less the floor`: with the reference's own noise (FLOOR, as bench/peer_box.sh
# finds it) taken off. `ratio`: the product over that of another implementation of mmlt on
# the same scene, relMSE .00481 after 8.0 CPU seconds. An mmlt run's error hangs on which
# long paths it met: mean and standard error of SEEDS=8 runs. MPP=256.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
folder=../shared/scenes/peer-box
floor=${FLOOR:-1.25e-4}
other=$(awk 'BEGIN { print .00481 * 8.0 }')
need $folder/diffuse{.pbrt,-reference.exr}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# row NAME P_L SEEDS OPTIONS...: p_l, relMSE and seconds of every seed, and their means.
row() {
    local name=$1 p=$2 seeds=$3 seed
    shift 3
    for ((seed = 1; seed <= seeds; seed++)); do
        "$etalon" render $folder/diffuse.pbrt --max-depth 6 --large-step "$p" --seed $seed \
            --mpp "${MPP:-256}" "$@" --stats "$work/s.yaml" -o "$work/s.exr" >/dev/null
        "$etalon" compare "$work/s.exr" $folder/diffuse-reference.exr >"$work/compare"
        echo "$(value p_l "$work/s.yaml") $(value relmse "$work/compare")" \
            "$(value seconds_cpu "$work/s.yaml")"
    done | awk -v name="$name" -v p="$p" -v f="$floor" -v other="$other" '
        {
            q += $1; e += $2; t += $3
            x = $2 * $3; sum += x; squares += x * x; less += ($2 - f) * $3
        }
        END {
            mean = sum / NR
            se = NR > 1 ? sqrt((squares / NR - mean * mean) / (NR - 1)) : 0
            spread = NR > 1 ? sprintf("+- %.4f", se) : ""
            ratio_spread = NR > 1 ? sprintf("+- %.2f", se / other) : ""
            printf "%-14s %-6s %5d %10.4e %8.2f %8.4f %-9s %14.4f %8.2f %s\n", name,
                p == "auto" ? sprintf("%.3f*", q / NR) : p, NR, e / NR, t / NR, mean,
                spread, less / NR, mean / other, ratio_spread
        }'
}

printf '%-14s %-6s %5s %10s %8s %18s %14s %8s\n' integrator p_l seeds relMSE 'CPU s' \
    'relMSE x s' 'less the floor' ratio
for builder in bdpt pt; do
    for p in .3 auto; do
        row "pssmlt-$builder" $p 1 -i pssmlt --set builder=$builder
    done
done
for direct in joint separate; do
    for p in .3 auto; do
        row "mmlt-$direct" $p "${SEEDS:-8}" -i mmlt --set direct=$direct
    done
done
echo "* automatic (the mean over seeds)"
