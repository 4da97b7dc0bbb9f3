#!/usr/bin/env bash
# make demo: glass-caustic by pssmlt with automatic p_l and with three manual ones, all with
# the same time, against a bdpt reference that is made once and kept. Leaves pictures,
# statistics, error logs and the plot in results/demo/.
#
# SECONDS_EACH=30 and SECONDS_REFERENCE=90 may be set; all of it takes about four minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C
# Interrupted, the program ends well with what it has; we must not go on with that.
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
each=${SECONDS_EACH:-30}
reference_time=${SECONDS_REFERENCE:-90}
scene=scenes/glass-caustic/scene.yaml
common=(--size 480x270)
out=results/demo
manual=(.05 .3 .9)
mkdir -p "$out" results/references

# Anything that may change the right answer makes a new reference.
hash=$({
    cat "$scene" "$etalon"
    echo "${common[*]} $reference_time"
} | sha256sum | cut -c 1-16)
reference=results/references/demo-$hash.exr
if [ ! -s "$reference" ]; then
    echo "reference: bdpt, $reference_time s (kept in $reference)"
    "$etalon" render "$scene" "${common[@]}" -i bdpt --seed 1000 \
        --seconds "$reference_time" -o "$reference.part.exr"
    mv "$reference.part.exr" "$reference"
    rm -f "$reference.part.png"
fi

render() { # p_l, name
    echo "pssmlt, p_l $1, $each s"
    "$etalon" render "$scene" "${common[@]}" -i pssmlt --large-step "$1" \
        --seconds "$each" --reference "$reference" --errors "$out/$2.csv" \
        --stats "$out/$2.yaml" -o "$out/$2.exr"
}
rm -f "$out"/*.csv "$out"/*.yaml
render auto auto
for p in "${manual[@]}"; do
    render "$p" "p$p"
done

value() { # key, file
    sed -n "s/^$1: *//p" "$2" | sed 's/^"\(.*\)"$/\1/'
}
last() { # column, file
    awk -F, -v column="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == column) at = i }
        NR > 1 && at { x = $at } END { print x }' "$2"
}

p_auto=$(printf '%.3g' "$(value p_l "$out/auto.yaml")")
gnuplot -e "out='$out'; manual='${manual[*]}'; p_auto='$p_auto'; scene='glass-caustic'" \
    bench/plot_errors.gp
rsvg-convert --width 1800 --background-color white "$out/errors.svg" -o "$out/errors.png"

echo
printf '%-14s %10s %12s %14s %12s %10s\n' p_l relMSE trimmed 'mean ratio' 'mut./pixel' 'CPU s'
row() { # label, name
    printf '%-14s %10.4g %12.4g %14.5f %12.1f %10.1f\n' "$1" \
        "$(last relmse "$out/$2.csv")" "$(last relmse_trimmed "$out/$2.csv")" \
        "$(last mean_ratio "$out/$2.csv")" "$(last mutations_per_pixel "$out/$2.csv")" \
        "$(last cpu_s "$out/$2.csv")"
}
row "auto ($p_auto)" auto
for p in "${manual[@]}"; do
    row "$p" "p$p"
done
cat <<END

why this p_l: $(value p_l_reason "$out/auto.yaml")
picture:      $out/auto.png ($out/auto.exr)
statistics:   $out/auto.yaml
plot:         $out/errors.svg, $out/errors.png
reference:    $reference
The reference is bdpt of $reference_time s and has noise of its own, which every line ends on; relMSE is ruled by
its brightest mistakes, so read both columns (and both halves of the plot).
END
