#!/usr/bin/env bash
# Checkpoints as a user has them: a render that is killed at any moment, even while it
# writes, goes on and ends in the undisturbed picture, with any number of threads; SIGINT
# and SIGTERM; what does not fit is refused before anything is touched. ETALON_LONG=1: ten
# kills and more of every integrator.
set -u
. "$(dirname "$0")/lib.bash"
write_scene >scene.yaml
export OMP_WAIT_POLICY=passive
few=(--set bootstrap=3000)
RANDOM=${SEED:-1}

set_render() { # set_render NAME ARGS...
    local name=$1
    shift
    command=("$etalon" render scene.yaml "${few[@]}" -o "$name.exr" --stats "$name.yaml" "$@")
}
render() { # render NAME ARGS...
    local command
    set_render "$@"
    "${command[@]}" >"$1.out" 2>"$1.err"
}
same() { # same A B: not one pixel, not one statistic but times, threads and memory
    "$etalon" compare "$1.exr" "$2.exr" >compare.out && grep -qx "rmse: 0" compare.out &&
        grep -qx "n_nonfinite: 0" compare.out &&
        cmp -s <(grep -vE '^(seconds_|threads:|memory_)' "$1.yaml") \
            <(grep -vE '^(seconds_|threads:|memory_)' "$2.yaml")
}
refused() { # refused STATUS WORDS ARGS...: one line that says so; no file is touched
    local status=$1 words=$2
    shift 2
    echo kept >refused.csv
    "$etalon" render scene.yaml "${few[@]}" -o refused.exr --reference reference.exr \
        --errors refused.csv "$@" >refused.out 2>refused.err
    [ $? -eq "$status" ] && [ "$(wc -l <refused.err)" -eq 1 ] &&
        grep -qF -- "$words" refused.err && [ ! -e refused.exr ] &&
        [ "$(cat refused.csv)" = kept ] && [ ! -s refused.out ]
}

# --- kill -9 -----------------------------------------------------------------------------
# Starts, or goes on if there is something to go on from, and is killed after a random time,
# which on average is that of the whole over the number of kills. --every 0 writes after
# every round, so that many a kill meets a write.
kill_and_resume() { # kill_and_resume NAME KILLS SECONDS ARGS...
    local name=$1 kills=$2 seconds=$3 met=0 resumed=0 torn=0 pid from command
    shift 3
    rm -f state.ck* "$name".*
    for ((i = 0; i < kills; i++)); do
        from=()
        [ -e state.ck ] && from=(--resume state.ck) && resumed=$((resumed + 1))
        set_render "$name" "$@" --threads $((1 + i % 3)) --checkpoint state.ck --every 0 \
            "${from[@]}"
        "${command[@]}" >"$name.out" 2>"$name.err" &
        pid=$!
        sleep "$(awk "BEGIN { print 0.02 + 2 * $seconds / $kills * $RANDOM / 32768 }")"
        kill -9 $pid 2>/dev/null
        wait $pid 2>/dev/null
        [ $? -ne 0 ] && met=$((met + 1))
        [ -e state.ck.part ] && torn=$((torn + 1))
    done
    from=()
    [ -e state.ck ] && from=(--resume state.ck) && resumed=$((resumed + 1))
    render "$name" "$@" "${from[@]}" || cat "$name.err"
    echo "      $met of $kills killed, $torn while writing; $resumed resumed: $(head -n 1 \
        "$name.err")"
}

kills=2
mpp=200
designs=("pssmlt builder=bdpt" "mmlt direct=separate" "bdpt seed=1")
if [ -n "${ETALON_LONG:-}" ]; then
    kills=12
    mpp=${MPP:-800}
    designs+=("pssmlt builder=pt" "pssmlt estimator=plain" "pssmlt kernel=gaussian"
        "pssmlt rule=tours" "pfmlt rule=tours" "mmlt direct=joint" "mmlt per=length" "pfmlt mode=exact" "pfmlt mode=counted"
        "pfmlt mode=paper" "rjmlt jump_probability=0.3" "rjmlt mode=exact" "pt seed=1")
