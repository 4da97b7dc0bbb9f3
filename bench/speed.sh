#!/usr/bin/env bash
# make bench-speed: mutations (pt, bdpt: samples) per CPU second, and the share that bare Embree
# would take on the same rays. SCENE, SIZE, DEPTH and SECONDS_EACH may be set; the default
# scene is the peer-box where its folder is there, else our own cornell.
set -euo pipefail
cd "$(dirname "$0")/.."

speed=${SPEED:-build/release/bench/speed}
peer=../shared/scenes/peer-box/diffuse.pbrt
scene=${SCENE:-$([ -e "$peer" ] && echo "$peer" || echo scenes/cornell/scene.yaml)}
settings=("size=${SIZE:-256x256}" "max_depth=${DEPTH:-6}")

echo "$scene ${settings[*]}"
for design in 'integrator=pssmlt builder=bdpt' 'integrator=pssmlt builder=pt' \
    integrator=bdpt integrator=pt; do
    echo "$design"
    read -ra design <<<"$design"
    "$speed" "$scene" "${SECONDS_EACH:-5}" "${settings[@]}" "${design[@]}" |
        sed 's/^/    /'
done
