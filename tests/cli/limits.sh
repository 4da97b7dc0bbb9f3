#!/usr/bin/env bash
# What a user meets at the limits of a machine: files that may grow no further, disks that
# are full, memory that ends while a scene is read and a run is set up (in the middle of a
# run: tests/unit/test_run_exhaustion.c).
set -u
. "$(dirname "$0")/lib.bash"
write_scene >scene.yaml
few=(-i pt --spp 2 --threads 1)

# one_line FILE WORDS: one line, with these words in it.
one_line() {
    [ "$(wc -l <"$1")" -eq 1 ] && grep -qF -- "$2" "$1"
}

# --- files ---------------------------------------------------------------------------
big=$PWD/big.exr
too_large() { # too_large WORDS ARGS...: 1 kB is the most that a file may have
    local words=$1
    shift
    (ulimit -f 1 && exec "$etalon" "$@" >/dev/null 2>err)
    [ $? -eq 1 ] && one_line err "$words"
}
"$etalon" render scene.yaml "${few[@]}" -o "$big" --stats big.yaml --checkpoint state.ck \
    >/dev/null 2>&1
cp big.exr kept.exr && cp big.yaml kept.yaml && cp state.ck kept.ck
check "a picture beyond the limit of a file's size is a write error" too_large \
    "cannot write '$big': File too large" render scene.yaml "${few[@]}" --seed 2 -o "$big"
check "and the older picture stays" cmp -s big.exr kept.exr
check "so are statistics" too_large "cannot write 'big.yaml': File too large" \
    startup scene.yaml --mpp 1 --set bootstrap=500 --stats big.yaml
check "and the older ones stay" cmp -s big.yaml kept.yaml
check "so is a checkpoint" too_large "cannot write 'state.ck': File too large" \
    render scene.yaml "${few[@]}" -o small.exr --checkpoint state.ck
check "and the older one stays" cmp -s state.ck kept.ck
check "nothing half written is left" [ -z "$(find . -name '*.part*')" ]
if [ -w /dev/full ]; then
    ln -s /dev/full full.exr
    "$etalon" render scene.yaml "${few[@]}" -o full.exr >out 2>err
    check "a full disk is a write error" [ $? -eq 1 ]
    check "which names the file" one_line err "cannot write 'full.exr': No space left"
fi

# --- memory --------------------------------------------------------------------------
# The sanitizers reserve terabytes of addresses.
(ulimit -v 4000000 && "$etalon" --version >/dev/null 2>&1) || finish

# From a little more than the program itself takes up: every end is a regular one. The
# loader's own lines, while even libraries do not fit, are not ours.
ends=$(for ((kb = 150000; kb < 600000; kb += 30000)); do
    (
        ulimit -v $kb
        "$etalon" --version >/dev/null 2>&1 || exit
        "$etalon" render scene.yaml "${few[@]}" -o m$kb.exr >/dev/null 2>m$kb.err
        status=$?
        if [ $status -eq 0 ] && [ -e m$kb.exr ]; then
            echo done
        elif [ $status -eq 1 ] && [ "$(wc -l <m$kb.err)" -eq 1 ]; then
            echo told
        else
            echo "at $kb kB: status $status, $(head -c 200 m$kb.err)"
        fi
    )
done)
check "memory that ends at any time is told in one line" \
    [ -z "$(grep -vxE 'done|told' <<<"$ends")" ]
check "and there is some that suffices" grep -qx done <<<"$ends"

finish
