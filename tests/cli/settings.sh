#!/usr/bin/env bash
# docs/settings.md has the table of settings as it is: `make docs`.
set -u
. "$(dirname "$0")/lib.bash"

fails() {
    ! "$@" >said 2>&1
}

table=$(dirname "$etalon")/bench/settings_table
check "the document has the table of settings; else: make docs" \
    "$root/.ci/docs" "$table" "$root/docs/settings.md" --check
"$table" >out
check "the table has as many rows as the help" [ "$(grep -c '^| `' out)" -eq \
    "$("$etalon" render --help | sed -n '/^Settings/,/^$/p' | grep -cE '^  [a-z]')" ]

# What the check says of a table that is not as it is.
sed '/^| `seed`/d' "$root/docs/settings.md" >less.md
check "a row that is missing is seen" fails "$root/.ci/docs" "$table" less.md --check
grep -v settings "$root/docs/settings.md" >none.md
check "a document without the marks is refused" fails "$root/.ci/docs" "$table" none.md
"$root/.ci/docs" "$table" less.md
check "the row comes back" cmp less.md "$root/docs/settings.md"
finish
