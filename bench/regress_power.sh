#!/usr/bin/env bash
# make bench-regress_power: what etalon regress is good for.
#
# Size: BLOCKS=200 tables of SEEDS=3 seeds each against a baseline of 128 other seeds, of
# one and the same program (config/regress-quick.yaml with 16 mutations per pixel): how many
# alarm, beside how many should. All blocks share the baseline.
#
# Power: changes planted into a copy of the sources, or into a column, run against
# config/baselines/regress-quick.csv at the level of `make test`: how many seeds it takes
# until the first alarm, 2 to 8; the median of 5 repeats with other seeds.
#
# PART=size or power for one of them.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
export LC_ALL=C
trap 'exit 130' INT

etalon=$(realpath "${ETALON:-build/release/etalon}")
config=config/regress-quick.yaml
level=1e-3
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# rows RUNS FIRST COUNT OUT: a folder with these rows only, counted from 1.
rows() {
    mkdir -p "$4"
    awk -v first="$2" -v last=$(($2 + $3 - 1)) 'NR == 1 || (NR > first && NR <= last + 1)' \
        "$1" >"$4/runs.csv"
}

cells() { # cells RUNS: rows of a seed; seeds are outermost
    local first
    first=$(columns "$1" seed | head -n 1)
    columns "$1" seed | grep -cx "$first"
}

# Clopper and Pearson's interval of a share, 95 %.
interval() { # interval HITS TRIALS
    awk -v k="$1" -v n="$2" '
        function below(k, p,    i, term, sum) { # P(X <= k)
            if (k < 0) return 0
            if (p <= 0) return 1
            if (p >= 1) return k >= n
            term = exp(n * log(1 - p))
            for (i = 0; i <= k; i++) {
                sum += term
                term *= (n - i) / (i + 1) * p / (1 - p)
            }
            return sum
        }
        function solve(k, tail,    lo, hi, mid, i) { # p with P(X <= k) = tail
            lo = 0
            hi = 1
            for (i = 0; i < 60; i++) {
                mid = (lo + hi) / 2
                if (below(k, mid) > tail) lo = mid; else hi = mid
            }
            return lo
        }
        BEGIN {
            printf "%.4f to %.4f", k ? solve(k - 1, .975) : 0, k < n ? solve(k, .025) : 1
        }'
}

size() {
    local blocks=${BLOCKS:-200} seeds=${SEEDS:-3} count block l
    local short='s/^budget:.*/budget: {mutations_per_pixel: 16}/'
    reseed $config 100001 128 | sed "$short" >"$work/base.yaml"
    reseed $config 1 $((blocks * seeds)) | sed "$short" >"$work/now.yaml"
    "$etalon" bench "$work/base.yaml" --force -o "$work/base" >/dev/null
    "$etalon" bench "$work/now.yaml" --force -o "$work/now" >/dev/null
    "$etalon" regress "$work/base" --baseline "$work/base.csv" --update >/dev/null
    count=$(($(cells "$work/now/runs.csv") * seeds))
    printf '%-10s %8s %8s %10s   %s\n' level blocks alarms expected 'rate, 95 % interval'
    for l in .2 .05 .01 .001; do
        local alarms=0
        for ((block = 0; block < blocks; block++)); do
            rows "$work/now/runs.csv" $((block * count + 1)) $count "$work/block"
            "$etalon" regress "$work/block" --baseline "$work/base.csv" --level $l \
                >"$work/out" 2>&1 || {
                grep -q '^[0-9]* figures moved' "$work/out"
                alarms=$((alarms + 1))
                grep '^moved' "$work/out" | sed "s/^/$l /" >>"$work/alarms"
            }
        done
        printf '%-10s %8d %8d %10.1f   %s\n' $l $blocks $alarms \
            "$(awk "BEGIN { print $l * $blocks }")" "$(interval $alarms $blocks)"
    done
    tail -n 1 "$work/out"
    [ ! -s "$work/alarms" ] || { echo "alarms at .01:" && grep '^\.01 ' "$work/alarms" || true; }
}

# plant FILE OLD NEW: in the copy; OLD must be there once.
plant() {
    local file=$tree/$1 text
    [ "$(grep -cF -- "$2" "$file")" = 1 ] || {
        echo "$0: '$2' is not in $1, or more than once: the plant no longer fits" >&2
        exit 1
    }
    planted+=("$1")
    text=$(<"$file")
    printf '%s\n' "${text/"$2"/"$3"}" >"$file"
}

