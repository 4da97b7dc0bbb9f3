#!/usr/bin/env bash
# make demo: glass-caustic by pssmlt with automatic p_l and with three manual ones, all with
# the same time, against a bdpt reference that is made once and kept. Leaves pictures,
# statistics, error logs and the plot in results/demo/.
#
# The reference is the mean of two halves of different seeds, so that its own noise can be
# told: E[((A-B)/2)^2] is the variance of (A+B)/2, and A - (A+B)/2 is (A-B)/2.
#
# SECONDS_EACH=30 and SECONDS_REFERENCE=110 may be set; all of it takes under five minutes.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C
# Interrupted, the program ends well with what it has; we must not go on with that.
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
each=${SECONDS_EACH:-30}
reference_time=${SECONDS_REFERENCE:-110}
scene=scenes/glass-caustic/scene.yaml
size=300x200
out=results/demo
manual=(.05 .3 .9)
# To be raised when a change of the program changes what bdpt converges to.
reference_version=1

source bench/lib.bash

# --- the reference -----------------------------------------------------------------------
key=$({
    cat "$scene"
    echo "$size $reference_time $reference_version"
} | sha256sum | cut -c 1-12)
reference=results/references/glass-caustic-$key
mkdir -p "$out" results/references
half() { # seed
    "$etalon" render "$scene" --size "$size" -i bdpt --seed "$1" \
        --seconds "$(awk "BEGIN { print $reference_time / 2 }")" \
        -o "$reference.part/seed$1.exr" >/dev/null
}
if [ ! -d "$reference" ]; then
    echo "reference: bdpt, two halves, together $reference_time s; kept in $reference"
    rm -rf "$reference.part"
    mkdir "$reference.part"
    half 1001
    half 1002
    (
        cd "$reference.part"
        etalon=$(cd "$OLDPWD" && realpath "$etalon")
        "$etalon" compare seed1001.exr seed1002.exr --mean mean.exr >halves.yaml
        "$etalon" compare seed1001.exr mean.exr >noise.yaml
    )
    mv "$reference.part" "$reference"
fi
noise=$(value relmse "$reference/noise.yaml")
noise_trimmed=$(value relmse_trimmed "$reference/noise.yaml")

# --- the four runs -----------------------------------------------------------------------
render() { # p_l, name
    "$etalon" render "$scene" --size "$size" -i pssmlt --large-step "$1" \
        --seconds "$each" --reference "$reference/mean.exr" --errors "$out/$2.csv" \
        --stats "$out/$2.yaml" -o "$out/$2.exr"
}
rm -f "$out"/*
echo "pssmlt, p_l automatic, $each s"
render auto auto | sed 's/^/    /'
for p in "${manual[@]}"; do
    echo "pssmlt, p_l $p, $each s"
    render "$p" "p$p" >/dev/null
done

# --- what came of it ---------------------------------------------------------------------
p_auto=$(printf '%.2f' "$(value p_l "$out/auto.yaml")")
gnuplot -e "out='$out'; manual='${manual[*]}'; p_auto='$p_auto'; scene='glass-caustic'; \
noise='$noise $noise_trimmed'" bench/plot_errors.gp
rsvg-convert --width 1800 --background-color white "$out/errors.svg" -o "$out/errors.png"

# On a busy machine the same seconds are not the same work: errors are told at the CPU time
# that every run reached, between two points of a curve along the line of the log-log plot.
common=$(for name in auto "${manual[@]/#/p}"; do last cpu_s "$out/$name.csv"; done |
    sort -g | head -n 1)
at_common() { # column, file
    awk -F, -v column="$1" -v t="$common" '
        NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
        { x1 = $at["cpu_s"]; y1 = $at[column] }
        x1 >= t { exit }
        { x0 = x1; y0 = y1 }
        END { if (x0 > 0 && x1 > x0) y1 = y0 * (y1 / y0) ^ (log(t / x0) / log(x1 / x0))
              print y1 }
        ' "$2"
}
row() { # label, name
    printf '%-20s %9.5f %9.5f %11.5f %11.1f %8.1f\n' "$1" \
        "$(at_common relmse "$out/$2.csv")" "$(at_common relmse_trimmed "$out/$2.csv")" \
        "$(last mean_ratio "$out/$2.csv")" "$(last mutations_per_pixel "$out/$2.csv")" \
        "$(last cpu_s "$out/$2.csv")"
}
table() {
    printf '%-20s %-19s %11s %11s %8s\n' '' "after $(printf %.1f "$common") CPU s:" 'in the end:' '' ''
    printf '%-20s %9s %9s %11s %11s %8s\n' p_l relMSE trimmed 'mean ratio' mut./pixel 'CPU s'
    row "automatic: $p_auto" auto
    for p in "${manual[@]}"; do
        row "$p" "p$p"
    done
    printf '%-20s %9.5f %9.5f\n' "reference's noise" "$noise" "$noise_trimmed"
}
echo
table | tee "$out/table.txt"
cat <<END

why this p_l: $(value p_l_reason "$out/auto.yaml")
picture:      $out/auto.png ($out/auto.exr)
statistics:   $out/auto.yaml
plot:         $out/errors.svg, $out/errors.png
reference:    $reference (bdpt, $reference_time s)

Every error above contains the reference's own noise, which was measured from its two halves; nothing
was subtracted. "Trimmed" is without the 0.1 % worst pixels.
END
