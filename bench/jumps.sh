#!/usr/bin/env bash
# make bench-jumps: how many of the jumps of rjmlt are accepted, in our own scenes and in
# those of others, all lengths of the file. Acceptance is 1 but for rounding
# (path/invert.h). Writes results/rjmlt/jumps.csv: a row for each scene, with all jumps to
# another technique, the mean of their acceptance probabilities, and those that led to no
# sample or to another one, which are rejected.
set -euo pipefail
cd "$(dirname "$0")/.."
. bench/lib.bash
trap 'exit 130' INT

etalon=${ETALON:-build/release/etalon}
out=results/rjmlt
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$out"

# row FILE SIZE [OPTION...]
row() {
    local file=$1 size=$2
    shift 2
    [ -e "$file" ] || return 0
    "$etalon" render "$file" --size "$size" --threads 1 -i rjmlt --mpp 64 --seed 5 \
        --set jump_probability=0.3 "$@" --stats "$work/run.yaml" -o "$work/run.exr" \
        >/dev/null 2>&1
    echo "$file,$(value max_depth "$work/run.yaml"),$(value jumps "$work/run.yaml"),$(
        value jump_acceptance "$work/run.yaml"),$(value failures_inverse "$work/run.yaml")"
}

{
    echo scene,max_depth,jumps,jump_acceptance,failures_inverse
    for name in chess cornell door glass-ball glass-caustic interior light-tube pool shells \
        splash twin-lamps water-glass; do
        row scenes/$name/scene.yaml 60x45
    done
    shared=../shared/scenes
    row $shared/peer-box/diffuse.pbrt 60x48
    row $shared/peer-box/glass.pbrt 60x48
    row $shared/coffee-pbrt3/scene.pbrt 48x60
    row $shared/living-room-pbrt3/scene.pbrt 64x36 --max-depth 12
    row $shared/living-room-pbrt3/scene.pbrt 64x36
    row $shared/veach-bidir-mitsuba/scene.xml 64x36
    row $shared/veach-ajar-mitsuba/scene.xml 64x36
    row $shared/veach-mis-mitsuba/scene.xml 64x36
    row $shared/torus-dpt/h2mc.xml 48x48
    row $shared/cornell-box-pbrt3/scene.pbrt 48x48
    row $shared/killeroos-pbrt4/killeroo-coated-gold.pbrt 48x48
    row $shared/killeroos-pbrt4/killeroo-simple.pbrt 48x48
    row $shared/staircase-pbrt4/staircase.pbrt 48x64
    row $shared/breakfast-pbrt3/breakfast.pbrt 64x36
    row $shared/contemporary-bathroom-pbrt3/contemporary-bathroom.pbrt 36x64
    row $shared/lux-luxtime/luxtime.lxs 60x45
} | tee "$out/jumps.csv"
