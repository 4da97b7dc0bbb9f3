#!/usr/bin/env bash
# make bench-zeng19_figure5: config/zeng19-figure5.yaml, and from its rows what [Zeng19] has
# as Figure 5b: error against mutations per pixel, means over seeds in logarithms with bars
# of one standard error, RMSE as in the paper and relMSE; and the mutations per pixel at
# which mode paper's relMSE comes to exceed mode counted's, interpolated in logarithms. Left
# in results/zeng19-figure5/: figure5.svg, figure5.png, crossings.txt. Rows that are there
# already are not run again.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
name=zeng19-figure5
out=results/$name
need ../shared/scenes/{peer-box,veach-bidir-mitsuba,living-room-pbrt3,breakfast-pbrt3} \
    ../shared/scenes/contemporary-bathroom-pbrt3
"$etalon" bench config/$name.yaml

# curves SCENE COLUMN FILE: blocks for gnuplot, one a label, of lines "mpp mean low high".
curves() {
    columns $out/runs.csv scene_label label mutations_per_pixel budget_mutations_per_pixel \
        "$2" | awk -F '\t' -v scene="$1" '
            $1 == scene && $5 > 0 {
                if (!($2 in seen)) { seen[$2] = 1; labels[++count] = $2 }
                if (!(($2, $4) in n)) points[$2, ++points_of[$2]] = $4
                n[$2, $4]++
                work[$2, $4] += $3
                x = log($5)
                sum[$2, $4] += x
                squares[$2, $4] += x * x
            }
            END {
                for (i = 1; i <= count; i++) {
                    label = labels[i]
                    printf "%s\"%s\"\n", (i > 1 ? "\n\n" : ""), label
                    for (j = 1; j <= points_of[label]; j++) {
                        p = points[label, j]
                        k = n[label, p]
                        m = sum[label, p] / k
                        v = k > 1 ? (squares[label, p] - k * m * m) / (k - 1) / k : 0
                        se = sqrt(v > 0 ? v : 0)
                        print work[label, p] / k, exp(m), exp(m - se), exp(m + se)
                    }
                }
            }' >"$3"
}

# crossings: of the means over seeds, and of each seed's own curves.
crossings() {
    columns $out/runs.csv scene_label mode integrator budget_mutations_per_pixel \
        mutations_per_pixel relmse seed | awk -F '\t' '
        # Of d = log relMSE of paper - that of counted: where it first comes above 0.
        function crossing(scene, seed,    i, p, d, x, last_d, last_x) {
            for (i = 1; i <= points; i++) {
                p = point[i]
                if (!((scene, seed, "paper", p) in n && (scene, seed, "counted", p) in n))
                    continue
                x = log(p)
                d = sum[scene, seed, "paper", p] / n[scene, seed, "paper", p] - \
                    sum[scene, seed, "counted", p] / n[scene, seed, "counted", p]
                if (d > 0)
                    return last_x == "" ? "below " p : \
                        exp(last_x + (x - last_x) * last_d / (last_d - d))
                last_d = d
                last_x = x
            }
            return last_x == "" ? "unknown" : "above " exp(last_x)
        }
        function add(scene, seed, mode, p, x) {
            n[scene, seed, mode, p]++
            sum[scene, seed, mode, p] += x
        }
        $3 == "pfmlt" && $6 > 0 {
            if (!($1 in known)) { known[$1] = 1; scenes[++scene_count] = $1 }
            if (!($4 in at)) { at[$4] = 1; point[++points] = $4 + 0 }
            if (!(($1, $7) in has)) { has[$1, $7] = 1; seeds[$1] = seeds[$1] " " $7 }
            add($1, "all", $2, $4 + 0, log($6))
            add($1, $7, $2, $4 + 0, log($6))
        }
        END {
            for (i = 2; i <= points; i++)
                for (j = i; j > 1 && point[j] < point[j - 1]; j--) {
                    t = point[j]; point[j] = point[j - 1]; point[j - 1] = t
                }
            for (i = 1; i <= scene_count; i++) {
                scene = scenes[i]
                printf "%s: paper exceeds counted from %s mutations per pixel on (by seed:",
                    scene, crossing(scene, "all")
                count = split(seeds[scene], list, " ")
                for (j = 1; j <= count; j++)
                    printf "%s %s", (j > 1 ? "," : ""), crossing(scene, list[j])
                print ")"
            }
            if (scene_count == 0) print "no rows of pfmlt"
        }'
}

scenes=$(columns $out/runs.csv scene_label | sort -u)
for scene in $scenes; do
    curves "$scene" rmse "$out/$scene-rmse.dat"
    curves "$scene" relmse "$out/$scene-relmse.dat"
done
gnuplot <<END
set terminal svg size 1180,$((520 * $(wc -w <<<"$scenes"))) font 'DejaVu Sans,15' \
    background rgb 'white'
set output '$out/figure5.svg'
set logscale xy
set xlabel 'mutations per pixel'
set grid xtics ytics mytics lt 1 lc rgb '#d8d8d8', lt 1 lc rgb '#efefef'
set border 3 lc rgb '#444444'
set tics nomirror
set lmargin 10
set format y '%.0e'
set key bottom left Left reverse
array colours[4] = ['#000000', '#d55e00', '#0072b2', '#009e73']
scenes = '$(echo $scenes)'
set multiplot layout words(scenes),2
do for [scene in scenes] {
    do for [quantity in 'rmse relmse'] {
        file = '$out/'.scene.'-'.quantity.'.dat'
        set title scene noenhanced
        set ylabel quantity eq 'rmse' ? 'RMSE' : 'relMSE'
        stats file using 1 nooutput
        plot for [i = 0:STATS_blocks - 1] file index i using 1:2:3:4 with yerrorlines \
            lw 2 dt i+1 pt 2*i+4 ps 0.7 lc rgb colours[i % 4 + 1] title columnheader(1) noenhanced
    }
}
unset multiplot
END
rsvg-convert --width 1800 --background-color white $out/figure5.svg -o $out/figure5.png
crossings | tee $out/crossings.txt
echo "plot: $out/figure5.svg, $out/figure5.png"
