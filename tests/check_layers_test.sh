#!/usr/bin/env bash
# Shows that check_layers.sh passes a small sound tree and fails on each planted fault.
set -u
check=$(cd "$(dirname "$0")" && pwd)/check_layers.sh
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failed=0

sound_tree() {
    rm -rf "$work/src"
    mkdir -p "$work"/src/{base,path/{near,far},chain}
    printf '%s\n' base: 'path: base' path/near: 'path/far: path/near' 'chain: base' \
        >"$work/src/LAYERS"
    printf '#include "base/err.h"\n#include <stdio.h>\n' >"$work/src/base/err.c"
    touch "$work/src/base/err.h"
    printf '#include "base/err.h"\n' >"$work/src/path/walk.h"
    printf '#include "path/walk.h"\n' >"$work/src/path/walk.c"
    printf '#include "base/err.h"\n' >"$work/src/chain/step.h"
    printf '#include "base/err.h"\n#include "path/walk.h"\n' >"$work/src/path/near/ray.h"
    printf '#include "path/near/ray.h"\n' >"$work/src/path/far/sky.h"
}

# expect "" or a pattern of the complaint
expect() {
    local said status=0
    said=$("$check" "$work" 2>&1) || status=$?
    if [ -z "$1" ]; then
        [ $status -eq 0 ] && return
        echo "complains about a sound tree: $said"
    else
        [ $status -ne 0 ] && grep -qE "$1" <<<"$said" && return
        echo "no complaint like '$1': $said"
    fi
    failed=1
}

plant() {
    sound_tree
    printf '%s\n' "$2" >>"$work/src/$1"
    expect "$3"
}

sound_tree
expect ""
plant path/walk.c '#include "chain/step.h"' 'path/walk.c:2: path may not include'
plant chain/step.h '  #  include "path/walk.h"' 'step.h:2: chain may not include'
plant base/err.h '#include "path/walk.h"' 'base may not include'
plant path/walk.c '#include "walk.h"' 'no file src/walk.h'
plant path/walk.c '#include <embree3/rtcore.h>' 'only scene/accel_scenes.h may include'
plant path/walk.c '#include <openexr.h>' 'only image/exr.* may include'
plant path/walk.c '#include <OpenEXR/openexr.h>' 'only image/exr.* may include'
plant path/walk.c '#include <yaml.h>' 'only base/doc.c may include'
plant path/walk.c '#include <expat.h>' 'only import/mitsuba/mitsuba_tree.c may include'
plant path/walk.c '#include <omp.h>' 'only base/par.c may include'
plant chain/walk.c '' 'walk.c: a file name that occurs twice'
plant LAYERS 'lab: attic' 'names attic, which has no line'
sound_tree
sed -i 's/^path:.*/path: base chain/; s/^chain:.*/chain: base path/' "$work/src/LAYERS"
expect 'see each other'
sound_tree
mkdir "$work/src/attic"
expect 'attic/ has no line'
sound_tree
mkdir "$work/src/path/deep"
expect 'path/deep/ has no line'
sound_tree
mkdir "$work/src/path/near/deep"
expect 'a folder of a room has no folders'
plant path/near/ray.h '#include "path/far/sky.h"' 'path/near may not include path/far'
plant path/walk.c '#include "path/near/ray.h"' 'path may not include path/near'
plant chain/step.h '#include "path/near/ray.h"' 'chain may not include path/near'
plant path/far/sky.h '#include "chain/step.h"' 'path/far may not include chain'
plant path/near/walk.c '' 'walk.c: a file name that occurs twice'
sound_tree
sed -i 's|^path:.*|path: base path/far|' "$work/src/LAYERS"
expect 'see each other'
sound_tree
sed -i '/^path:/d' "$work/src/LAYERS"
expect 'path/near stands before path'
sound_tree
printf '%s\n' 'ordered: path' >>"$work/src/LAYERS"
printf '#include "path/walk.h"\n' >"$work/src/path/roulette.h"
expect ""
printf ' # include "path/roulette.h"\n' >>"$work/src/path/walk.c"
expect 'src/path: files that include each other: (roulette walk|walk roulette)'
exit $failed
