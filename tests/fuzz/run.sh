#!/usr/bin/env bash
# run.sh BUILD READER...: each reader's fuzzer for FUZZ_SECONDS (600), one after another,
# then one line each: executions, what was found, memory, edges of the code reached. What
# was found lies in BUILD/found, and is status 1; the log in BUILD/log. The corpus stays in
# BUILD/corpus and grows from run to run.
set -u
cd "$(dirname "$0")/../.." || exit 1

build=$1
shift
seconds=${FUZZ_SECONDS:-600}
shared=../shared/scenes
TEST_TMP=$(mktemp -d -p "$([ -w /dev/shm ] && echo /dev/shm || echo "${TMPDIR:-/tmp}")")
export TEST_TMP
trap 'rm -rf "$TEST_TMP"' EXIT
mkdir -p "$build"/{found,log,dict,corpus,seeds}
shopt -s nullglob

# Where a reader's words stand in the source: its dictionary is made of them.
sources() {
    case $1 in
    pbrt) echo src/import/{pbrt/*,spectrum}.c ;;
    mitsuba) echo src/import/mitsuba/*.c ;;
    yaml) echo src/import/yaml/*.c src/lab/{experiment,axes}.c \
        src/settings/*.c src/integrator/registry.c src/surface/bsdf*.c ;;
    ply) echo src/import/mesh/*ply*.c ;;
    obj) echo src/import/mesh/import_obj.c ;;
    esac
}

dictionary() {
    local files
    files=$(sources "$1")
    cat tests/fuzz/words.dict
    [ -z "$files" ] || grep -ohE '"[A-Za-z_<][A-Za-z0-9_.<>]{0,30}"' $files | sort -u
}

# Small files of other folders are used in place.
seeds() {
    local to=$build/seeds/$1 file n=0
    rm -rf "$to"
    mkdir -p "$to"
    link() {
        n=$((n + 1))
        ln -s "$(realpath "$1")" "$to/$n-$(basename "$1")"
    }
    for file in tests/fuzz/seeds/"$1"/*; do link "$file"; done
    find_small() {
        find "$@" -type f -size -"$((max_len / 1024))"k 2>/dev/null | sort
    }
    case $1 in
    pbrt) find_small "$shared" -name '*.pbrt' -o -name '*.lx[som]' ;;
    mitsuba) find_small "$shared" -name '*.xml' ;;
    yaml) find_small scenes config -name '*.yaml' ;;
    ply) find_small "$shared" -name '*.ply' ;;
    obj) find_small "$shared" -name '*.obj' ;;
    exr) find_small tests/data/exr -name '*.exr' ;;
    esac | while read -r file; do link "$file"; done
}

# The clock runs on where others use the processors: a hang is what takes 5 s of its own.
sort_out_slow() {
    local file
    for file in "$build/found/$reader-timeout-"*; do
        (ulimit -t 5 && "$build/fuzz/$reader" -timeout=600 "$file") >/dev/null 2>&1 &&
            mv "$file" "${file/-timeout-/-slow-}"
    done
}

found() {
    find "$build/found" -name "$reader-$1-*" -newer "$build/log/$reader.begin" | wc -l
}

# A find ends libFuzzer, so it is begun again until the time is over.
fuzz() {
    local begin=$SECONDS left log=$build/log/$reader
    : >"$log"
    touch "$log.begin"
    while left=$((seconds - (SECONDS - begin))) && [ $left -gt 0 ]; do
        "$build/fuzz/$reader" -max_total_time=$left -timeout=5 -rss_limit_mb=2048 \
            -max_len=$max_len -dict="$build/dict/$reader" -print_final_stats=1 \
            -artifact_prefix="$build/found/$reader-" "$build/corpus/$reader" \
            "$build/seeds/$reader" >>"$log" 2>&1 && break
        [ "$(grep -c 'stat::number_of_exec' "$log")" -lt 100 ] || break
    done
    spent=$((SECONDS - begin))
    sort_out_slow
}

# The sum or the largest of a statistic over all beginnings.
total() {
    awk -v name="$1" '$1 == "stat::" name ":" { sum += $2; most = $2 > most ? $2 : most }
        END { print name == "peak_rss_mb" ? most + 0 : sum + 0 }' "$build/log/$reader"
}

status=0
form='%-10s %10s %5s %7s %6s %5s %5s %5s %7s %6s\n'
report=$(printf "$form" reader executions s crashes hangs leaks oom slow rss_MB edges)
for reader; do
    max_len=8192
    [ "$reader" = serialized ] && max_len=2048
    mkdir -p "$build/corpus/$reader"
    dictionary "$reader" >"$build/dict/$reader"
    seeds "$reader"
    fuzz
    edges=$(grep -oE ' cov: [0-9]+' "$build/log/$reader" | awk '{ n = $2 > n ? $2 : n }
        END { print n + 0 }')
    executions=$(total number_of_executed_units)
    finds=("$(found crash)" "$(found timeout)" "$(found leak)" "$(found oom)")
    line=$(printf "$form" "$reader" "$executions" "$spent" "${finds[@]}" \
        "$(found slow)" "$(total peak_rss_mb)" "$edges")
    echo "$line"
    report+=$'\n'$line
    [ "$executions" -gt 0 ] && [ "${finds[*]}" = "0 0 0 0" ] || status=1
done
echo "$report"
exit $status
