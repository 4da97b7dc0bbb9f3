#!/usr/bin/env bash
# Random kills of ranks: `bench/rank_kills.sh [KILLS]` (default 20), with a program that was
# built by `make MPI=1`. mpirun starts 2 or 3 ranks with a checkpoint every .2 s; after a
# random time, 1.5 s to WAIT (4) more, one of them is killed by SIGKILL; the run goes on from
# the last checkpoint with another number of ranks. In the end the picture must have the bits
# of one process that nothing disturbed. Prints for each kill the work in the checkpoint
# before and after it: less may never be there than before, and what is lost is at most what
# one run did since. MPP (1500): a run must take longer than its kill comes, on a quiet
# machine too.
set -u
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
etalon=${ETALON:-$root/build/${VARIANT:-release}-mpi/etalon}
[ -x "$etalon" ] || { echo "no program $etalon: make MPI=1"; exit 1; }
wanted=${1:-20}
tmp=$(mktemp -d "${TEST_TMP:-${TMPDIR:-/tmp}}/etalon-kills.XXXXXX")
trap 'rm -rf "$tmp"' EXIT
cd "$tmp" || exit 1
export OMP_NUM_THREADS=1 OMP_WAIT_POLICY=passive
run=(render "$root/scenes/cornell/scene.yaml" --size 40x36 -i mmlt --threads 1
    --mpp "${MPP:-1500}")
ranks() { # ranks N ARGS...
    local n=$1
    shift
    mpirun --allow-run-as-root --oversubscribe -n "$n" "$etalon" "$@"
}
"$etalon" "${run[@]}" -o whole.exr >/dev/null 2>&1 || exit 1

kills=0 ended=0 tries=0 before=0 back=0
while [ $kills -lt "$wanted" ] && [ $tries -lt $((5 * wanted)) ]; do
    tries=$((tries + 1))
    resume=()
    [ -e run.ck ] && resume=(--resume run.ck)
    n=$((2 + RANDOM % 2))
    ranks $n "${run[@]}" --checkpoint run.ck --every 0.2 "${resume[@]}" -o killed.exr >out 2>err &
    pid=$!
    sleep "$(awk -v r=$RANDOM -v most="${WAIT:-4}" 'BEGIN { printf "%.2f", 1.5 + most * r / 32768 }')"
    mapfile -t own < <(ps -o pid= --ppid $pid)
    victim=
    [ ${#own[@]} -gt 0 ] && victim=${own[$((RANDOM % ${#own[@]}))]}
    if [ -n "$victim" ] && kill -9 "$victim" 2>/dev/null; then
        kills=$((kills + 1))
        wait $pid 2>/dev/null
        from=$(sed -n 's/^resumed from run.ck: \([0-9.e+]*\) .*/\1/p' err)
        printf 'kill %2d: 1 of %d ranks, which had begun at %s mutations per pixel\n' \
            $kills $n "${from:-(not yet told)}"
        back=$((back + $(awk -v a="${from:-$before}" -v b="$before" 'BEGIN { print a < b }')))
        before=${from:-$before}
    else
        wait $pid 2>/dev/null
        ended=$((ended + 1))
        rm -f run.ck # it had ended: once more from the beginning
        before=0
    fi
done
resume=()
[ -e run.ck ] && resume=(--resume run.ck)
ranks 2 "${run[@]}" --checkpoint run.ck "${resume[@]}" -o killed.exr >out 2>err || cat err
"$etalon" compare killed.exr whole.exr >compare.out
echo "$kills kills, $ended runs that ended before theirs, $back times behind an earlier checkpoint"
grep '^rmse:' compare.out
grep -qx 'rmse: 0' compare.out && [ $back -eq 0 ] && [ $kills -ge "$wanted" ]
