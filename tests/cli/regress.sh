#!/usr/bin/env bash
# Today's statistics against the baselines that the repository keeps, as a user asks for
# it, and what etalon regress says of tables that were tampered with (of malformed ones:
# tests/malformed/tables.bash). Seeds are fixed, so that the outcome changes only when the
# program does; whether a new program that behaves as the old one passes is a matter of
# chance: it fails with probability LEVEL.
set -u
. "$(dirname "$0")/lib.bash"
LEVEL=1e-3
baselines=$root/config/baselines

regress() { # regress RESULTS NAME ARGS...: status in $status, output in out and err
    local results=$1 name=$2
    shift 2
    "$etalon" regress "$results" --baseline "$name" "$@" >out 2>err
    status=$?
}
table() { # table FILE COLUMN STATISTIC: of the first row of that statistic
    awk -F, -v column="$2" -v statistic="$3" 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i }
        $at["statistic"] == statistic { print $at[column]; exit }' "$1"
}

# --- the program as it is ----------------------------------------------------------------
names=regress-quick
[ -z "${ETALON_LONG:-}" ] || names+=" regress-long"
for name in $names; do
    "$etalon" bench "$root/config/$name.yaml" --force -o $name >bench.out 2>bench.err
    check "$name runs" [ $? -eq 0 ]
    regress $name "$baselines/$name.csv" --level $LEVEL
    [ $status -eq 0 ] || cat out
    cat err
    check "$name: nothing moved" [ $status -eq 0 ]
    check "$name: every cell is in the baseline" [ ! -s err ]
done
check "says how large a change is seen" grep -qE '^  b  .*[0-9] %' out
check "says how sure it is" grep -qE \
    '^0 figures moved, 0 differ, 0 are gone; [0-9]+ tests, .* with probability 0.001$' out

# --- a baseline of its own ---------------------------------------------------------------
baseline=$baselines/regress-quick.csv
regress regress-quick own.csv --update
check "--update" [ $status -eq 0 ]
check "says what it wrote" grep -qE '^own.csv: [0-9]+ statistics of 24 cells$' out
check "no half file" [ -z "$(find . -name 'own.csv.part*')" ]
regress regress-quick own.csv -o table.csv --all
check "nothing moved against itself" [ $status -eq 0 ]
check "but that these are the same seeds is said" grep -q 'seeds of .* overlap' err
check "no change at all" [ "$(table table.csv change b)" = 0 ]

# --- what moved --------------------------------------------------------------------------
# Five standard errors of the change are seen at 5 %, half of one is none.
regress regress-quick "$baseline" -o table.csv
step=$(table table.csv change_se b)
for sigmas in 7 .5; do
    awk -F, -v OFS=, -v d="$step" -v n=$sigmas -v c="$(table table.csv change b)" '
        $10 == "b" && !done { $13 += c - n * d; done = 1 } 1' "$baseline" >moved.csv
    regress regress-quick moved.csv
    check "b moved by $sigmas sigmas" [ "$status/$sigmas" = 1/7 -o "$status/$sigmas" = 0/.5 ]
done
awk -F, -v OFS=, -v d="$step" -v c="$(table table.csv change b)" '
    $10 == "b" && !done { $13 += c - 7 * d; done = 1 } 1' "$baseline" >moved.csv
regress regress-quick moved.csv
check "it is told by how much" grep -qE '^moved +cornell bdpt mpp=64 +b .* \+7.00 ' out
sed 's/cornell,pssmlt/gone,pssmlt/' "$baseline" >gone.csv
regress regress-quick gone.csv
check "a cell that is gone: status 1" [ $status -eq 1 ]
check "is named" grep -qE '^gone +gone pssmlt mpp=64 +not in the results' out
check "a new one is a note" grep -q "^warning: new: 'cornell pssmlt mpp=64' is not in" err
sed 's/chains\(.*\),32,0,/chains\1,64,0,/; s/,kernel\(.*\),gaussian,/,kernel\1,exponential,/' \
    "$baseline" >other.csv
regress regress-quick other.csv
check "another setting: status 1" [ $status -eq 1 ]
check "is named" grep -qE "^differs +cornell pfmlt exact mpp=64 +kernel +'exponential', now \
'gaussian'" out
check "what does not vary" grep -qE '^moved +cornell pssmlt mpp=64 +chains +64 .* exact ' out
sed 's/^\(cornell,mmlt,mpp=64\),[0-9a-f]*/\1,0123456789abcdef/' "$baseline" >other.csv
regress regress-quick other.csv
check "other contents: status 1" [ $status -eq 1 ]
check "are named" grep -qE "^differs +cornell mmlt mpp=64 +cell +'0123456789abcdef', now" out
check "and not compared" [ "$(grep -c '^[a-z]* *cornell mmlt' out)" = 1 ]

finish
