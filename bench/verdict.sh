#!/usr/bin/env bash
# make bench-verdict: what runs say of themselves against the truth, a reference by bdpt
# with error bars of its own. 20 pairs of scene and budget, and 12 with light that the
# integrator cannot sample or that needs no chain (bench/blind_scenes.bash), SEEDS=3 runs
# each; PAIRS=blind or PAIRS=seen are some of them, and ONLY='scene integrator', a pattern. `said` and `true`: relMSE of the
# luminance as the run estimates it and as it is, the reference's noise taken off;
# `covered`: the share of pixels whose 95 % bar holds the truth; `bright`: of the picture,
# over the reference's. A "converged" is false if relMSE is above 0.1 or above twice what
# was said and three of its standard errors; it is silent about that if it is not
# "converged, but blind" either. References stay in results/verdict (REFERENCES=).
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
. bench/blind_scenes.bash
export LC_ALL=C
trap 'exit 130' INT

coverage=${BENCH:-build/release/bench}/coverage
scenes=../shared/scenes
references=${REFERENCES:-results/verdict}
seeds=${SEEDS:-3}
declare -A scene=(
    [diffuse]="$scenes/peer-box/diffuse.pbrt 256 size=96x96 max_depth=6"
    [glass]="$scenes/peer-box/glass.pbrt 512 size=96x96 max_depth=6"
    [ajar]="$scenes/veach-ajar-mitsuba/scene.xml 1024 size=64x36 max_depth=12"
    [coffee]="$scenes/coffee-pbrt3/scene.pbrt 1024 size=60x75 max_depth=12"
    [bidir]="$scenes/veach-bidir-mitsuba/scene.xml 1024 size=64x64 max_depth=8"
    [cornell]="$scenes/cornell-box-pbrt3/scene.pbrt 512 size=64x64 max_depth=8"
)
mkdir -p "$references"
rows=$(mktemp)
trap 'rm -f "$rows"' EXIT

# pair NAME INTEGRATOR MPP SETTINGS...: a row of the table, and one for each seed in $rows.
pair() {
    local name=$1 integrator=$2 mpp=$3 file spp options
    shift 3
    [[ "$name $integrator" =~ ${ONLY:-.} ]] || return 0
    read -r file spp options <<<"${scene[$name]}"
    bdpt_reference "$coverage" "$file" "$references/r_$name.exr" "$spp" $options
    "$coverage" "$file" "$references/r_$name.exr" "$seeds" $options integrator=$integrator \
        mutations_per_pixel=$mpp "$@" 2>/dev/null |
        awk -F'\t' -v name="$name" -v integrator=$integrator -v mpp=$mpp -v more="$*" -v rows="$rows" '
            {
                false = $2 ~ /^converged/ && ($5 > .1 || $5 > 2 * $3 + 3 * $4)
                print $2 "\t" false "\t" $6 >>rows
                said[$2]++; e += $3; t += $5; c += $6; b += $14
                if ($2 !~ /^converged/ && why == "") why = $11
                if ($15 != "") blind = "blind to " $15
            }
            END {
                printf "%-9s %-7s %5s %-26s %4d %5d %4d %4d %9.2e %9.2e %7.3f %6.3f  %s%s%s\n",
                    name, integrator, mpp, more, said["converged"],
                    said["converged, but blind"], said["not converged"], said["too short"],
                    e / NR, t / NR, c / NR, b / NR, blind, blind != "" && why != "" ? "; " : "", why
            }'
}

printf '%-9s %-7s %5s %-26s %4s %5s %4s %4s %9s %9s %7s %6s  %s\n' scene by mpp settings yes \
    blind no few said true covered bright 'blind to; first doubt'
seen_pairs() {
    pair diffuse pt 128
    pair diffuse bdpt 64
    pair diffuse bdpt 16
    pair diffuse pssmlt 64 large_step_probability=.3
    pair diffuse mmlt 64 large_step_probability=1
    pair diffuse mmlt 64
    pair glass bdpt 64
    pair glass pssmlt 64 large_step_probability=.3
    pair glass mmlt 16 large_step_probability=.3
    pair glass mmlt 128 large_step_probability=.3
    pair glass mmlt 64 large_step_probability=.02
    pair glass mmlt 64 chains=2 max_depth=6
    pair cornell pt 64
    pair cornell mmlt 160
    pair coffee mmlt 160
    pair coffee mmlt 160 chains=2
    pair bidir mmlt 160
    pair bidir pssmlt 64
    pair ajar bdpt 64
    pair ajar mmlt 300
}

blind_pairs() {
    local name
    folder=$(mktemp -d) # for the trap too
    trap 'rm -rf "$rows" "$folder"' EXIT
    blind_scenes "$folder"
    for name in mirror caustic image tank spotglass sunglass lens direct; do
        scene[$name]="$folder/$name.pbrt 2048"
    done
    pair mirror pt 256
    pair mirror pssmlt 256 builder=pt
    pair caustic pt 256
    pair caustic pssmlt 256 builder=pt
    pair spotglass pt 256
    pair sunglass pt 256
    pair image bdpt 256
    pair tank bdpt 1024
    pair tank pssmlt 1024
    pair tank mmlt 1024
    pair lens bdpt 256
    pair direct mmlt 256
}

[ "${PAIRS:-}" = blind ] || seen_pairs
[ "${PAIRS:-}" = seen ] || blind_pairs
awk -F'\t' '{ n++; said += $1 == "converged"; blind += $1 == "converged, but blind"
        silent += $2 && $1 == "converged"; told += $2 && $1 != "converged"
        if ($1 == "converged") c += $3 }
    END {
        printf "%d runs, %d \"converged\", %d of them false; their bars cover %.3f\n", n, said,
            silent, said ? c / said : 0
        printf "%d \"converged, but blind\", %d of them false\n", blind, told
        exit silent > 0
    }' "$rows"
