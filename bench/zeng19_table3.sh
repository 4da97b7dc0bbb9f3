#!/usr/bin/env bash
# make bench-zeng19_table3: the experiments of config/zeng19-table3*.yaml, and from their
# rows the table that [Zeng19] has as Table 3, means over seeds with standard errors:
# failure rate and acceptance rate as the paper defines them, RMSE, and relMSE beside it.
# Left in results/<experiment>/table3.txt. Rows that are there already are not run again.
#
# EXPERIMENTS="zeng19-table3" runs one of them; each takes 20 to 35 minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
experiments=${EXPERIMENTS:-zeng19-table3 zeng19-table3-16x zeng19-table3-time}
need ../shared/scenes/{peer-box,coffee-pbrt3,veach-bidir-mitsuba,living-room-pbrt3} \
    ../shared/scenes/{breakfast-pbrt3,contemporary-bathroom-pbrt3}

table() { # experiment
    printf '%-10s %-22s %-8s %16s %17s %17s %19s %21s\n' Scene Algorithm Budget \
        'Mut. per pixel' 'Failure rate' 'Acceptance rate' RMSE relMSE
    columns "results/$1/runs.csv" scene_label label budget_seconds \
        budget_mutations_per_pixel mutations_per_pixel final_failure_rate \
        acceptance_rate rmse relmse |
        awk -F '\t' '
            function add(quantity, x,    d) { # running mean and sum of squares about it
                if (x !~ /^[-+0-9]/) return
                d = x - mean[key, quantity]
                mean[key, quantity] += d / ++n[key, quantity]
                squares[key, quantity] += d * (x - mean[key, quantity])
            }
            # Mean +- standard error; "?" if no row tells.
            function show(quantity, scale, format,    k, se, text) {
                k = n[key, quantity]
                if (k == 0) return "?"
                text = sprintf(format, mean[key, quantity] * scale)
                se = k > 1 ? sqrt(squares[key, quantity] / (k - 1) / k) * scale : 0
                return se > 0 ? text sprintf(" +- %.2g", se) : text
            }
            {
                budget = $3 > 0 ? $3 " s" : $4 " mpp"
                key = $1 SUBSEP $2 SUBSEP budget
                if (!(key in seen)) { seen[key] = 1; keys[++count] = key }
                for (i = 5; i <= 9; i++) add(i, $i)
            }
            END {
                for (j = 1; j <= count; j++) {
                    key = keys[j]
                    split(key, part, SUBSEP)
                    printf "%s\t%s\t%-10s %-22s %-8s %16s %17s %17s %19s %21s\n", part[1],
                        part[3], part[1], part[2], part[3], show(5, 1, "%.1f"), show(6, 100, "%.2f") " %",
                        show(7, 100, "%.2f") " %", show(8, 1, "%.5f"), show(9, 1, "%.3e")
                }
            }' | sort -s -t $'\t' -k 1,1 -k 2,2g | cut -f 3-
}

for name in $experiments; do
    "$etalon" bench "config/$name.yaml"
    echo
    table "$name" | tee "results/$name/table3.txt"
    echo
done
