#!/usr/bin/env bash
# make bench-living_room: living-room-pbrt3 (environment map, textures, opacity, coats) at
# 320x180, 12 edges, by bdpt in two halves, against the picture that pbrt v3 made: ratios,
# blocks of 20x20 pixels, difference picture. All of it is left in results/living_room/.
#
# SPP=128 (of a half) may be set.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
regions=${REGIONS:-build/release/bench/regions}
folder=../shared/scenes/living-room-pbrt3
reference=$folder/reference-320x180-12edges.exr
out=results/living_room
spp=${SPP:-128}
need $folder/scene.pbrt $reference
mkdir -p $out

halves=()
for seed in 1 2; do
    half=$out/bdpt-$spp-$seed.exr
    halves+=("$half")
    [ -s "$half" ] || "$etalon" render $folder/scene.pbrt --size 320x180 --max-depth 12 \
        -i bdpt --spp "$spp" --seed $seed -o "$half"
done
echo "bdpt, 2 x $spp samples a pixel, against $reference"
"$regions" $reference 20 $out/bdpt.exr $out/blocks.txt "${halves[@]}"
"$etalon" compare $out/bdpt.exr $reference --range .2 -o $out/difference.png
