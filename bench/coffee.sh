#!/usr/bin/env bash
# make bench-coffee: coffee-pbrt3 at 240x300, 12 edges, against the picture that pbrt v3
# made: bdpt (two halves, made once and kept) with its mean ratios, difference picture and
# map of blocks; pssmlt with automatic p_l and with manual ones, its statistics, errors and
# plot. All of it is left in results/coffee/.
#
# SPP=1024 (of a bdpt half), SECONDS_EACH=60 may be set; MPP=N gives all pssmlt runs N
# mutations per pixel instead. SKIP_BDPT=1 and SKIP_PSSMLT=1 leave a half out.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
regions=${REGIONS:-build/release/bench/regions}
folder=../shared/scenes/coffee-pbrt3
reference=$folder/reference-240x300-12edges.exr
out=results/coffee
common=(--size 240x300 --max-depth 12)
spp=${SPP:-1024}
budget=(--seconds "${SECONDS_EACH:-60}")
[ -z "${MPP:-}" ] || budget=(--mpp "$MPP")
manual=(.05 .25 .5 .75 1)
need $folder/scene.pbrt $reference
mkdir -p $out

bdpt() {
    local seed half halves=()
    for seed in 1 2; do
        half=$out/bdpt-$spp-$seed.exr
        halves+=("$half")
        [ -s "$half" ] || "$etalon" render $folder/scene.pbrt "${common[@]}" -i bdpt \
            --spp "$spp" --seed $seed -o "$half"
    done
    echo "bdpt, 2 x $spp samples a pixel, against $reference"
    "$regions" $reference 20 $out/bdpt.exr $out/blocks.txt "${halves[@]}"
    "$etalon" compare $out/bdpt.exr $reference --range .1 -o $out/difference.png
    gnuplot <<END
set terminal svg size 1100,520 font 'DejaVu Sans,14' background rgb 'white'
set output '$out/blocks.svg'
set yrange [300:0]; set xrange [0:240]; set size ratio -1
set palette defined (-1 '#2166ac', 0 '#f7f7f7', 1 '#b2182b')
set multiplot layout 1,2 title 'coffee, bdpt against pbrt v3, blocks of 20x20 pixels'
set title 'ratio of luminance'; set cbrange [.98:1.02]
plot '$out/blocks.txt' using 1:2:3 with image pixels notitle
set title 't'; set cbrange [-4:4]
plot '$out/blocks.txt' using 1:2:4 with image pixels notitle
END
    rsvg-convert --width 1100 $out/blocks.svg -o $out/blocks.png
}

pssmlt() { # p_l, name
    "$etalon" render $folder/scene.pbrt "${common[@]}" -i pssmlt --large-step "$1" \
        "${budget[@]}" --reference $reference --errors "$out/$2.csv" \
        --stats "$out/$2.yaml" -o "$out/$2.exr" >"$out/$2.txt"
}

row() { # label, name
    printf '%-14s %10.4g %10.4g %9.5f %12.1f %8.1f %7.3f %9.0f\n' "$1" \
        "$(last relmse "$out/$2.csv")" "$(last relmse_trimmed "$out/$2.csv")" \
        "$(last mean_ratio "$out/$2.csv")" "$(last mutations_per_pixel "$out/$2.csv")" \
        "$(last cpu_s "$out/$2.csv")" "$(value acceptance "$out/$2.yaml")" \
        "$(value longest_stay "$out/$2.yaml")"
}

# Of the reference: what is left of bdpt's distance from it without bdpt's own noise, which
# is a quarter of the distance of its halves.
noise() { # column
    "$etalon" compare $out/bdpt-"$spp"-1.exr $out/bdpt-"$spp"-2.exr >$out/halves.yaml
    "$etalon" compare $out/bdpt.exr $reference >$out/mean.yaml
    awk "BEGIN { print $(value "$1" $out/mean.yaml) - $(value "$1" $out/halves.yaml) / 4 }"
}

chains() {
    local p p_auto noise noise_trimmed
    [ -s $out/bdpt.exr ] || bdpt >/dev/null
    noise=$(noise relmse)
    noise_trimmed=$(noise relmse_trimmed)
    rm -f $out/*.csv
    pssmlt auto auto
    for p in "${manual[@]}"; do
        pssmlt "$p" "p$p"
    done
    p_auto=$(printf '%.3g' "$(value p_l $out/auto.yaml)")
    gnuplot -e "out='$out'; manual='${manual[*]}'; p_auto='$p_auto'; scene='coffee'; \
        reference='the picture by pbrt v3'; noise='$noise $noise_trimmed'; \
        keyplace='bottom left Left reverse font \",11\"'" bench/plot_errors.gp
    rsvg-convert --width 1800 $out/errors.svg -o $out/errors.png
    echo
    cat $out/auto.txt
    echo
    printf '%-14s %10s %10s %9s %12s %8s %7s %9s\n' p_l relMSE trimmed 'mean r.' \
        'mut./pixel' 'CPU s' accept. 'stay'
    row "auto ($p_auto)" auto
    for p in "${manual[@]}"; do
        row "$p" "p$p"
    done
    printf '%-14s %10.4g %10.4g\n' "reference's" "$noise" "$noise_trimmed"
}

[ -n "${SKIP_BDPT:-}" ] || bdpt
[ -n "${SKIP_PSSMLT:-}" ] || chains
