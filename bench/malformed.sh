#!/usr/bin/env bash
# What the program says of malformed inputs, into results/malformed/: table.md, table.csv and
# index.html (a minute). The rows are those that tests/cli/malformed.sh asserts; ends with 1
# if one of them was otherwise.
set -u
cd "$(dirname "$0")/.." || exit 1

out=results/malformed
mkdir -p "$out"
rows=$(mktemp)
trap 'rm -f "$rows"' EXIT
status=0
etalon=$(realpath "${ETALON:-build/release/etalon}")
ETALON=$etalon MALFORMED_TABLE=$rows tests/cli/malformed.sh | sed '/^ok /d'
[ "${PIPESTATUS[0]}" -eq 0 ] && [ -s "$rows" ] || status=1

# A row: kind, input, command, message, status, ms, whether older files stayed, verdict.
head="kind input command message status ms untouched verdict"
awk -F'\t' -v head="$head" 'BEGIN { gsub(" ", ",", head); print head }
    { for (i = 1; i <= NF; i++) { gsub("\"", "\"\"", $i); printf "%s\"%s\"", (i > 1 ? "," : ""), $i }
    print "" }' "$rows" >"$out/table.csv"
awk -F'\t' '
    { kinds[$1]++; if (!($1 in order)) { order[$1] = ++n; name[n] = $1 } refused += $5 != 0
      if ($8 != "ok") bad++; for (i = 1; i <= NF; i++) gsub(/\|/, "\\|", $i)
      line[NR] = "| " $2 " | `" $3 "` | " $4 " | " $5 " | " $6 " | " $7 " |"; of[NR] = $1 }
    END {
        print "# Malformed inputs\n"
        printf "%d inputs, %d refused, %d taken (some with a warning), %d otherwise than ", \
            NR, refused, NR - refused, bad
        print "the test wants. `untouched`: files that were there before are the same, and no"
        print "other was made (`written`: as it should be). The folder `../in` holds the inputs, as `tests/malformed/` makes them.\n"
        for (k = 1; k <= n; k++) printf "* %s: %d\n", name[k], kinds[name[k]]
        for (k = 1; k <= n; k++) {
            printf "\n## %s\n\n| input | command | message | status | ms | untouched |\n", name[k]
            print "|---|---|---|---|---|---|"
            for (i = 1; i <= NR; i++) if (of[i] == name[k]) print line[i]
        }
    }' "$rows" >"$out/table.md"
awk -F'\t' 'BEGIN {
        print "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Malformed inputs</title>"
        print "<style>body { font: 14px sans-serif } table { border-collapse: collapse }"
        print "td, th { border: 1px solid #ccc; padding: 2px 6px; text-align: left; vertical-align: top }"
        print "td:nth-child(3), td:nth-child(4) { font-family: monospace; overflow-wrap: anywhere }</style></head><body>"
        print "<h1>Malformed inputs</h1><table><tr><th>kind<th>input<th>command<th>message<th>status<th>ms<th>untouched<th>verdict"
    }
    { for (i = 1; i <= NF; i++) { gsub("&", "\\&amp;", $i); gsub("<", "\\&lt;", $i) }
      printf "<tr>"; for (i = 1; i <= NF; i++) printf "<td>%s", $i; print "" }
    END { print "</table></body></html>" }' "$rows" >"$out/index.html"
sed -n '3,/^## /{/^## /d; p}' "$out/table.md"
echo "$out/table.md, $out/table.csv, $out/index.html"
exit $status
