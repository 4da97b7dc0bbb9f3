#!/usr/bin/env bash
# make bench: config/auto-vs-manual-short.yaml, as many jobs at once as there are processors,
# and from its rows the mean relMSE of each p_l without the reference's noise, beside that of
# the automatic one; then the page of it, results/<experiment>/report.html. EXPERIMENT=NAME
# takes another experiment of config/. Rows that are there already are not run again.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
name=${EXPERIMENT:-auto-vs-manual-short}
out=results/$name
"$etalon" bench "config/$name.yaml" --jobs "$(nproc)"

echo
columns "$out/runs.csv" scene_label integrator p_l_source p_l relmse_corrected | awk -F '\t' '
    {
        row = $1 SUBSEP $2
        column = $3 == "auto" ? "auto" : $4
        if (!(row in known)) { known[row] = 1; rows[++row_count] = row }
        if (!(column in at)) { at[column] = 1; columns[++column_count] = column }
        n[row, column]++
        sum[row, column] += $5
        if ($3 == "auto") p_l[row] += $4
    }
    END {
        for (i = 2; i <= column_count; i++) # auto first, then by value
            for (j = i; j > 1 && columns[j] != "auto" && columns[j - 1] != "auto" &&
                columns[j] + 0 < columns[j - 1] + 0; j--) {
                t = columns[j]; columns[j] = columns[j - 1]; columns[j - 1] = t
            }
        printf "%-32s", "mean relMSE; p_l of auto"
        for (j = 1; j <= column_count; j++) printf " %10s", columns[j]
        print ""
        for (i = 1; i <= row_count; i++) {
            split(rows[i], part, SUBSEP)
            k = n[rows[i], "auto"]
            printf "%-32s", sprintf("%s %s %.2f", part[1], part[2], k ? p_l[rows[i]] / k : 0)
            for (j = 1; j <= column_count; j++) {
                k = n[rows[i], columns[j]]
                printf " %10s", k ? sprintf("%.4g", sum[rows[i], columns[j]] / k) : "-"
            }
            print ""
        }
    }'
echo
if "$etalon" report --help >/dev/null 2>&1; then
    "$etalon" report "$out"
    echo "page: $out/report.html"
else
    echo "rows: $out/runs.csv, pictures: $out/images/"
fi
