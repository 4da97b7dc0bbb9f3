#!/usr/bin/env bash
# Jobs side by side: workers of one batch, single jobs in processes of their own that are
# joined later, what a crash, an interrupt, a kill, a full or read-only disk leaves. With a
# budget in mutations the outcome is always that of an undisturbed batch. ETALON_LONG=1
# kills more often.
set -u
. "$(dirname "$0")/lib.bash"
. "$root/tests/cli/bench.bash" || exit 1
write_scene >scene.yaml
long=${ETALON_LONG:-}
mpp=${long:+48}
mpp=${mpp:-16}

nine() { # nine SEEDS: three jobs a seed
    experiment 'scenes: [scene.yaml]' \
        'integrators: [pt, {integrator: pssmlt, kernel: [exponential, gaussian]}]' \
        "budget: {mutations_per_pixel: $mpp}" "seeds: $1" \
        'reference: {integrator: bdpt, mutations_per_pixel: 16}' >e.yaml
}
same() { # same WHAT DIR: as the undisturbed batch
    outcome "$2" >"$2.outcome"
    check "$1: as an undisturbed batch" cmp "$base.outcome" "$2.outcome"
    check "$1: no part is left" [ ! -e "$2/parts" ]
    check "$1: nothing half-written" [ -z "$(find "$2" results -name '*.part*')" ]
}
calm() { # calm NAME: the undisturbed batch
    bench "$1" || failures=$((failures + 1))
    base=$PWD/$1/images
    outcome "$1" >"$1.outcome"
    cp "$1.outcome" "$base.outcome"
}

# --- workers -----------------------------------------------------------------------------
nine 2
calm calm
rm -r results
check "two workers" bench pair --jobs 2
check "two workers: nothing on stderr" [ ! -s pair.err ]
check "two workers: the reference is made once" [ "$(grep -c '^reference, half' pair.out)" = 2 ]
check "two workers: a line a job" [ "$(grep -cE '^\[[1-6]/6\] scene' pair.out)" = 6 ]
same "two workers" pair
if [ -n "$long" ]; then
    check "more workers than jobs" bench crowd --jobs 9
    same "more workers than jobs" crowd
fi

# --- single jobs -------------------------------------------------------------------------
for job in 6 2 5 1 4 3 2; do # job 2 twice: one of them waits for the other
    "$etalon" bench e.yaml -o array --job $job >array.out$job 2>>array.err &
done
wait
check "jobs of an array: nothing on stderr" [ ! -s array.err ]
check "jobs of an array: no table yet" [ ! -e array/runs.csv ]
bench array --list
check "jobs of an array: the list" grep -q '^6 jobs, 0 done, 6 finished in parts; to do: 0.0 s' \
    array.out
check "jobs of an array: joined" bench array --collect
check "jobs of an array: a line a job" [ "$(grep -c 'from its part$' array.out)" = 6 ]
same "jobs of an array" array
bench array --job 3
check "a job that has its row is not run" grep -q '^1 of 1 jobs done, 0 of them now' array.out
bench some --job 5 && bench some --job 2
check "some of the jobs: joined" bench some --collect
check "some of the jobs: the others are named" grep -qx \
    'not done, by their numbers: 1 3 4 6' some.out
check "a batch takes parts that are there" bench some
if [ -n "$long" ]; then
    bench rest --job 4 && bench rest --job 2 && bench rest
    same "a batch takes parts that are there" rest
    bench rest2 --job 5 && bench rest2 --jobs 2
    same "workers and a part that is there" rest2
fi
if command -v parallel >/dev/null; then
    rm -r results
    check "GNU parallel: references ahead" bench gnu --references-only
    check "GNU parallel: their noise is told" grep -q 'its own noise is a relmse of' gnu.out
    parallel --will-cite "$etalon" bench e.yaml -o gnu --job {} ::: 1 2 3 4 5 6 >gnu.out 2>&1
    check "GNU parallel: status" [ $? -eq 0 ]
    check "GNU parallel: no job made a reference" [ "$(grep -c 'half' gnu.out)" = 0 ]
    bench gnu --collect
    same "GNU parallel" gnu
else
    echo "skip  GNU parallel is not here (package parallel)"
fi

# --- a crash, an interrupt ---------------------------------------------------------------
wait_for() { # wait_for REGEX FILE
    local i
    for ((i = 0; i < 3000; i++)); do
        ! grep -qsE "$1" "$2" || return 0
        sleep .02
    done
    return 1
}
"$etalon" bench e.yaml -o crash --jobs 2 >crash.out 2>crash.err &
batch=$!
wait_for '^\[1/6\]' crash.out
kill -9 "$(pgrep -P $batch | head -n 1)"
wait $batch
check "a worker crashed: status 1" [ $? -eq 1 ]
check "a worker crashed: told in one line" [ "$(grep -cE "^etalon: error: the process of 'scene \
.*' died \(Killed\): this job has no row, the others go on$" crash.err)/$(wc -l <crash.err)" = 1/1 ]
check "a worker crashed: the others finish" [ "$(rows crash)" = 5 ]
check "a worker crashed: the batch goes on" bench crash
check "a worker crashed: six rows" [ "$(sort -u crash/runs.csv | wc -l)" = 7 ]
sort "$base.outcome" >a.sorted
outcome crash | sort >b.sorted
check "a worker crashed: the same rows" cmp a.sorted b.sorted

sed -i "s/budget: .*/budget: {seconds: 60}/" e.yaml
"$etalon" bench e.yaml -o stop --jobs 2 >stop.out 2>stop.err &
batch=$!
for ((i = 0; i < 3000; i++)); do
    [ "$(ls stop/parts 2>/dev/null | wc -l)" -lt 2 ] || break
    sleep .02
