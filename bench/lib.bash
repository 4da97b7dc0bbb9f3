# Sourced by the scripts beside it, and by the tests of the command line.

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

# bdpt_reference COVERAGE SCENE OUT.exr SPP SETTING=X...: with its standard errors beside
# it, if it is not there. A scene that has a "-true" file is rendered by that.
bdpt_reference() {
    local coverage=$1 file=$2 out=$3 spp=$4
    shift 4
    [ -e "${file%.pbrt}-true.pbrt" ] && file=${file%.pbrt}-true.pbrt
    need "$file"
    [ -e "$out.se.exr" ] ||
        "$coverage" "$file" "$out" reference integrator=bdpt seed=999 \
            mutations_per_pixel="$spp" "$@" >/dev/null
}

# shellcheck disable=SC2034
student_awk=$(<"${BASH_SOURCE[0]%/*}/student.awk")

# columns FILE NAME...: these columns of a CSV file, apart by tabs, without the header. A
# column that is not there is empty.
columns() {
    local file=$1
    shift
    awk -v names="$*" '
        # Cells of a line whose quoted ones may hold commas and doubled quotes.
        function cells(line, cell,    n, i, c, quoted) {
            split("", cell)
            for (i = n = 1; i <= length(line); i++) {
                c = substr(line, i, 1)
                if (c == "\"" && quoted && substr(line, i + 1, 1) == "\"") {
                    cell[n] = cell[n] c
                    i++
                } else if (c == "\"")
                    quoted = !quoted
                else if (c == "," && !quoted)
                    n++
                else
                    cell[n] = cell[n] c
            }
            return n
        }
        { n = cells($0, cell) }
        NR == 1 { for (i = 1; i <= n; i++) at[cell[i]] = i; wanted = split(names, name, " ") }
        NR > 1 {
            for (i = 1; i <= wanted; i++)
                printf "%s%s", (i > 1 ? "\t" : ""), name[i] in at ? cell[at[name[i]]] : ""
            print ""
        }' "$file"
}

# reseed EXPERIMENT FIRST COUNT: the experiment file with these seeds, to be read from any
# folder.
reseed() {
    local folder
    folder=$(realpath "$(dirname "$1")")
    grep -q '^seeds:' "$1" || { echo "$1: no line 'seeds:'" >&2 && return 1; }
    sed -E -e "s|^seeds:.*|seeds: [$(seq -s, "$2" $(($2 + $3 - 1)))]|" \
        -e "s#((scene|reference): +)([a-z._][^ ,}]*\.(yaml|exr))#\1$folder/\3#" "$1"
}