# grow NAME RUNS: seeds that it takes until an alarm, and what alarmed first.
grow() {
    local name=$1 runs=$2 repeat n found=() what='' count
    count=$(cells "$runs")
    for repeat in 0 1 2 3 4; do
        for ((n = 2; n <= 8; n++)); do
            rows "$runs" $((repeat * 8 * count + 1)) $((n * count)) "$work/block"
            "$etalon" regress "$work/block" --baseline config/baselines/regress-quick.csv \
                --level $level >"$work/out" 2>&1 && continue
            grep -q '^[1-9][0-9]* figures moved, 0 differ, 0 are gone' "$work/out" || {
                cat "$work/out" >&2
                exit 1
            }
            [ -n "$what" ] ||
                what=$(sed -n 's/^moved  *//p' "$work/out" | head -n 1 | cut -c 1-60 | tr -s ' ')
            break
        done
        found+=($n)
    done
    found=($(printf '%s\n' "${found[@]}" | sort -n | sed 's/^9$/>8/'))
    printf '%-34s %6s %6s   %-18s %s\n' "$name" "${found[2]}" \
        "$([ "${found[2]}" = '>8' ] && echo - || echo $((found[2] * count)))" \
        "${found[*]}" "$what"
}

# scale COLUMN FACTOR: of the unchanged program's runs. No cell with a comma stands before.
scale() {
    mkdir -p "$work/scaled"
    awk -F, -v OFS=, -v name="$1" -v factor="$2" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; if (!at) exit 1 }
        NR > 1 && $at != ".nan" { $at = sprintf("%.15g", $at * factor) } 1' \
        "$work/as-it-is/runs.csv" >"$work/scaled/runs.csv"
    grow "$1 x $2" "$work/scaled/runs.csv"
}

runs_of() { # runs_of PROGRAM NAME
    "$1" bench "$work/pool.yaml" --force -o "$work/$2" >/dev/null
}

# changed NAME, after plants: builds the copy, runs it, and puts the sources back, as of
# now, so that make sees it.
changed() {
    local file
    CI='' make -s -C "$tree" -j"$(nproc)" all >"$work/build.log" 2>&1 || {
        cat "$work/build.log" >&2
        exit 1
    }
    rm -rf "$work/changed"
    runs_of "$tree/build/release/etalon" changed
    grow "$1" "$work/changed/runs.csv"
    for file in "${planted[@]}"; do
        cp "$file" "$tree/$file"
    done
    planted=()
}

power() {
    local tree=$work/tree planted=()
    mkdir -p "$tree/build/release"
    cp -a Makefile src .ci "$tree"
    cp -a build/release/{obj,gen,libetalon.a} "$tree/build/release"
    reseed $config 200001 40 >"$work/pool.yaml"
    runs_of "$etalon" as-it-is
    printf '%-34s %6s %6s   %-18s %s\n' 'planted' seeds runs 'of 5 repeats' 'first seen in'
    grow 'nothing' "$work/as-it-is/runs.csv"
    scale eta_s 1.02
    scale eta_s .98
    scale b 1.01
    scale b .99
    local weight='out->weight = mis_weight(mis_side(&y, q_light, 0.0, 1.0), camera_side);'
    plant src/path/connect.h "$weight" "${weight/mis_weight/1.1 * mis_weight}"
    changed 'weight of (1,k) x 1.1'
    plant src/path/mis.h 'static inline double mis_weight(' \
        'static inline double mis_squares(double a, double b)
{ return 1.0 / (1.0 + a * a + b * b); }
static inline double mis_weight('
    plant src/path/connect.h "$weight" "${weight/mis_weight/mis_squares}"
    changed 'weight of (1,k) by squares'
    plant src/integrator/markov/markov.c 'settings_sigma(s, pixels), s->s1' \
        '1.2 * settings_sigma(s, pixels), s->s1'
    changed 'sigma x 1.2, not told'
    plant src/integrator/markov/markov.c 'settings_s2(s, pixels));' \
        '1.28 * settings_s2(s, pixels));'
    changed 's2 x 1.28, not told'
    changed 'nothing, built anew'
}

[ "${PART:-size}" != size ] || size
[ "${PART:-power}" != power ] || power
