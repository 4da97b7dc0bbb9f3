#!/usr/bin/env bash
# make bench-p_curve: what a rule for p_l costs on sixteen scenes, without rendering a picture
# by it. WHAT="measure rule table" (default: rule table) chooses:
#   measure  the error at seven constants (bench/p_curve.c), by RUNS=2 seeds from
#            RUNS_FROM=101 on, into results/zsolnai13-table1/curves.csv: the same for any
#            rule. Cells that have the first seed already are not measured again. 10 CPU
#            minutes for an integrator. By mmlt, chains that are stuck scatter single runs:
#            RUNS=8.
#   steps    the error for small steps of 1/128 to 1/8, into results/p_curve/steps.csv
#   steps_table  from that the best widths (bench/steps.awk)
#   rule     the starts alone, by SEEDS=4 seeds from FIRST=1001 on: results/p_curve/rule.csv,
#            two CPU minutes for an integrator.
#   table    from both: regrets of the rules and of constants (bench/p_curve.awk).
# TIMES=3 measures with three times as many mutations, by one seed. INTEGRATORS="pssmlt mmlt"
# and SCENES="..." choose cells, SCENES=large those of large pictures; SET="key=value ..." adds
# settings.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C

program=${BENCH:-build/release/bench}/p_curve
shared=${SHARED:-../shared}/scenes
curves=${CURVES:-results/zsolnai13-table1/curves.csv}
out=${OUT:-results/p_curve}
# Scene: file, size, other settings; mutations a pixel by pssmlt, mmlt and pfmlt.
declare -A scene=(
    [interior]="scenes/interior/scene.yaml 64x40 - 57 330 230"
    [chess]="scenes/chess/scene.yaml 64x40 - 260 640 450"
    [splash]="scenes/splash/scene.yaml 64x40 - 200 520 360"
    [light-tube]="scenes/light-tube/scene.yaml 64x40 - 89 530 360"
    [glass-ball]="scenes/glass-ball/scene.yaml 64x40 - 370 800 560"
    [pool]="scenes/pool/scene.yaml 64x40 - 45 270 180"
    [twin-lamps]="scenes/twin-lamps/scene.yaml 64x40 - 480 900 640"
    [shells]="scenes/shells/scene.yaml 64x40 - 110 660 450"
    [door]="scenes/door/scene.yaml 72x48 - 50 150 100"
    [glass-caustic]="scenes/glass-caustic/scene.yaml 72x48 - 200 1200 810"
    [coffee]="$shared/coffee-pbrt3/scene.pbrt 48x60 max_depth=12 180 430 300"
    [veach-bidir]="$shared/veach-bidir-mitsuba/scene.xml 56x56 max_depth=12 53 310 210"
    [veach-ajar]="$shared/veach-ajar-mitsuba/scene.xml 72x40 max_depth=12 48 280 190"
    [living-room]="$shared/living-room-pbrt3/scene.pbrt 72x40 max_depth=12 49 290 200"
    [staircase]="$shared/staircase-pbrt4/staircase.pbrt 42x60 max_depth=12 30 220 150"
    [torus]="$shared/torus-dpt/h2mc.xml 64x48 - 100 400 300"
    [cornell-640x360]="scenes/cornell/scene.yaml 640x360 - 4 20 14"
    [interior-640x400]="scenes/interior/scene.yaml 640x400 - 1 8 6"
    [twin-lamps-640x400]="scenes/twin-lamps/scene.yaml 640x400 - 4 9 7"
    [pool-640x400]="scenes/pool/scene.yaml 640x400 - 1 8 6"
    [glass-caustic-320x200]="scenes/glass-caustic/scene.yaml 320x200 - 20 40 30"
    [interior-160x100]="scenes/interior/scene.yaml 160x100 - 20 80 60"
    [glass-caustic-160x100]="scenes/glass-caustic/scene.yaml 160x100 - 60 150 100"
    [coffee-120x150]="$shared/coffee-pbrt3/scene.pbrt 120x150 max_depth=12 20 80 50"
    [twin-lamps-160x100]="scenes/twin-lamps/scene.yaml 160x100 - 60 150 100"
    [pool-960x600]="scenes/pool/scene.yaml 960x600 - 1 8 6"
    [coffee-480x600]="$shared/coffee-pbrt3/scene.pbrt 480x600 max_depth=12 2 8 6"
)
large="cornell-640x360 interior-640x400 twin-lamps-640x400 pool-640x400 glass-caustic-320x200
    coffee-480x600"
names=${SCENES:-interior chess splash light-tube glass-ball pool twin-lamps shells door
    glass-caustic coffee veach-bidir veach-ajar living-room staircase torus}
[ "$names" = large ] && names=$large

# each COMMAND SEED SEEDS FILE: rows of all cells that FILE has not got yet.
each() {
    local name integrator file size options mpp
    for integrator in ${INTEGRATORS:-pssmlt mmlt}; do
        for name in $names; do
            read -r file size options mpp <<<"${scene[$name]}"
            [ -e "$file" ] || { echo "$file is not there: skipped" >&2 && continue; }
            case $integrator in
            pssmlt) mpp=${mpp%% *} ;;
            mmlt) mpp=${mpp#* } mpp=${mpp% *} ;;
            pfmlt) mpp=${mpp##* } ;;
            esac
            mpp=$((mpp * ${TIMES:-1}))
            grep -q "^$name,$integrator,$mpp,$2," "$4" && continue
            # shellcheck disable=SC2086 # options are words
            "$program" "$1" "$file" "$name" "$2" "$3" "size=$size" \
                "integrator=$integrator" "mutations_per_pixel=$mpp" threads=1 \
                ${options#-} ${SET:-} >"$4.part"
            cat "$4.part" >>"$4"
            rm "$4.part"
            echo "$(date +%T) $name $integrator" >&2
        done
    done
}

mkdir -p "$out" "$(dirname "$curves")"
for what in ${WHAT:-rule table}; do
    case $what in
    measure)
        touch "$curves"
        each measure "${RUNS_FROM:-101}" "${RUNS:-$((${TIMES:-1} > 1 ? 1 : 2))}" "$curves"
        ;;
    steps) touch "$out/steps.csv" && each steps 101 "${RUNS:-2}" "$out/steps.csv" ;;
    steps_table)
        for name in "${!scene[@]}"; do
            read -r _ size _ <<<"${scene[$name]}"
            echo "$name $size"
        done >"$out/sizes"
        awk -f bench/steps.awk "$out/sizes" "${STEPS:-$out/steps.csv}" | tee "$out/steps.md"
        ;;
    rule)
        rm -f "$out/rule.csv" && touch "$out/rule.csv"
        each rule "${FIRST:-1001}" "${SEEDS:-4}" "$out/rule.csv"
        ;;
    table)
        awk -f bench/student.awk -f bench/p_curve.awk "$curves" "$out/rule.csv" | tee "$out/table.md"
        ;;
    esac
done
