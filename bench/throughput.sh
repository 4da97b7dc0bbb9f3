#!/usr/bin/env bash
# make bench-throughput: mutations per CPU second, and the share of what bare Embree makes of
# the same rays, of mmlt and pssmlt on real scenes; beside them, in turn with them, those of
# the last commit in results/throughput.csv, of which it builds bench/speed. A row that has
# fallen by more than 5 % is a warning, and the script ends with 1. The rows of a clean tree
# are appended to that table.
#
# ROWS="living-room/pssmlt ..." some of them only; SECONDS_EACH=5 of a turn, TURNS=3;
# THREADS=1; PREVIOUS=COMMIT another commit to compare with, or "none".
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C
trap 'exit 130' INT

speed=${SPEED:-build/release/bench/speed}
table=${TABLE:-results/throughput.csv}
header=commit,scene,integrator,size,max_depth,threads,million_mutations_per_cpu_second
header+=,bare_embree_million_mutations,share_of_bare_embree,previous,ratio
shared=../shared/scenes
threads=${THREADS:-1} turns=${TURNS:-3} seconds=${SECONDS_EACH:-5}

# name, file, size, edges
scenes="cornell scenes/cornell/scene.yaml 256x256 6
peer-box $shared/peer-box/diffuse.pbrt 256x256 6
coffee $shared/coffee-pbrt3/scene.pbrt 240x300 12
veach-ajar $shared/veach-ajar-mitsuba/scene.xml 320x180 12
living-room $shared/living-room-pbrt3/scene.pbrt 240x135 12
bathroom $shared/contemporary-bathroom-pbrt3/contemporary-bathroom.pbrt 320x180 12"

commit=$(git rev-parse --short=10 HEAD)
clean=yes
[ -z "$(git status --porcelain --untracked-files=no)" ] || clean=no
previous=${PREVIOUS:-$([ -e "$table" ] && tail -n +2 "$table" | tail -n 1 | cut -d, -f1)}
previous=${previous:-none}

# bench/speed of a commit, built once.
build_previous() {
    local tree=build/throughput/$previous
    if [ ! -x "$tree/build/release/bench/speed" ]; then
        mkdir -p "$tree"
        git archive "$previous" | tar -xf - -C "$tree"
        make -s -C "$tree" build/release/bench/speed >&2
    fi
    echo "$tree/build/release/bench/speed"
}

# measure PROGRAM FILE SETTING...: speed, bare, share
measure() {
    local program=$1 file=$2
    shift 2
    "$program" "$file" "$seconds" "$@" | awk '
        /^million_mutations_per_cpu_second/ { speed = $2 }
        /^bare_embree_million_mutations/ { bare = $2 }
        /^share_of_bare_embree/ { share = $2 }
        END { print speed, bare, share }'
}

median() {
    sort -g | awk '{ x[NR] = $1 } END { print x[int((NR + 1) / 2)] }'
}

before=
if [ "$previous" != none ]; then before=$(build_previous); fi
[ -e "$table" ] || echo "$header" >"$table"
fallen=0
printf '%-12s %-7s %10s %8s %6s  %s\n' scene "" "M/CPU s" bare share "against $previous"
while read -r name file size depth; do
    [ -e "$file" ] || { echo "$name: there is no $file" && continue; }
    for integrator in mmlt pssmlt; do
        [[ " ${ROWS:-$name/$integrator} " == *" $name/$integrator "* ]] || continue
        settings=("threads=$threads" "size=$size" "max_depth=$depth"
            "integrator=$integrator" large_step_probability=.3)
        ours=() ratios=()
        for ((turn = 0; turn < turns; turn++)); do
            theirs=
            [ -z "$before" ] || theirs=$(measure "$before" "$file" "${settings[@]}")
            ours+=("$(measure "$speed" "$file" "${settings[@]}")")
            [ -z "$theirs" ] ||
                ratios+=("$(awk -v a="${ours[-1]%% *}" -v b="${theirs%% *}" \
                    'BEGIN { printf "%.3f", a / b }')")
        done
        x=$(printf '%s\n' "${ours[@]}" | cut -d' ' -f1 | median)
        bare=$(printf '%s\n' "${ours[@]}" | cut -d' ' -f2 | median)
        share=$(printf '%s\n' "${ours[@]}" | cut -d' ' -f3 | median)
        ratio=
        [ ${#ratios[@]} = 0 ] || ratio=$(printf '%s\n' "${ratios[@]}" | median)
        note=
        if [ -n "$ratio" ] && awk -v r="$ratio" 'BEGIN { exit !(r < .95) }'; then
            note=" WARNING: it has fallen by more than 5 %"
            fallen=1
        fi
        printf '%-12s %-7s %10s %8s %6s  %s%s\n' "$name" "$integrator" "$x" "$bare" "$share" \
            "${ratios[*]:-}" "$note"
        [ $clean = no ] ||
            echo "$commit,$name,$integrator,$size,$depth,$threads,$x,$bare,$share,$previous,$ratio" \
                >>"$table"
    done
done <<<"$scenes"
[ $clean = yes ] || echo "The tree has changes that are not committed: $table is left as it is."
exit $fallen
