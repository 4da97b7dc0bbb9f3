#!/usr/bin/env bash
# make bench-startup_length: config/startup-length.yaml, as many jobs at once as there are
# processors, and from its rows how p_l by zsolnai2013 settles with the length of the start,
# in mutations a chain: mean over seeds, standard deviation between seeds, mean width of the
# interval, in how many of the runs that interval holds the p_l that the longest start finds
# (mean over its seeds), and how many were unsure of the branch. Left in
# results/startup-length/: table.txt, p_l.svg, p_l.png. Rows that are there already are not run
# again.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
config=${CONFIG:-config/startup-length.yaml}
out=${OUT:-results/startup-length}
"$etalon" bench "$config" -o "$out" --jobs "$(nproc)"

# rows: scene, integrator, length asked for, mutations a chain that it came to, p_l, its
# interval, unsure. The length is in the label.
rows() {
    columns "$out/runs.csv" scene_label integrator label start_mutations chains p_l p_l_lo \
        p_l_hi p_l_unsure | awk -F '\t' -v OFS='\t' '{
            length_of = $3
            sub(/.*start_mutations=/, "", length_of)
            print $1, $2, length_of + 0, $4 / $5, $6, $7, $8, $9 == "true"
        }' | sort -t $'\t' -k 1,1 -k 2,2r -k 3,3n
}

# summary: scene, integrator, length, mean length, n, mean p_l, sd, width, held, unsure.
summary() {
    rows | awk -F '\t' -v OFS='\t' '
        {
            key = $1 SUBSEP $2
            point = key SUBSEP $3
            if (!(point in n)) points[++count] = point
            longest[key] = $3
            i = ++n[point]
            length_sum[point] += $4
            sum[point] += $5
            squares[point] += $5 * $5
            width[point] += $7 - $6
            lo[point, i] = $6
            hi[point, i] = $7
            unsure[point] += $8
        }
        END {
            for (j = 1; j <= count; j++) {
                point = points[j]
                split(point, part, SUBSEP)
                key = part[1] SUBSEP part[2]
                k = n[point]
                last = key SUBSEP longest[key]
                truth = sum[last] / n[last]
                held = 0
                for (i = 1; i <= k; i++)
                    held += lo[point, i] <= truth && truth <= hi[point, i]
                mean = sum[point] / k
                v = k > 1 ? (squares[point] - k * mean * mean) / (k - 1) : 0
                print part[1], part[2], part[3], length_sum[point] / k, k, mean,
                    sqrt(v > 0 ? v : 0), width[point] / k, held, unsure[point]
            }
        }'
}

summary >"$out/summary.tsv"
{
    printf '%-16s %-8s %7s %9s %5s %8s %8s %8s %7s %7s\n' scene method start came_to runs p_l sd \
        width holds unsure
    awk -F '\t' '{ printf "%-16s %-8s %7d %9.1f %5d %8.4f %8.4f %8.4f %4d/%-2d %4d/%-2d\n", $1, $2,
        $3, $4, $5, $6, $7, $8, $9, $5, $10, $5 }' "$out/summary.tsv"
} | tee "$out/table.txt"

scenes=$(cut -f 1 "$out/summary.tsv" | uniq)
for scene in $scenes; do
    for method in pssmlt mmlt; do
        awk -F '\t' -v s="$scene" -v m="$method" '$1 == s && $2 == m {
            print $4, $6, $7, $6 - $8 / 2, $6 + $8 / 2 }' "$out/summary.tsv" \
            >"$out/$scene-$method.dat"
    done
done
gnuplot <<END
set terminal svg size 1180,$((340 * $(wc -w <<<"$scenes"))) font 'DejaVu Sans,15' \
    background rgb 'white'
set output '$out/p_l.svg'
set logscale x
set yrange [0:1.05]
set grid xtics ytics lt 1 lc rgb '#e4e4e4'
set border 3 lc rgb '#444444'
set tics nomirror
set xlabel 'mutations a chain before p_{l} is set'
set ylabel 'p_l, mean over seeds'
set key bottom right
scenes = '$(echo $scenes)'
set multiplot layout words(scenes),2
do for [scene in scenes] {
    do for [method in 'pssmlt mmlt'] {
        file = '$out/'.scene.'-'.method.'.dat'
        set title scene.', '.method noenhanced
        plot file using 1:4:5 with filledcurves fs transparent solid 0.2 lc rgb '#0072b2' \
                title 'mean interval', \
            file using 1:2:3 with yerrorlines lw 2 pt 7 ps 0.5 lc rgb '#d55e00' \
                title 'p_l, sd between seeds'
    }
}
unset multiplot
END
rsvg-convert --width 1800 --background-color white "$out/p_l.svg" -o "$out/p_l.png"
echo "plot: $out/p_l.svg, $out/p_l.png; table: $out/table.txt"
