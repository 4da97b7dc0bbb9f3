# Sourced by the tests of etalon bench, after lib.bash. Not executable on its own.

experiment() { # experiment REST...: lines of an experiment file
    printf '%s\n' 'experiment: e' 'threads: 1' 'bootstrap: 2000' "$@"
}
bench() { # bench NAME ARGS...: results in NAME, what it says in NAME.out and NAME.err
    local name=$1
    shift
    "$etalon" bench e.yaml -o "$name" "$@" >"$name.out" 2>"$name.err"
}
column() { # column NAME FILE: of a table whose cells hold no commas up to there
    awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) at = i; next }
        { print $at }' "$2"
}
last_columns() { # last_columns ROW FILE: what the row ends with, reference and errors
    sed -n "$1p" "$2" | rev | cut -d, -f 1-14 | rev
}
errors_of() { # errors_of ROW FILE: rmse to mean_ratio
    last_columns "$1" "$2" | cut -d, -f 1-4
}
rows() { # rows DIR: how many jobs have a row
    [ -e "$1/runs.csv" ] || { echo 0 && return; }
    tail -n +2 "$1/runs.csv" | wc -l
}
# Without the columns that tell of time, and of snapshots only each job's last. Pictures by
# their difference from those in $base.
outcome() { # outcome DIR
    awk -F, '{ n = split($0, part, "\""); $0 = ""
          for (i = 1; i <= n; i++) { if (i % 2 == 0) gsub(",", ";", part[i]); $0 = $0 part[i] } }
        NR == 1 { for (i = 1; i <= NF; i++) skip[i] = $i ~ /^(seconds|memory)_/ }
        { for (i = 1; i <= NF; i++) if (!skip[i]) printf "%s,", $i; print "" }' "$1/runs.csv"
    awk -F, '{ last[$1] = $0 } END { for (job in last) print last[job] }' "$1/curves.csv" |
        cut -d, -f 1,4- | sort
    (cd "$1/images" && for job in *.exr; do "$etalon" compare "$job" "$base/$job"; done)
    ls "$1/images"
}
