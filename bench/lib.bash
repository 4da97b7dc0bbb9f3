# Sourced by the scripts beside it.

# value KEY FILE: of a flat YAML file, as statistics and `etalon compare` are.
value() {
    sed -n "s/^$1: *//p" "$2" | sed 's/^"\(.*\)"$/\1/'
}

# last COLUMN FILE: of the last row of a CSV file.
last() {
    awk -F, -v column="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == column) at = i }
        NR > 1 && at { x = $at } END { print x }' "$2"
}

# need FILE...: says what is missing and ends with status 77.
need() {
    local file
    for file; do
        [ -e "$file" ] && continue
        echo "$0: there is no $file" >&2
        exit 77
    done
}
