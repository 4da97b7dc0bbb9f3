#!/usr/bin/env bash
# make bench-peer_box: every integrator against the peer-box's references, which other
# renderers made: mean ratios, and relMSE at 16, 32, ... samples a pixel with the fit
# relMSE = c / N^a + f, where a = 1 is due and f is the references' own noise; for pt and
# bdpt also every block of 16x16 pixels by t-tests (bench/regions.c). pfmlt-biased is mode
# paper: its f holds its bias too. All of it is left in results/peer-box/. MOST=512 may be
# set.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
regions=${REGIONS:-build/release/bench/regions}
folder=../shared/scenes/peer-box
most=${MOST:-512}
out=results/peer-box
need $folder/{diffuse,glass}{.pbrt,-reference.exr}
mkdir -p $out

# fit FILE: "a +- se, f +- se" of lines "N relMSE", each as good as the other in its log.
fit() {
    gnuplot 2>/dev/null <<END | tail -n 1
set fit quiet logfile '/dev/null' errorvariables
a = 1; lc = log(.1); lf = log(1e-4)
model(x) = log(exp(lc - a * log(x)) + exp(lf))
fit model(x) '$1' using 1:(log(\$2)) via a, lc, lf
set print '-'
print sprintf('%.3f +- %.3f, f = %.2e +- %.0e', a, a_err, exp(lf), exp(lf) * lf_err)
END
}

# design SCENE NAME OPTIONS...
design() {
    local scene=$1 name=$2 n file
    shift 2
    : >"$out/$scene-$name.dat"
    for ((n = 16; n <= most; n *= 2)); do
        file=$out/$scene-$name-$n
        "$etalon" render $folder/$scene.pbrt --max-depth 6 "$@" --mpp $n --seed $n \
            --stats "$file.yaml" -o "$file.exr" >/dev/null
        "$etalon" compare "$file.exr" $folder/$scene-reference.exr \
            -o "$file-difference.png" >"$file.compare"
        echo "$n $(value relmse "$file.compare")" >>"$out/$scene-$name.dat"
        printf '%-8s %-13s %5d %10.4e %10.4e %9.5f %8.5f %9.5f %8.5f %8.5f %6.1f\n' \
            $scene "$name" $n "$(value relmse "$file.compare")" \
            "$(value relmse_trimmed "$file.compare")" \
            "$(value mean_ratio "$file.compare")" \
            "$(awk "BEGIN { print $(value b_se "$file.yaml") / $(value b "$file.yaml") }")" \
            "$(value mean_ratio_r "$file.compare")" \
            "$(value mean_ratio_g "$file.compare")" \
            "$(value mean_ratio_b "$file.compare")" \
            "$(value seconds_cpu "$file.yaml")"
    done
    # A chain's pixels hang together: no t-test from their spread.
    [[ $name = *mlt* ]] ||
        "$regions" $folder/$scene-reference.exr 16 $out/mean.exr "$out/$scene-$name.map" \
            "$file.exr" | sed 's/^/         /'
    echo "         relMSE = c / N^a + f: a = $(fit "$out/$scene-$name.dat")"
}

printf '%-8s %-13s %5s %10s %10s %9s %8s %9s %8s %8s %6s\n' scene integrator N relMSE \
    trimmed 'mean r.' b_se/b red green blue 'CPU s'
for scene in diffuse glass; do
    [ $scene = glass ] || design $scene pt -i pt
    design $scene bdpt -i bdpt
    design $scene pssmlt-bdpt -i pssmlt --set builder=bdpt
    design $scene pssmlt-pt -i pssmlt --set builder=pt
    design $scene mmlt -i mmlt
    design $scene mmlt-separate -i mmlt --set direct=separate
    design $scene pfmlt-exact -i pfmlt --set mode=exact
    design $scene pfmlt-counted -i pfmlt --set mode=counted
    design $scene pfmlt-biased -i pfmlt --set mode=paper
done
