#!/usr/bin/env bash
# Ranks of MPI give the bits of one process: pssmlt by 2 of them, mmlt by 3, whose
# checkpoint one process without MPI takes. Skipped where the program for mpirun was not
# made, as Open MPI is not there. Kills: bench/rank_kills.sh. Broken once to see it fail:
# rank 0 leaves out what the last rank sends.
set -u
. "$(dirname "$0")/lib.bash"
mpi=$(dirname "$etalon")-mpi/etalon
if [ ! -x "$mpi" ] || ! command -v mpirun >/dev/null; then
    echo "no program for mpirun: libopenmpi-dev and openmpi-bin are not installed"
    exit 77
fi
write_scene >scene.yaml
export OMP_NUM_THREADS=1
common=(--size 24x18 --mpp 12 --threads 1 --set bootstrap=1000)

ranks() { # ranks N ARGS...
    local n=$1
    shift
    mpirun --allow-run-as-root --oversubscribe -n "$n" "$mpi" render scene.yaml "${common[@]}" "$@" >ranks.out 2>&1 ||
        { cat ranks.out && return 1; }
}
one() { "$etalon" render scene.yaml "${common[@]}" "$@" >one.out; }
same() { # same A B: not one pixel, not one statistic but times, threads and memory
    "$etalon" compare "$1.exr" "$2.exr" >compare.out && grep -qx "rmse: 0" compare.out &&
        cmp <(grep -vE '^(seconds_|threads:|memory_|peak_)' "$1.yaml") \
            <(grep -vE '^(seconds_|threads:|memory_|peak_)' "$2.yaml")
}

one -i pssmlt -o one.exr --stats one.yaml
check "2 ranks" ranks 2 -i pssmlt -o two.exr --stats two.yaml
check "said so" grep -q '^ranks *2,' ranks.out
check "give the bits of one process" same one two
one -i mmlt -o whole.exr --stats whole.yaml
check "3 ranks" ranks 3 -i mmlt -o three.exr --stats three.yaml --checkpoint run.ck
check "give the bits of one process" same whole three
check "one goes on from their checkpoint" one -i mmlt --resume run.ck -o on.exr --stats on.yaml
check "to the same bits" same whole on
finish