fi
# The tapes of the rule tours are in a checkpoint within the start.
designs+=("mmlt rule=tours --set start=0.5 --set start_cap=0.5")
for design in "${designs[@]}"; do
    args=(-i "${design%% *}" --set ${design#* } --mpp $mpp)
    begin=$EPOCHREALTIME
    render whole "${args[@]}" --threads 2
    seconds=$(awk "BEGIN { print $EPOCHREALTIME - $begin }")
    kill_and_resume killed $kills "$seconds" "${args[@]}"
    check "$design: killed $kills times and the same" same whole killed
done

# --- SIGINT and SIGTERM ------------------------------------------------------------------
args=(-i pssmlt --mpp 400)
render reference -i bdpt --spp 8
render whole "${args[@]}"
interrupt() { # interrupt SIGNAL: sends it after the first row of the error log
    rm -f signal.*
    # An hour between checkpoints: the only one is that of the signal.
    "$etalon" render scene.yaml "${few[@]}" "${args[@]}" -o signal.exr \
        --reference reference.exr --errors signal.csv --checkpoint signal.ck --every 3600 \
        >signal.out 2>signal.err &
    pid=$!
    while [ "$(cat signal.csv 2>/dev/null | wc -l)" -lt 2 ] && kill -0 $pid 2>/dev/null; do
        sleep 0.02
    done
    ls signal.ck >earlier 2>/dev/null
    kill -$1 $pid 2>/dev/null
    wait $pid
    status=$?
}
for signal in INT TERM; do
    # On a busy machine a run may end before the signal is sent: then once more.
    for ((attempt = 0; attempt < 10; attempt++)); do
        interrupt $signal
        ! grep -q ^interrupted signal.err || break
    done
    check "SIG$signal: it was stopped" grep -q ^interrupted signal.err
    check "SIG$signal: no checkpoint before" [ ! -s earlier ]
    check "SIG$signal: status 0" [ $status -eq 0 ]
    check "SIG$signal: the picture so far, and a checkpoint" [ -s signal.exr -a -s signal.ck ]
    cp signal.csv before.csv
    render signal "${args[@]}" --resume signal.ck --threads 3 --reference reference.exr \
        --errors signal.csv --checkpoint signal.ck
    check "SIG$signal: resumed, the same" same whole signal
    check "SIG$signal: says from where" grep -q "^resumed from signal.ck: " signal.err
    # The row that the interrupted run ended with is not one of an undisturbed run.
    check "SIG$signal: the rows before the checkpoint stay" cmp -s \
        <(sed '$d' before.csv) <(head -n $(($(wc -l <before.csv) - 1)) signal.csv)
    check "SIG$signal: times and paths go up" awk -F, 'NR > 1 { if ($1 <= wall || $3 <= paths)
        exit 1; wall = $1; paths = $3 } END { if (paths != 307200) exit 1 }' signal.csv
done
cp signal.csv before.csv
render again "${args[@]}" --resume signal.ck --reference reference.exr --errors signal.csv
check "a finished run, resumed, is the same" same whole again
check "and its error log" cmp -s before.csv signal.csv

# --- a larger budget ---------------------------------------------------------------------
render half -i pt --spp 10 --checkpoint pt.ck
render whole -i pt --spp 25
render half -i pt --spp 25 --resume pt.ck
check "pt with more samples is pt with more samples" same whole half
check "the other budget is told" grep -q "^warning: the checkpoint was made with another" \
    half.err

# --- what is refused; more in tests/malformed/checkpoints.bash ---------------------------
log=(--resume signal.ck)
made="the checkpoint was made with"
check "another setting" refused 1 "s1: $made 0.0009765625" "${args[@]}" "${log[@]}" --set s1=0.0005
check "two differences" refused 1 "this run has 9; start_mutations: $made 64, this" \
    "${args[@]}" "${log[@]}" --set start_mutations=2 --set chains=9
cp scene.yaml kept.yaml
sed -i 's/emission: 8/emission: 9/' scene.yaml
check "a scene that has changed" refused 1 "content of the scene: $made" "${args[@]}" "${log[@]}"
cp kept.yaml scene.yaml
cp reference.exr kept.exr
render reference -i bdpt --spp 9
check "another reference" refused 1 "reference of the error log: $made" "${args[@]}" "${log[@]}"
cp kept.exr reference.exr
mkdir moved && cp scene.yaml moved/other.yaml
"$etalon" render moved/other.yaml "${few[@]}" "${args[@]}" --reference reference.exr --errors \
    again.csv --resume signal.ck -o again.exr --stats again.yaml >/dev/null 2>&1
check "the same scene by another name will do" [ $? -eq 0 ]
finish
