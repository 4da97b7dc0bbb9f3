#!/usr/bin/env bash
# check_layers.sh [ROOT]: holds the includes of ROOT/src against ROOT/src/LAYERS. A unit is
# a room (path) or a folder in it (import/pbrt). A folder sees its room's own files and what
# the room sees, and the folders that its line names; nobody else sees into it.
# Fails on an edge that LAYERS does not name, an include that names no file, a unit without
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
only_users='
embree3/  scene/accel.c
(OpenEXR/)?openexr image/exr_(read|write).c
(OpenEXR/)?Imf|Imath image/exr_(read|write).c
yaml.h    base/doc.c
omp.h     base/par.c
'

# A folder's line follows its room's, whose rooms it inherits.
declare -A may
while IFS=: read -r unit units; do
    case $unit in '' | \#*) continue ;; esac
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

while IFS=: read -r file line include; do
    file=${file#./} unit=${file#./}
    unit=${unit%/*}
    target=$(sed -E 's/^[^<"]*["<]([^>"]*)[">].*/\1/' <<<"$include")
    if [[ $include == *\"* ]]; then
        [ "$target" = build_info.h ] && continue # generated
        [ -f "$target" ] || complain "src/$file:$line: no file src/$target"
        [[ ${may[$unit]:-} == *" ${target%/*} "* ]] ||
            complain "src/$file:$line: $unit may not include $target"
    else
        while read -r pattern user; do
            [ -n "$pattern" ] && [[ $target =~ ^($pattern) && ! $file =~ ^$user$ ]] &&
                complain "src/$file:$line: only $user may include <$target>"
        done <<<"$only_users"
    fi
done < <(grep -rnE '^[[:space:]]*#[[:space:]]*include' --include='*.[ch]' .)

exit $failed
