#!/usr/bin/env bash
# make bench-efficiency: relMSE times CPU seconds on the peer-box, diffuse, 256x256, with
# the reference's own noise (FLOOR, as bench/peer_box.sh finds it) taken off. MPP=256.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
folder=../shared/scenes/peer-box
floor=${FLOOR:-1.25e-4}
need $folder/diffuse{.pbrt,-reference.exr}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

printf '%-12s %-6s %10s %8s %12s %14s\n' integrator p_l relMSE 'CPU s' 'relMSE x s' \
    'less the floor'
for builder in bdpt pt; do
    for p in .3 auto; do
        "$etalon" render $folder/diffuse.pbrt --max-depth 6 -i pssmlt --large-step $p \
            --set builder=$builder --mpp "${MPP:-256}" --stats "$work/s.yaml" \
            -o "$work/s.exr" >/dev/null
        "$etalon" compare "$work/s.exr" $folder/diffuse-reference.exr >"$work/compare"
        awk -v name="pssmlt-$builder" -v p=$p -v q="$(value p_l "$work/s.yaml")" \
            -v e="$(value relmse "$work/compare")" -v f="$floor" \
            -v t="$(value seconds_cpu "$work/s.yaml")" 'BEGIN {
            printf "%-12s %-6s %10.4e %8.2f %12.4f %14.4f\n", name,
                p == "auto" ? sprintf("%.3f*", q) : p, e, t, e * t, (e - f) * t }'
    done
done
echo "* automatic"
