#!/usr/bin/env bash
# check_layers.sh [ROOT]: holds the includes of ROOT/src against ROOT/src/LAYERS. A unit is
# a room (path) or a folder in it (import/pbrt). A folder sees its room's own files and what
# the room sees, and the folders that its line names; nobody else sees into it.
# In an `ordered` unit no file includes one that, over whatever others, includes it: x.c and
# x.h are one file. Fails on an edge that LAYERS does not name, an include that names no file, a unit without
# a line, two units that may see each other, a file name that occurs twice, a folder in a
# folder of a room, and a library's header outside the files that may use it.
set -u
root=${1:-$(dirname "$0")/..}
cd "$root/src" || exit 1

failed=0
complain() {
    echo "$*"
    failed=1
}

# The only users of libraries: header pattern, file pattern.
declare -A only_users=(
    ['embree3/']='scene/accel_scenes.h'
    ['(OpenEXR/)?openexr']='image/exr_(read|write).c'
    ['(OpenEXR/)?Imf|Imath']='image/exr_(read|write).c'
    ['yaml.h']='base/doc.c'
    ['omp.h']='base/par.c'
    ['microhttpd.h']='live/http.c'
    ['expat.h']='import/mitsuba/mitsuba_tree.c'
)

# A folder's line follows its room's, whose rooms it inherits.
declare -A may
ordered=
while IFS=: read -r unit units; do
    case $unit in '' | \#*) continue ;; esac
    [ "$unit" = ordered ] && ordered+=$units && continue
    room=${unit%%/*}
    [ "$unit" = "$room" ] || [ -n "${may[$room]:-}" ] ||
        complain "LAYERS: $unit stands before $room"
    [ "$unit" = "$room" ] || units+=${may[$room]:-}
    may[$unit]=" $unit $units "
done <LAYERS

for unit in "${!may[@]}"; do
    for other in ${may[$unit]}; do
        [ -n "${may[$other]:-}" ] || complain "LAYERS: $unit names $other, which has no line"
        [[ $unit < $other && ${may[$other]:-} == *" $unit "* ]] &&
            complain "LAYERS: $unit and $other see each other"
    done
done
for folder in */ */*/; do
    [ -d "$folder" ] || continue
    [ -n "${may[${folder%/}]:-}" ] || complain "src/$folder has no line in LAYERS"
done
while read -r folder; do
    complain "src/${folder#./}: a folder of a room has no folders"
done < <(find . -mindepth 3 -type d)
while read -r name; do
    complain "$name: a file name that occurs twice"
done < <(find . -name '*.[ch]' | sed 's|.*/||' | sort | uniq -d)

name_of='[<"]([^>"]*)[>"]'
while IFS=: read -r file line include; do
    file=${file#./} unit=${file#./}
    unit=${unit%/*}
    target=$include
    [[ $include =~ $name_of ]] && target=${BASH_REMATCH[1]}
    if [[ $include == *\"* ]]; then
        [ "$target" = build_info.h ] && continue # generated
        [ -f "$target" ] || complain "src/$file:$line: no file src/$target"
        [[ ${may[$unit]:-} == *" ${target%/*} "* ]] ||
            complain "src/$file:$line: $unit may not include $target"
    else
        for pattern in "${!only_users[@]}"; do
            user=${only_users[$pattern]}
            [[ $target =~ ^($pattern) && ! $file =~ ^$user$ ]] &&
                complain "src/$file:$line: only $user may include <$target>"
        done
    fi
done < <(grep -rnE '^[[:space:]]*#[[:space:]]*include' --include='*.[ch]' .)

for unit in $ordered; do
    [ -n "${may[$unit]:-}" ] || complain "LAYERS: ordered names $unit, which has no line"
    loop=$(grep -oE "^[[:space:]]*#[[:space:]]*include[[:space:]]*\"$unit/[a-z_0-9]+" "$unit"/*.[ch] |
        sed -E "s|^$unit/([a-z_0-9]+)\.[ch]:.*\"$unit/|\1 |" |
        tsort 2>&1 >/dev/null | sed 's/^tsort: //; /input contains a loop/d' | tr '\n' ' ')
    [ -z "$loop" ] || complain "src/$unit: files that include each other: $loop"
done

exit $failed
