#!/usr/bin/env bash
# make bench: mutations (pt, bdpt: samples) per CPU second. SCENE, SIZE, DEPTH and MPP may be
# set; the default is the peer-box where its folder is there, else our own cornell.
set -euo pipefail
export LC_ALL=C
cd "$(dirname "$0")/.."

etalon=${ETALON:-build/release/etalon}
peer=../shared/scenes/peer-box/diffuse.pbrt
scene=${SCENE:-$([ -e "$peer" ] && echo "$peer" || echo scenes/cornell/scene.yaml)}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

value() {
    sed -n "s/^$1: *//p" "$work/stats.yaml"
}
echo "$scene, ${SIZE:-256x256}, ${DEPTH:-6} edges, ${MPP:-64} per pixel"
printf '%-24s %14s %10s %8s\n' integrator 'per CPU s' 'CPU s' threads
for design in 'pssmlt bdpt' 'pssmlt pt' 'bdpt -' 'pt -'; do
    read -r integrator builder <<<"$design"
    options=(-i "$integrator" --mpp "${MPP:-64}" --size "${SIZE:-256x256}"
        --max-depth "${DEPTH:-6}" --stats "$work/stats.yaml" -o "$work/out.exr")
    [ "$builder" = - ] || options+=(--set "builder=$builder")
    "$etalon" render "$scene" "${options[@]}" >/dev/null
    awk -v name="$integrator ${builder#-}" -v paths="$(value paths)" \
        -v cpu="$(value seconds_cpu)" -v threads="$(value threads)" \
        'BEGIN { printf "%-24s %14.0f %10.2f %8d\n", name, paths / cpu, cpu, threads }'
done
