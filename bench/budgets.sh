#!/usr/bin/env bash
# How far runs go beyond --seconds: every scene of ../shared/scenes that loads, 64 edges,
# one thread. Overshoot is that of the run's own clock, which loading and writing are not
# part of; at most 5 % of the budget or 0.2 s.
# make bench-budgets, or bench/budgets.sh INTEGRATOR..., with SECONDS_LIST="2 4".
set -u
[ $# -gt 0 ] || set -- pt bdpt
cd "$(dirname "$0")/.." || exit 1
etalon=${ETALON:-build/release/etalon}
scenes=${SHARED:-../shared}/scenes
[ -d "$scenes" ] || { echo "skipped: no $scenes"; exit 77; }
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
late=0
printf '%-28s %-6s %7s %9s %9s %9s  %s\n' scene with budget seconds passes unsampled load
for scene in "$scenes"/{coffee,living-room,cornell-box}-pbrt3/scene.pbrt \
    "$scenes"/{breakfast,contemporary-bathroom,buddha-fractal}-pbrt3/*[a-z].pbrt \
    "$scenes"/{staircase,killeroos}-pbrt4/*.pbrt "$scenes"/peer-box/*.xml \
    "$scenes"/veach-{ajar,bidir,mis}-mitsuba/scene.xml "$scenes"/torus-dpt/*.xml \
    "$scenes"/lux-luxtime/luxtime.lxs; do
    case ${scene##*/} in geometry.pbrt | materials.pbrt) continue ;; esac
    name=$(basename "$(dirname "$scene")")/$(basename "$scene")
    "$etalon" info "$scene" >"$out/info" 2>"$out/err" ||
        { echo "$name: not loaded: $(head -c 100 "$out/err")"; continue; }
    for integrator in "$@"; do
        for budget in ${SECONDS_LIST:-2 4}; do
            load=$(cut -d' ' -f1 /proc/loadavg)
            "$etalon" render "$scene" -i "$integrator" --max-depth 64 --threads 1 \
                --seconds "$budget" -o "$out/o.exr" --stats "$out/o.yaml" \
                >/dev/null 2>"$out/err" || { echo "$name: $(cat "$out/err")"; continue; }
            took=$(awk '/^seconds_total:/ { print $2 }' "$out/o.yaml")
            awk -v n="${name:0:28}" -v i="$integrator" -v b="$budget" -v l="$load" '
                { v[$1] = $2 }
                END { t = v["seconds_total:"]; over = t - b
                      printf "%-28s %-6s %7g %9.4f %9.3f %9.3g  %s%s\n", n, i, b, t,
                          v["mutations_per_pixel:"], v["unsampled_share:"], l,
                          (over > .05 * b && over > .2) ? "  LATE" : "" }' "$out/o.yaml"
            awk -v t="$took" -v b="$budget" 'BEGIN { exit !(t - b > .05 * b && t - b > .2) }' &&
                late=$((late + 1))
        done
    done
done
echo "$late late"
[ "$late" -eq 0 ]
