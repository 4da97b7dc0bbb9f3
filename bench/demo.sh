#!/usr/bin/env bash
# make demo, on scenes/glass-caustic by pssmlt:
#
# - config/demo.yaml: automatic p_l against the published rule's and six manual values at
#   equal time, eight seeds each, measured against a bdpt reference that is made once and
#   kept in results/references;
# - a picture of 600x400 with automatic p_l;
# - two plots (error against time; error against p_l, as measured and as the starts predicted
#   it), a table, the outcome in words, and the page of `etalon report`.
#
# Everything is in results/demo/, which is emptied first. RUN_SECONDS=3 and PICTURE_SECONDS=90
# may be set; with these values all of it takes under five minutes on two processors.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C
# An interrupted render exits with status 0; the demo must not go on with it.
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
run_seconds=${RUN_SECONDS:-3}
picture_seconds=${PICTURE_SECONDS:-90}
out=results/demo

source bench/lib.bash

echo "--- automatic, published and manual p_l, 64 runs of $run_seconds s; first, once, an 80 s reference"
rm -rf "$out"
mkdir -p "$out"
sed -e "s|\.\./scenes|../../scenes|" -e "s|^budget:.*|budget: {seconds: $run_seconds}|" \
    config/demo.yaml >"$out/demo.yaml"
"$etalon" bench "$out/demo.yaml" -o "$out" --jobs "$(nproc)" |
    sed -un '/^reference/s/^/    /p; /p_l=auto/s/^/    /p'

echo "--- the picture, automatic p_l, $picture_seconds s"
"$etalon" render scenes/glass-caustic/scene.yaml --size 600x400 --seconds "$picture_seconds" \
    --stats "$out/picture.yaml" -o "$out/picture.exr" | sed 's/^/    /'

# --- errors at equal time ---------------------------------------------------------------
errors() { # "curves" or "values"
    awk -v out="$1" -f bench/demo.awk \
        <(columns "$out/runs.csv" job p_l_source p_l seed rule) \
        <(columns "$out/curves.csv" job cpu_s relmse_trimmed)
}
errors curves >"$out/curves.dat"
errors values >"$out/values.dat"
columns "$out/runs.csv" rule p_l_source p_l predicted_p predicted_relmse predicted_cost |
    awk -f bench/demo_predicted.awk >"$out/predicted.dat"
reference=$(columns "$out/runs.csv" reference | head -n 1)
noise=$(value relmse_trimmed "$(dirname "$out/$reference")/noise.yaml")

gnuplot -e "out='$out'; noise=$noise" bench/plot_demo.gp
for plot in errors p_l; do
    rsvg-convert --width 1600 --background-color white "$out/$plot.svg" -o "$out/$plot.png"
done
"$etalon" report "$out" >/dev/null

# --- the outcome ------------------------------------------------------------------------
table() {
    awk -F '\t' -v noise="$noise" '
        function interval(lo, hi) { return sprintf("[%.4g, %.4g]", lo, hi) }
        function verdict() {
            return $8 < 1 ? "automatic wins" : $7 > 1 ? "automatic loses" : "no difference seen"
        }
        NR == 1 {
            printf "%s, %d seeds, each run after %.2f CPU seconds\n\n", \
                "Error (relMSE without the 1 % worst pixels)", $9, $10
            printf "%-18s %9s  %-19s  %s\n", "p_l", "error", "95 % interval", \
                "error of automatic / error of this one"
            printf "%-18s %9.4g  %-19s\n", sprintf("automatic: %.2f", $2), $3, interval($4, $5)
            next
        }
        { printf "%-18s %9.4g  %-19s  %.2f %s  %s\n", \
              $1 == "published" ? sprintf("published: %.2f", $2) : $1, $3, interval($4, $5), $6, \
              sprintf("[%.2f, %.2f]", $7, $8), \
              verdict() }
        END { printf "%-18s %9.4g\n", "reference itself", noise }' "$out/values.dat"
}
# What an interval of a ratio says, in words.
words() {
    awk -F '\t' '
        function percent(x) { return sprintf("%.0f", 100 * (x - 1)) }
        NR == 1 { auto = sprintf("%.2f", $2); next }
        { name = "p_l = " $1 }
        $1 == "published" { name = sprintf("p_l = %.2f, which the published rule sets,", $2) }
        $8 < 1 { won = won sprintf("\n  - than with %s by %s %% (95 %% interval: %s to %s %%)", \
                     name, 0 - percent($6), 0 - percent($8), 0 - percent($7)); next }
        $7 > 1 { lost = lost sprintf("\n  - than with %s by %s %% (95 %% interval: %s to %s %%)", \
                     name, percent($6), percent($7), percent($8)); next }
        { even = even (even ? "; " : "") name }
        END {
            printf "Etalon set p_l = %s.\n", auto
            if (won) print "With it the error at equal time was lower" won
            if (lost) print "With it the error at equal time was higher" lost
            if (even) print "No difference was seen to " even "."
            if (!lost) print "No other value was seen to be better."
        }' "$out/values.dat"
    "$etalon" report "$out" --text --error relmse_trimmed | sed -nE \
        's/^ *regret: *([0-9.]+) \[([0-9.]+), ([0-9.]+)\].*best manual p_l ([0-9.]+);.*/\1 \2 \3 \4/p' |
        awk '{ printf "Against the best of the manual values, %s, the automatic error is %.2f times as large\n" \
                   "(95 %% interval: %.2f to %.2f%s).\n", $4, $1, $2, $3, \
                   ($2 < 1 && $3 > 1 ? ", so it may be no larger" : "") }'
}
{
    table
    echo
    words
} >"$out/outcome.txt"
echo
cat "$out/outcome.txt"
cat <<END

Where the intervals come from: errors are compared at the CPU time that all runs reached. A ratio
compares runs with the same seed; its interval is Student's over the seeds, for each value alone.
The best manual value is chosen on one half of the seeds and judged on the other; its interval is a
bootstrap over seeds (etalon report --text). The reference's own noise is in every error.

why this p_l  $(value p_l_reason "$out/picture.yaml")
picture       $out/picture.png ($out/picture.exr, $out/picture.yaml)
plots         $out/errors.png (error against time), $out/p_l.png (error against p_l: measured, and
              predicted by the starts of the automatic runs)
page          $out/report.html
END
