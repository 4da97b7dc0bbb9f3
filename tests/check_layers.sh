#!/usr/bin/env bash
# check_layers.sh [ROOT]: holds the includes of ROOT/src against ROOT/src/LAYERS. Fails on
# an edge that LAYERS does not name, an include that names no file, a room without a line,
# two rooms that may see each other, a file name that occurs twice, a folder below a room,
# and a library's header outside the files that may use it.
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

declare -A may
while IFS=: read -r room rooms; do
    case $room in '' | \#*) continue ;; esac
    may[$room]=" $room $rooms "
done <LAYERS

for room in "${!may[@]}"; do
    for other in ${may[$room]}; do
        [ -n "${may[$other]:-}" ] || complain "LAYERS: $room names $other, which has no line"
        [[ $room < $other && ${may[$other]:-} == *" $room "* ]] &&
            complain "LAYERS: $room and $other see each other"
    done
done
for folder in */; do
    [ -n "${may[${folder%/}]:-}" ] || complain "src/$folder has no line in LAYERS"
done
while read -r folder; do
    complain "src/${folder#./}: a room has no folders"
done < <(find . -mindepth 2 -type d)
while read -r name; do
    complain "$name: a file name that occurs twice"
done < <(find . -name '*.[ch]' | sed 's|.*/||' | sort | uniq -d)

while IFS=: read -r file line include; do
    file=${file#./} room=${file#./}
    room=${room%%/*}
    target=$(sed -E 's/^[^<"]*["<]([^>"]*)[">].*/\1/' <<<"$include")
    if [[ $include == *\"* ]]; then
        [ "$target" = build_info.h ] && continue # generated
        [ -f "$target" ] || complain "src/$file:$line: no file src/$target"
        [[ ${may[$room]:-} == *" ${target%%/*} "* ]] ||
            complain "src/$file:$line: $room may not include $target"
    else
        while read -r pattern user; do
            [ -n "$pattern" ] && [[ $target =~ ^($pattern) && ! $file =~ ^$user$ ]] &&
                complain "src/$file:$line: only $user may include <$target>"
        done <<<"$only_users"
    fi
done < <(grep -rnE '^[[:space:]]*#[[:space:]]*include' --include='*.[ch]' .)

exit $failed
