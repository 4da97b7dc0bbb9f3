#!/usr/bin/env bash
# make bench-startup_table: what the measured start finds on every scene at hand, by pssmlt
# over both builders, mmlt and pfmlt (its modes: exact, counted, and paper, which is biased),
# and whether eta_s >= eta_l and eta_l <= eta_0 hold: "no" where the error is
# beyond three standard errors, "?" where the signs are wrong within them.
# MPP=256, START=.05 (its share that is measured) may be set.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
shared=../shared/scenes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

declare -A designs=(
    [pssmlt-bdpt]="-i pssmlt --set builder=bdpt" [pssmlt-pt]="-i pssmlt --set builder=pt"
    [mmlt]="-i mmlt" [pfmlt-exact]="-i pfmlt --set mode=exact"
    [pfmlt-counted]="-i pfmlt --set mode=counted" [pfmlt-biased]="-i pfmlt --set mode=paper"
)

holds() { # holds SMALLER SE LARGER SE
    awk -v a="$1" -v sa="$2" -v b="$3" -v sb="$4" 'BEGIN {
        print a <= b ? "yes" : a - b <= 3 * sqrt(sa * sa + sb * sb) ? "?" : "no" }'
}

row() { # row SCENE DESIGN OPTIONS...; a design is a key of `designs`
    local scene=$1 design=$2 file=$work/statistics.yaml name
    shift 2
    # shellcheck disable=SC2086 # the options of a design are words
    "$etalon" startup "$scene" "$@" --mpp "${MPP:-256}" --set start="${START:-.05}" --set rule=zsolnai2013 \
        ${designs[$design]} >"$file" 2>/dev/null
    name=${scene#scenes/}
    name=${name#"$shared"/}
    name=${name%/scene.*}
    printf '%-26s %-14s' "${name%.*}" "$design"
    for key in eta_s eta_l eta_0; do
        printf ' %7.4f +- %.4f' "$(value $key "$file")" "$(value ${key}_se "$file")"
    done
    printf ' %7.4f [%6.4f,%6.4f] %6.4f [%6.4f,%6.4f]' "$(value r "$file")" \
        "$(value r_lo "$file")" "$(value r_hi "$file")" "$(value p_l "$file")" \
        "$(value p_l_lo "$file")" "$(value p_l_hi "$file")"
    printf ' %-4s %s\n' "$(holds "$(value eta_l "$file")" "$(value eta_l_se "$file")" \
        "$(value eta_s "$file")" "$(value eta_s_se "$file")")" \
        "$(holds "$(value eta_l "$file")" 0 "$(value eta_0 "$file")" 0)"
}

printf '%-26s %-14s %17s %17s %17s %23s %22s  %s\n' scene design eta_s eta_l eta_0 \
    'r [99 %]' 'p_l [99 %]' 'l<=s l<=0'
for design in pssmlt-bdpt pssmlt-pt mmlt pfmlt-exact pfmlt-counted pfmlt-biased; do
    for scene in scenes/*/*.yaml; do
        row "$scene" $design --size 128x128
    done
    [ -e $shared ] || continue
    for scene in $shared/peer-box/{diffuse,glass}.pbrt; do
        row "$scene" $design --size 128x128 --max-depth 6
    done
    row $shared/cornell-box-pbrt3/scene.pbrt $design --size 128x128
    row $shared/coffee-pbrt3/scene.pbrt $design --size 120x150 --max-depth 12
done
