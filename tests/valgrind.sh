#!/usr/bin/env bash
# valgrind.sh PROGRAM: every command on small inputs under memcheck, leaks included. The
# program must be built for a processor that valgrind knows (no AVX-512): `make valgrind`
# sees to it. ONLY=REGEX: those whose line matches.
set -u
# Else the program would start itself anew, and valgrind would not follow.
export OMP_WAIT_POLICY=passive
cd "$(dirname "$0")/.." || exit 1

program=$1
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
failed=0 count=0
checker=(valgrind --quiet --error-exitcode=9 --leak-check=full
    --show-leak-kinds=definite,possible --suppressions="$PWD/tests/valgrind.supp")

# conclude STATUS WANTED WHAT: what it said is in $out/log.
conclude() {
    count=$((count + 1))
    if [ "$1" -eq "$2" ]; then
        echo "ok    $3"
    else
        echo "FAIL  $3: status $1, not $2"
        sed 's/^/    | /' "$out/log"
        failed=$((failed + 1))
    fi
}
memcheck() { # memcheck STATUS ARGS...
    local wanted=$1
    shift
    [[ "$*" =~ ${ONLY:-} ]] || return 0
    "${checker[@]}" "$program" "$@" >"$out/log" 2>&1 </dev/null
    conclude $? "$wanted" "$*"
}
render() { # render SCENE ARGS...: tiny
    if [ ! -e "$1" ]; then
        echo "skip  $1 is not there"
        return
    fi
    memcheck ${wanted:-0} render "$@" --size 32x32 --mpp ${mpp:-4} --threads 1 -o "$out/x.exr"
}

few=(--set bootstrap=1000 --set chains=16)
cornell=scenes/cornell/scene.yaml door=scenes/door/scene.yaml
for scene in $cornell scenes/glass-caustic/scene.yaml ../shared/scenes/peer-box/glass.pbrt; do
    render "$scene" "${few[@]}"
    render "$scene" "${few[@]}" --set builder=pt
    render "$scene" -i bdpt
    render "$scene" "${few[@]}" -i mmlt
    render "$scene" "${few[@]}" -i pfmlt --set direct=joint
    render "$scene" "${few[@]}" -i rjmlt --set direct=joint --set jump_probability=0.5
done
render $door "${few[@]}" -i mmlt
render $door "${few[@]}" -i pfmlt --set mode=paper
render $cornell -i pt --set compact=true

# --- verdicts, error bars, errors against a reference --------------------------------------
for replicas in 1 4 64; do
    mpp=8 render $cornell "${few[@]}" -i mmlt --set replicas=$replicas --stats "$out/s.yaml"
    mpp=8 render $cornell -i pt --set replicas=$replicas
done
wanted=3 render $cornell "${few[@]}" --require-converged
render $cornell -i pt
[ ! -e "$out/x.exr" ] || cp "$out/x.exr" "$out/reference.exr"
render $cornell "${few[@]}" --reference "$out/reference.exr" --errors "$out/e.csv"
memcheck 0 compare "$out/x.exr" "$out/reference.exr" -o "$out/d.png" --mean "$out/mean.exr"
memcheck 0 startup $cornell "${few[@]}" --size 32x32 --mpp 4
memcheck 0 info $door
memcheck 0 info $cornell --json

# --- checkpoints: written, and gone on from; an interrupt ----------------------------------
for options in "pssmlt builder=bdpt" "mmlt direct=separate" "pfmlt direct=joint" "bdpt seed=1"; do
    state=(-i "${options% *}" "${few[@]}" --set "${options#* }" --checkpoint "$out/state")
    mpp=9 render $cornell "${state[@]}" --every 0
    mpp=12 render $cornell "${state[@]}" --resume "$out/state"
done
for signal in INT TERM; do
    [[ interrupt =~ ${ONLY:-} ]] || continue
    rm -f "$out"/*.csv
    "${checker[@]}" "$program" render $cornell "${few[@]}" --size 32x32 --seconds 600 \
        --reference "$out/reference.exr" --errors "$out/e.csv" --checkpoint "$out/state" \
        -o "$out/x.exr" >"$out/log" 2>&1 &
    for _ in {1..600}; do
        [ -e "$out/e.csv" ] && [ "$(wc -l <"$out/e.csv")" -ge 2 ] && break
        sleep 0.1
    done
    kill -$signal $!
    wait $!
    conclude $? 0 "an interrupt by SIG$signal"
done

# --- readers -------------------------------------------------------------------------------
# seed FILE AS: a seed of the fuzzer, a scene and the files that it names, into a folder.
seed() {
    mkdir -p "$out/$2" && (cd "$out/$2" && awk -v name="$2" '/^@@ / { name = $2; next }
        { print >name }' "$OLDPWD/tests/fuzz/seeds/$1")
}
# Three of them are read to their ends, and then are no scenes: status 1.
while read -r file name status; do
    seed "$file" "$name"
    memcheck "$status" info "$out/$name/$name"
done <<END
pbrt/all a.pbrt 1
pbrt/shapes b.pbrt 1
pbrt/materials c.pbrt 1
pbrt/lights d.pbrt 0
pbrt/lux e.lxs 0
mitsuba/all f.xml 0
mitsuba/new g.xml 0
mitsuba/old h.xml 0
yaml/scene i.yaml 0
yaml/materials j.yaml 0
END
for mesh in obj/all serialized/file ply/ascii ply/big ply/packed; do
    kind=${mesh%/*}
    [ $mesh = ply/packed ] && kind=ply.gz
    cp "tests/fuzz/seeds/$mesh" "$out/a.$kind"
    echo "<scene version='3.0.0'><sensor type='perspective'/><emitter type='constant'/>
        <shape type='${mesh%/*}'><string name='filename' value='a.$kind'/></shape></scene>" \
        >"$out/mesh.xml"
    render "$out/mesh.xml" -i pt
done

# --- batches and what is made of them ------------------------------------------------------
cat >"$out/e.yaml" <<END
experiment: e
scenes: [{scene: $PWD/$cornell, size: 16x16}]
integrators: [pt, {integrator: mmlt, bootstrap: 1000, chains: 16}]
threads: 1
seeds: 2
budget: {mutations_per_pixel: 4}
reference: {integrator: bdpt, mutations_per_pixel: 2}
END
batch=(bench "$out/e.yaml" --references "$out/references")
memcheck 0 "${batch[@]}" -o "$out/r" --list
memcheck 0 "${batch[@]}" -o "$out/r"
memcheck 0 "${batch[@]}" -o "$out/pool" --jobs 2
memcheck 0 "${batch[@]}" -o "$out/parts" --job 1
memcheck 0 "${batch[@]}" -o "$out/parts" --collect
memcheck 0 report "$out/r"
memcheck 0 report "$out/r" --text
memcheck 0 regress "$out/r" --baseline "$out/b.csv" --update
memcheck 0 regress "$out/r" --baseline "$out/b.csv" --all -o "$out/t.csv"

# --- one malformed input in so many ------------------------------------------------------
if [[ malformed =~ ${ONLY:-} ]]; then
    ETALON=$PWD/$program MALFORMED_RUNNER="${checker[*]}" MALFORMED_WAIT=300 \
        MALFORMED_EVERY=${EVERY:-40} tests/cli/malformed.sh >"$out/log" 2>&1
    status=$?
    count=$((count + $(grep -c '^ok ' "$out/log") - 1))
    conclude $status 0 "malformed inputs: $(grep -c '^ok ' "$out/log") of them"
fi
echo "$count runs, $failed failed"
[ $failed -eq 0 ]