done
workers=$(pgrep -P $batch)
kill -INT $batch
wait $batch
check "an interrupt: status 130" [ $? -eq 130 ]
check "an interrupt: one line" [ "$(cat stop.err)" = \
    "interrupted: the running job was abandoned; the same command goes on from there" ]
check "an interrupt: there were two workers" [ "$(echo $workers | wc -w)" = 2 ]
check "an interrupt: they are gone" [ -z "$(ps -o pid= -p "$(echo $workers | tr ' ' ,)")" ]
check "an interrupt: no row" [ "$(rows stop)" = 0 ]
"$etalon" bench e.yaml -o stop --jobs 2 >stop.out 2>stop.err &
batch=$!
for ((i = 0; i < 3000; i++)); do
    [ "$(pgrep -P $batch | wc -l)" -lt 2 ] || break
    sleep .02
done
workers=$(pgrep -P $batch)
bench stop --job 1 --only x
check "one of --job and --only" [ $? -eq 2 ]
bench stop
check "a second batch is refused" [ $? -eq 1 ]
check "a second batch: one line" grep -qx \
    "etalon: error: another batch is at work in 'stop'; wait for it, .*-o DIR" stop.err
kill -9 $batch
wait $batch 2>/dev/null
for ((i = 0; i < 1000; i++)); do
    [ -n "$(ps -o pid= -p "$(echo $workers | tr ' ' ,)")" ] || break
    sleep .02
done
check "workers die with their batch" [ $i -lt 1000 ]

# --- killed at any moment ----------------------------------------------------------------
RANDOM=20130
kills=0
torture() { # torture NAME KILLS LONGEST ARGS...: kills a batch, lets it end
    local name=$1 count=$2 longest=$3 i
    shift 3
    rm -rf "$name" results
    for ((i = 0; i < count; i++)); do
        "$etalon" bench e.yaml -o "$name" "$@" >/dev/null 2>&1 &
        sleep "$(awk "BEGIN { print $longest * $RANDOM / 32767 }")"
        kill -9 $! 2>/dev/null && kills=$((kills + 1))
        wait $! 2>/dev/null
        [ -z "$long" ] || echo "          $(rows "$name") rows, $(ls "$name/parts" 2>/dev/null | wc -l) parts"
    done
    echo "          $(rows "$name") rows at the end of $count; $kills kills in all"
    check "killed $count times ($*): the batch goes on" bench "$name" "$@"
    same "killed $count times ($*)" "$name"
}
if [ -n "$long" ]; then
    nine 8
    rm -r results
    began=$EPOCHREALTIME
    calm calm8
    took=$(awk "BEGIN { print ($EPOCHREALTIME - $began) / 5 }") # ten kills reach its end
    for round in 1 2 3 4; do
        torture wild$round 10 "$took"
        torture wilder$round 10 "$took" --jobs 2
    done
    # A batch that is killed, then one of another kind.
    rm -r results
    for round in 1 2 3 4 5; do
        for args in "--jobs 2" "--job $round" "" "--jobs 3" "--collect"; do
            "$etalon" bench e.yaml -o motley $args >/dev/null 2>&1 &
            sleep "$(awk "BEGIN { print $took * $RANDOM / 32767 }")"
            kill -9 $! 2>/dev/null && kills=$((kills + 1))
            wait $! 2>/dev/null
        done
    done
    check "kinds of batches, killed in turn" bench motley
    sort "$base.outcome" >a.sorted
    outcome motley | sort >b.sorted
    check "kinds of batches, killed in turn: the same rows" cmp a.sorted b.sorted
    check "kinds of batches: no part is left" [ ! -e motley/parts ]
    echo "          $kills kills in all"
else
    nine 2
    torture wild 3 .3 --jobs 2
fi

# --- a disk that is full, or read-only ---------------------------------------------------
mkdir full
if mount -t tmpfs -o size=200k etalon-test full 2>/dev/null; then
    trap 'umount "$tmp/full" 2>/dev/null; rm -rf "$tmp"' EXIT
    nine 2
    [ -e results ] || bench full_reference --references-only
    rm -rf calm && calm calm
    for args in "" "--jobs 2"; do
        for free in ${long:+8 28 36 52} 20; do
            rm -rf full/*
            head -c $((1024 * (200 - free))) /dev/zero >full/filler 2>/dev/null
            "$etalon" bench e.yaml -o full/r $args >full.out 2>full.err
            check "$free kB of disk ($args): status 1" [ $? -eq 1 ]
            check "$free kB of disk ($args): one line" [ "$(wc -l <full.err)" = 1 ]
            check "$free kB of disk ($args): says so" grep -qE \
                "^etalon: error: cannot (write|make|move) .*full/r.*: No space left on device" \
                full.err
            before=$(rows full/r)
            rm full/filler
            "$etalon" bench e.yaml -o full/r $args >full.out 2>&1
            check "$free kB of disk ($args): goes on after $before rows" [ $? -eq 0 ]
            rm -rf r && mv full/r r
            sed -i 's|\.\./\.\./results|../results|; s|'"$PWD"'/results|../results|' r/runs.csv
            same "$free kB of disk ($args)" r
        done
    done
    mkdir -p full/r
    mount -o remount,ro full
    "$etalon" bench e.yaml -o full/r >full.out 2>full.err
    check "a read-only folder: status 1, one line" [ "$?/$(wc -l <full.err)" = 1/1 ]
    check "a read-only folder: says so" grep -qE \
        "^etalon: error: cannot write 'full/r/lock': Read-only file system" full.err
    umount full
else
    echo "skip  full and read-only disks: no file system can be mounted here"
fi
finish
