#!/usr/bin/env bash
# Parallel efficiency at equal work, in turn: `bench/rank_efficiency.sh [ROUNDS] [MPP]`
# (default 4 rounds of 400 mutations a pixel), with a program that was built by
# `make MPI=1`. One rank with one thread, two ranks with one thread each, one rank with two
# threads; for each the wall and the CPU seconds of rendering that the program states, and
# at the end medians: efficiency by wall is t(1x1) / (2 t), which wants a quiet machine with
# two cores; by CPU it is cpu(1x1) / cpu, which shows extra work but no waiting. The start
# is made by every rank; it is a share of the budget, --set start=0.002 here as for many
# ranks (docs/cluster.md).
set -u
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
etalon=${ETALON:-$root/build/${VARIANT:-release}-mpi/etalon}
[ -x "$etalon" ] || { echo "no program $etalon: make MPI=1"; exit 1; }
rounds=${1:-4} mpp=${2:-400}
tmp=$(mktemp -d "${TEST_TMP:-${TMPDIR:-/tmp}}/etalon-efficiency.XXXXXX")
trap 'rm -rf "$tmp"' EXIT
export OMP_WAIT_POLICY=passive
one() { # one RANKS THREADS: a line "RxT wall cpu"
    mpirun --allow-run-as-root --oversubscribe --bind-to none -n "$1" "$etalon" render \
        "$root/scenes/cornell/scene.yaml" --size 128x118 --mpp "$mpp" --threads "$2" \
        --set start=0.002 --set bootstrap=20000 -o "$tmp/$1x$2.exr" --stats "$tmp/s.yaml" \
        >/dev/null 2>&1 || exit 1
    awk -v name="$1x$2" '$1 == "seconds_total:" { w = $2 } $1 == "seconds_cpu:" { c = $2 }
        END { print name, w, c }' "$tmp/s.yaml"
}
for _ in $(seq "$rounds"); do
    one 1 1
    one 2 1
    one 1 2
done | tee "$tmp/runs"
for how in 2x1 1x2; do
    "$etalon" compare "$tmp/1x1.exr" "$tmp/$how.exr" | grep -q '^rmse: 0$' ||
        echo "$how: other bits"
done
awk '{ w[$1, ++n[$1]] = $2; c[$1, n[$1]] = $3 }
    function median(a, name, m,   i, k, t, v) {
        for (i = 1; i <= m; i++)
            v[i] = a[name, i]
        for (i = 1; i <= m; i++)
            for (k = i + 1; k <= m; k++)
                if (v[k] < v[i]) { t = v[i]; v[i] = v[k]; v[k] = t }
        return (v[int((m + 1) / 2)] + v[int(m / 2) + 1]) / 2
    }
    END {
        for (name in n)
            if (name != "1x1")
                printf "%s: efficiency by wall %.3f, by CPU %.3f\n", name,
                    median(w, "1x1", n["1x1"]) / (2 * median(w, name, n[name])),
                    median(c, "1x1", n["1x1"]) / median(c, name, n[name])
    }' "$tmp/runs"
