#!/usr/bin/env bash
# `etalon render -i all` as a user runs it: a run by each integrator, the page, which one
# and why worked out again from the table, a reference, going on, what is refused.
set -u
. "$(dirname "$0")/lib.bash"
. "$root/tests/cli/bench.bash" || exit 1
write_scene >scene.yaml

all() { # all ARGS...: what it says in out and err
    "$etalon" render scene.yaml -i all --threads 1 --set bootstrap=500 "$@" >out 2>err
}
plain() { # plain DIR: its table without the quoted texts, some of which have commas
    sed 's/"[^"]*"/text/g' "$1/runs.csv" >"$1/plain.csv"
}
methods="pssmlt mmlt pfmlt rjmlt smlt mlt bdpt pt "

# --- a batch and its page ----------------------------------------------------------------
check "all integrators" all --mpp 16 --seed 7 -o r
plain r
check "a run by each" [ "$(column integrator r/plain.csv | tr '\n' ' ')" = "$methods" ]
check "of the seed" [ "$(column seed r/plain.csv | sort -u)" = 7 ]
check "and the settings" [ "$(column budget_mutations_per_pixel r/plain.csv | sort -u)" = 16 ]
check "a page" [ -s r/report.html ]
check "which says where it is" grep -qE '^r/report.html \([0-9.]+ MB\)$' out

# The best by the table: lowest relmse_estimated; the next is by another integrator.
paste -d ' ' <(column relmse_estimated r/plain.csv) <(column label r/plain.csv) \
    <(column paths r/plain.csv) <(column seconds_cpu r/plain.csv) \
    <(column mutations_per_pixel r/plain.csv) | sort -s -g -k 1,1 >order
read -r _ best _ <order
check "who is best" grep -qE "^by relMSE by each run's own error bars: $best is (best|lowest)" out
why=$(awk 'NR == 1 { e = $1 * $5; v = $3 / $4 } NR == 2 {
    printf "why: .* makes %.3g times as many paths per CPU second as %s, and has %.3g", \
        v / ($3 / $4), $2, e / ($1 * $5) }' order)
check "and why" grep -qE "^${why//+/\\+} times its error per path" out
check "on the page too" grep -qF "<p>Why: $best makes" r/report.html
check "a row a method of what errors consist of" [ "$(sed -n \
    '/id="why-0"/,/<\/table>/p' r/report.html | grep -c '<tr><td class="method">')" = 8 ]
cp r/runs.csv before
check "again" all --mpp 16 --seed 7 -o r
check "nothing is run twice" cmp -s r/runs.csv before
check "bench goes on with the folder" "$etalon" bench r/experiment.yaml -o r
check "where nothing is left to do" cmp -s r/runs.csv before

# --- with a reference --------------------------------------------------------------------
"$etalon" render scene.yaml -i bdpt --mpp 64 --seed 9 -o reference.exr >/dev/null 2>&1
check "a reference" all --mpp 8 --reference reference.exr -o q
check "errors against it" grep -qE '^by relMSE without the worst 1 % of pixels: ' out
plain q
check "in the table" [ "$(column relmse q/plain.csv | grep -cE '^[0-9.e-]+$')" = 8 ]

# --- what is refused, before any work ----------------------------------------------------
refuse() { # refuse WHAT TEXT ARGS...
    local what=$1 text=$2
    shift 2
    all "$@"
    check "$what" [ $? -ne 0 -a "$(wc -l <err)" = 1 -a ! -s out ]
    check "  in words" grep -qF -- "$text" err
}
refuse "another budget in the folder" "'r' holds results of another scene" --mpp 17 -o r
refuse "a picture for a folder" '-i all needs -o DIR' -o x.exr
refuse "no folder" '-i all needs -o DIR'
refuse "a part" '--part does not go with -i all' --part 1/2 -o x
refuse "a live page" '--live does not go with -i all' --live 0 -o x
refuse "an early end" '--until-converged does not go with -i all' --until-converged -o x
refuse "a value" "seconds: '-1' is not possible" --seconds -1 -o x
refuse "a key" "unknown setting 'nothing'" --set nothing=1 -o x
refuse "a reference that is not there" "none.exr" --reference none.exr -o x
refuse "a reference of the same seed" 'has seed 9' --seed 9 --reference reference.exr -o x
refuse "settings that do not go together" 'needs a kernel whose density is known' \
    --set kernel=exponential -o x
check "none leaves a folder" [ ! -e x ]
finish
