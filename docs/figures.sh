#!/usr/bin/env bash
# The figures of README.md from the results of `make demo`, which must have run before:
#
#   errors.svg    results/demo/errors.svg: error against time
#   p_l.svg       small steps, large steps, and error against p_l from results/demo/values.dat
#
# The first two panels of p_l.svg are a sketch: Metropolis sampling of a made-up density of
# three spots in the unit square. The third is measured.
set -euo pipefail
cd "$(dirname "$0")/.."
export LC_ALL=C
demo=results/demo
for file in errors.svg values.dat; do
    [ -e "$demo/$file" ] || { echo "there is no $demo/$file; run 'make demo' first" >&2 && exit 1; }
done
tmp=$(mktemp -d)
trap 'rm -rf "$tmp"' EXIT

# walk P_L MUTATIONS: proposals as "x y accepted".
walk() {
    awk -v p_l="$1" -v count="$2" '
        function uniform() { state = (state * 16807) % 2147483647; return state / 2147483647 }
        function spot(x, y, cx, cy, r) { return exp(-((x - cx) ^ 2 + (y - cy) ^ 2) / (2 * r * r)) }
        function density(x, y) {
            if (x < 0 || x > 1 || y < 0 || y > 1) return 0
            return spot(x, y, .28, .32, .09) + spot(x, y, .72, .7, .08) + spot(x, y, .2, .8, .05)
        }
        function step() { return (uniform() < .5 ? -1 : 1) * .06 * exp(-log(16) * uniform()) }
        BEGIN {
            state = 12345; x = .3; y = .3
            for (i = 0; i < count; i++) {
                large = uniform() < p_l
                nx = large ? uniform() : x + step()
                ny = large ? uniform() : y + step()
                accepted = uniform() * density(x, y) < density(nx, ny)
                if (nx >= 0 && nx <= 1 && ny >= 0 && ny <= 1) print nx, ny, accepted + 0
                if (accepted) { x = nx; y = ny }
            }
        }'
}
walk 0 250 >"$tmp/small.dat"
walk 1 250 >"$tmp/large.dat"
cp "$demo/errors.svg" docs/
gnuplot -e "tmp='$tmp'; values='$demo/values.dat'; out='docs/p_l.svg'" docs/plot_p_l.gp
