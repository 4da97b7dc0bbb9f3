#!/usr/bin/env bash
# make bench-pfmcmc: the 1D model of [Zeng19, section 4.1], Table 2 beside the paper's and
# Figures 2 and 3 again; then what that model hides, the bias of redrawn failures where
# their probability varies. A minute; leaves data, tables and plots in results/pfmcmc/.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C.UTF-8 # for gnuplot's Greek
trap 'exit 130' INT

bench=${BENCH:-build/release/bench}
out=results/pfmcmc
mkdir -p "$out"
rm -f "$out"/*

"$bench/pfmcmc" "$out" | tee "$out/table2.txt"
"$bench/pfbias" "$out" | tee "$out/bias.txt"
gnuplot -e "out='$out'" bench/plot_pfmcmc.gp
for svg in "$out"/*.svg; do
    rsvg-convert --width 1800 --background-color white "$svg" -o "${svg%.svg}.png"
done
echo
echo "plots: $out/figure2.png, figure3.png, bias.png (and .svg)"
