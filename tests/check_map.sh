#!/usr/bin/env bash
# check_map.sh [ROOT]: what src/README.md names is there: `room/file.c`, or
# `room/folder/file.c`, and, for `room/file.c:function`, a line of that file that begins a
# definition of the function.
set -u
cd "${1:-$(dirname "$0")/..}" || exit 1

status=0
names=$(grep -oE '`([a-z_]+/)+[a-z_]+\.[ch](:[a-z_]+)?`' src/README.md | tr -d '`' | sort -u)
[ -n "$names" ] || { echo "src/README.md names no file" && exit 1; }
for name in $names; do
    file=src/${name%%:*} function=${name#*:}
    if [ ! -f "$file" ]; then
        echo "src/README.md names $name, and there is no $file"
        status=1
    elif [ "$function" != "$name" ] && ! grep -qE "^[a-z].*\b$function\(" "$file"; then
        echo "src/README.md names $name, and $file defines no such function"
        status=1
    fi
done
exit $status
