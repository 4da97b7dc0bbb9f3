#!/usr/bin/env bash
# make bench-zeng19_figure6: config/zeng19-figure6.yaml, and from its rows the comparison of
# [Zeng19]'s Figure 6 with intervals: RMSE and relMSE without the reference's own noise,
# means over seeds with 95 % intervals by Student's t; CPU seconds; relMSE times CPU seconds
# over that of MMLT, which is 1 at equal efficiency and less where an algorithm is better,
# with the interval of the ratio (in logarithms, both seeds' spreads); and what jumps did.
# The mean of the picture over that of the reference tells a bias of it, alike for all.
# Left in results/zeng19-figure6/table.md. Rows that are there already are not run again.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
name=${NAME:-zeng19-figure6} # or zeng19-figure6-short: 50 short runs of small pictures
out=results/$name
need ../shared/scenes/{peer-box,veach-bidir-mitsuba,coffee-pbrt3}
"$etalon" bench "config/$name.yaml"

columns $out/runs.csv scene_label label budget_mutations_per_pixel rmse_corrected \
    relmse_corrected seconds_cpu jumps jump_acceptance mean_ratio | awk -F '\t' "$student_awk"'
    function mean(key) { return sum[key] / n[key] }
    function half(key) { return half_width(n[key], sum[key], squares[key]) }
    function add(key, x) { n[key]++; sum[key] += x; squares[key] += x * x }
    $5 > 0 {
        scene = $1 " at " $3 + 0
        if (!(scene in seen)) { seen[scene] = 1; scenes[++scene_count] = scene }
        if (!((scene, $2) in has)) { has[scene, $2] = 1; labels[scene, ++count[scene]] = $2 }
        k = scene SUBSEP $2
        add(k SUBSEP "rmse", $4)
        add(k SUBSEP "relmse", $5)
        add(k SUBSEP "cpu", $6)
        add(k SUBSEP "log", log($5 * $6))
        add(k SUBSEP "mean", $9)
        if ($7 > 0) add(k SUBSEP "jump", $8)
    }
    END {
        print "| scene, mutations per pixel | algorithm | RMSE | relMSE | CPU s | relMSE x CPU over MMLT | jumps accepted | mean over reference |"
        print "|---|---|---|---|---|---|---|---|"
        for (i = 1; i <= scene_count; i++)
            for (j = 1; j <= count[scenes[i]]; j++) {
                k = scenes[i] SUBSEP labels[scenes[i], j] SUBSEP
                base = scenes[i] SUBSEP "MMLT" SUBSEP "log"
                d = mean(k "log") - mean(base)
                h = sqrt(half(k "log") ^ 2 + half(base) ^ 2)
                printf "| %s | %s | %.4g +- %.2g | %.4g +- %.2g | %.2f | %s | %s | %.4f +- %.2g |\n",
                    scenes[i], labels[scenes[i], j], mean(k "rmse"), half(k "rmse"),
                    mean(k "relmse"), half(k "relmse"), mean(k "cpu"),
                    labels[scenes[i], j] == "MMLT" ? "1" : \
                        sprintf("%.2f (%.2f to %.2f)", exp(d), exp(d - h), exp(d + h)),
                    (k "jump") in n ? sprintf("%.6f", mean(k "jump")) : "",
                    mean(k "mean"), half(k "mean")
            }
    }' | tee $out/table.md
