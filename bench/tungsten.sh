#!/usr/bin/env bash
# make bench-tungsten: four scenes by bdpt against the pictures that Tungsten made, reduced
# to a quarter of their size, for a row of depth limits (edges), since Tungsten's own is not
# told: mean ratio, relMSE and trimmed relMSE. Its filter is another (the edges), and so are
# its plastic and substrate. Difference pictures are left in results/tungsten/.
#
# SPP=64 and DEPTHS="..." may be set.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
out=results/tungsten
spp=${SPP:-64}
mkdir -p $out

# scene NAME FILE SIZE DEPTHS: all depths, the last one's difference picture included.
scene() {
    local name=$1 file=../shared/scenes/$2 size=$3 depth picture
    need "$file" "$(dirname "$file")/TungstenRender.exr"
    for depth in ${DEPTHS:-$4}; do
        picture=$out/$name-$depth.exr
        "$etalon" render "$file" --size "$size" --max-depth "$depth" -i bdpt --spp "$spp" \
            -o "$picture" >$out/log.txt 2>&1
        "$etalon" compare "$picture" "$(dirname "$file")/TungstenRender.exr" --reduce 4 \
            --range .2 -o "${picture%.exr}-difference.png" >$out/figures.yaml
        printf '%-12s %5d %10.4f %10.5f %10.5f\n' "$name" "$depth" \
            "$(value mean_ratio $out/figures.yaml)" "$(value relmse $out/figures.yaml)" \
            "$(value relmse_trimmed $out/figures.yaml)"
    done
}

printf '%-12s %5s %10s %10s %10s\n' scene depth "mean ratio" relMSE trimmed
scene veach-mis veach-mis-mitsuba/scene.xml 320x180 "2 3 8"
scene veach-bidir veach-bidir-mitsuba/scene.xml 256x256 "6 7 8 16"
scene veach-ajar veach-ajar-mitsuba/scene.xml 320x180 "8 12 13 16 32"
scene living-room living-room-pbrt3/scene.pbrt 320x180 "8 12 16 32 64"
