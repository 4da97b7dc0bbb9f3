#!/usr/bin/env bash
# make bench-until: how often a run that ends before its budget (until_converged,
# until_relmse) ends wrongly, against references by bdpt. SEEDS=20 runs of each row.
# `ended`: before the budget; `false`: of them, runs whose relMSE (of the luminance, less
# the reference's noise) is above the X that was asked for, or, until_converged, above 0.1
# or above twice what was said and three of its standard errors; `length`: mutations per
# pixel, on average; `said`, `true`: relMSE. Chance of a false end by one look: see
# src/convergence/until.h; the last line has the 95 % bound of the rate.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

coverage=${BENCH:-build/release/bench}/coverage
references=${REFERENCES:-results/until}
seeds=${SEEDS:-20}
threads=threads=${THREADS:-0}
declare -A scene=(
    [cornell]="scenes/cornell/scene.yaml 2048 size=32x32 max_depth=6"
    [caustic]="scenes/glass-caustic/scene.yaml 4096 size=36x24 max_depth=8"
    [door]="scenes/door/scene.yaml 4096 size=36x24 max_depth=6"
)
mkdir -p "$references"
rows=$(mktemp)
trap 'rm -f "$rows"' EXIT

# row NAME INTEGRATOR SETTING=X: a row of the table, and one for each seed in $rows.
row() {
    local file spp options
    [[ "$*" =~ ${ONLY:-.} ]] || return 0
    read -r file spp options <<<"${scene[$1]}"
    bdpt_reference "$coverage" "$file" "$references/r_$1.exr" "$spp" $options $threads
    "$coverage" "$file" "$references/r_$1.exr" "$seeds" $options $threads integrator=$2 \
        mutations_per_pixel=1024 bootstrap=20000 "$3" |
        awk -F'\t' -v name="$1" -v integrator="$2" -v setting="$3" -v rows="$rows" '
            {
                x = setting ~ /relmse/ ? substr(setting, index(setting, "=") + 1) + 0 : 0
                end = $13 == "until"
                false = end && (x > 0 ? $5 > x : $5 > .1 || $5 > 2 * $3 + 3 * $4)
                print (x > 0) "\t" end "\t" false >>rows
                ended += end; wrong += false; mpp += $12; said += $3; true += $5
            }
            END {
                printf "%-9s %-7s %-22s %5d %5d %7.0f %9.2e %9.2e\n", name, integrator,
                    setting, ended, wrong, mpp / NR, said / NR, true / NR
            }'
}

printf '%-9s %-7s %-22s %5s %5s %7s %9s %9s\n' scene by setting ended false length said true
for name in cornell caustic door; do
    for integrator in pt pssmlt mmlt; do
        row $name $integrator until_converged=true
        row $name $integrator until_relmse=0.02
    done
done
# The one-sided bound b solves P(X <= wrong; n, b) = .05, by bisection.
awk -F'\t' '
    function tail(n, k, b,    i, p, sum) {
        p = exp(n * log(1 - b))
        for (i = 0; i <= k; i++) {
            sum += p
            p *= (n - i) / (i + 1) * b / (1 - b)
        }
        return sum
    }
    { n[$1] += $2; k[$1] += $3 }
    END {
        for (kind = 0; kind < 2; kind++) {
            low = 0; high = 1 - 1e-12
            for (i = 0; i < 60; i++) {
                middle = (low + high) / 2
                if (tail(n[kind], k[kind], middle) > .05) low = middle; else high = middle
            }
            printf "%s: %d ended before their budget, %d of them falsely: below %.3f at 95 %%\n",
                kind ? "until_relmse" : "until_converged", n[kind], k[kind], high
        }
    }' "$rows"
