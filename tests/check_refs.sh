#!/bin/sh
# Every key like [Veach97] in src/ and tests/ is explained in src/REFS.md.
cd "$(dirname "$0")/.." || exit 1

status=0
for key in $(grep -rhoE '\[[A-Z][A-Za-z]+[0-9]{2}\b' src tests --include='*.[ch]' |
    tr -d '[' | sort -u); do
    grep -q "^\*\*\[$key\]\*\*" src/REFS.md && continue
    grep -rnF "[$key" src tests --include='*.[ch]' | head -n 3
    echo "[$key] is not in src/REFS.md"
    status=1
done
exit $status
