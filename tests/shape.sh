#!/usr/bin/env bash
# The shape of the house: files and lines a room, lengths of functions (signature to
# closing brace, as clang-format lays them out), and the longest ones.
set -eu
cd "$(dirname "$0")/.."
shopt -s nullglob

printf '%-18s %6s %7s\n' room files lines
row() {
    find "$2" -name '*.[ch]' -print0 | xargs -0 -r cat | wc -l |
        xargs printf '%-18s %6d %7d\n' "$1" "$(find "$2" -name '*.[ch]' | wc -l)"
}
for room in src/* tests; do
    [ -d "$room" ] || continue
    row "${room#src/}" "$room"
    [ "$room" = tests ] && continue
    for folder in "$room"/*/; do
        row "  ${folder#src/}" "$folder"
    done
done

functions() {
    awk '
        FNR == 1 || /^[[:space:]]*$/ || /^}/ { if (!inside) start = 0 }
        !inside && !start && /^[A-Za-z_]/ { start = FNR; signature = $0 }
        !inside && /^{/ { inside = 1 }
        inside && /^}/ {
            sub(/\(.*/, "", signature)
            sub(/.*[ *]/, "", signature)
            printf "%d %s %s\n", FNR - start + 1, FILENAME, signature
            inside = start = 0
        }' "$@" | sort -n
}

list=$(functions $(find src -name '*.[ch]' | sort))
echo "$list" | awk '
    { lines[NR] = $1; over += $1 > 60 }
    END {
        if (NR > 0)
            printf "\nfunctions %d: median %d, p90 %d, max %d lines; %d over 60\n", NR,
                lines[int((NR + 1) / 2)], lines[int(0.9 * NR + 0.999)], lines[NR], over
    }'
echo "the longest:"
echo "$list" | tail -n 5
mutual=$(tests/check_layers.sh | grep -c 'see each other' || true)
echo "pairs of rooms that include each other: $mutual"
