#!/usr/bin/env bash
# valgrind.sh PROGRAM: small renders under memcheck, leaks included. The program must be
# built for a processor that valgrind knows (no AVX-512): `make valgrind` sees to it.
set -u
# Else the program would start itself anew, and valgrind would not follow.
export OMP_WAIT_POLICY=passive
cd "$(dirname "$0")/.." || exit 1

program=$1
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
failed=0

memcheck() { # scene, options...
    valgrind --quiet --error-exitcode=9 --leak-check=full \
        --show-leak-kinds=definite,possible --suppressions=tests/valgrind.supp \
        "$program" render "$@" --size 32x32 --mpp ${mpp:-4} --threads 1 -o "$out/x.exr" \
        >"$out/log" 2>&1
    local status=$?
    if [ $status -eq 0 ]; then
        echo "ok    $*"
    else
        echo "FAIL  $*: status $status"
        sed 's/^/    | /' "$out/log"
        failed=1
    fi
}

few=(--set bootstrap=1000 --set chains=16)
for scene in scenes/cornell/scene.yaml scenes/glass-caustic/scene.yaml \
    ../shared/scenes/peer-box/glass.pbrt; do
    if [ ! -e "$scene" ]; then
        echo "skip  $scene is not there"
        continue
    fi
    memcheck "$scene" "${few[@]}"
    memcheck "$scene" "${few[@]}" --set builder=pt
    memcheck "$scene" -i bdpt
    memcheck "$scene" --set bootstrap=1000 --set chains=16 -i mmlt
    memcheck "$scene" --set bootstrap=1000 --set chains=16 -i pfmlt --set direct=joint
done

# Written, and gone on from.
for options in "pssmlt builder=bdpt" "mmlt direct=separate" "pfmlt direct=joint" "bdpt seed=1"; do
    state=(-i "${options% *}" "${few[@]}" --set "${options#* }" --checkpoint "$out/state")
    mpp=9 memcheck scenes/cornell/scene.yaml "${state[@]}" --every 0
    mpp=12 memcheck scenes/cornell/scene.yaml "${state[@]}" --resume "$out/state"
done
exit $failed
