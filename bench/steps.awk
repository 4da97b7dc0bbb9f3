# The best width of small steps, from runs with widths times each of some factors
# (bench/p_curve.sh, WHAT="steps steps_table"): awk -f steps.awk SIZES STEPS.
#
# SIZES has lines "scene WIDTHxHEIGHT". Error times CPU seconds is fitted by a parabola in
# the logarithm of the factor, to the logarithms of all runs of a cell. Widths are told as
# the largest step of the exponential kernel, in pixels: factor / 64 sqrt(width height).
BEGIN { FS = "[, ]"; ways = split("2 3 4 5 6 8", pixels, " ") }
FILENAME == ARGV[1] { split($2, side, "x"); root[$1] = sqrt(side[1] * side[2]); next }
{
    cell = $1 SUBSEP $2
    if (!(cell in runs)) cells[++cell_count] = cell
    k = ++runs[cell]
    x[cell, k] = log($5); y[cell, k] = log($6 * $8)
}

# Least squares of a parabola: c[0], c[1], c[2].
function fit(cell,    i, j, k, g) {
    split("", A)
    for (k = 1; k <= runs[cell]; k++)
        for (i = 0; i < 3; i++) {
            for (j = 0; j < 3; j++) A[i, j] += x[cell, k]^(i + j)
            A[i, 3] += y[cell, k] * x[cell, k]^i
        }
    for (i = 0; i < 3; i++) {
        g = A[i, i]
        for (j = 0; j <= 3; j++) A[i, j] /= g
        for (k = 0; k < 3; k++) {
            if (k == i) continue
            g = A[k, i]
            for (j = 0; j <= 3; j++) A[k, j] -= g * A[i, j]
        }
    }
    for (i = 0; i < 3; i++) c[i] = A[i, 3]
}

function value(factor) { return c[0] + log(factor) * (c[1] + log(factor) * c[2]) }

# The factor of a width in pixels, within the limits of the default.
function factor_of(width, scene,    f) {
    f = 64 * width / root[scene]
    return f < 0.25 ? 0.25 : f > 8 ? 8 : f
}

function add(which, way, gain, loss) {
    n[which, way]++
    gains[which, way] += gain
    losses[which, way] += loss
    if (n[which, way] == 1 || loss > worst[which, way]) worst[which, way] = loss
}

END {
    print "| scene | integrator | width x height | 1/2 | 1 | 2 | 4 | 8 times 1/64 | best width, pixels | error at 4 pixels over that at 1/64 | over the least |"
    print "|---|---|---|---|---|---|---|---|---|---|---|"
    for (i_cell = 1; i_cell <= cell_count; i_cell++) {
        split(cells[i_cell], part, SUBSEP)
        fit(cells[i_cell])
        least = 1e9
        for (f = 0.5; f <= 8.01; f *= 1.05)
            if (value(f) < least) { least = value(f); best = f }
        printf "| %s | %s | %.0f |", part[1], part[2], root[part[1]]^2
        for (f = 0.5; f <= 8; f *= 2) printf " %.2f |", exp(value(f) - value(1))
        printf " %s%.1f |", (best < 0.51 ? "< " : best > 7.7 ? "> " : ""), best / 64 * root[part[1]]
        v = value(factor_of(4, part[1]))
        printf " %.2f | %.2f |\n", exp(v - value(1)), exp(v - least)
        add(part[2], 0, 0, value(1) - least)
        for (w = 1; w <= ways; w++) {
            v = value(factor_of(pixels[w], part[1]))
            add(part[2], w, v - value(1), v - least)
        }
    }
    printf "\n| error over the least, geometric mean (worst) | 1/64 |"
    for (w = 1; w <= ways; w++) printf " %d pixels |", pixels[w]
    printf "\n|---|---|---|---|---|---|---|---|\n"
    split("pssmlt mmlt pfmlt", names, " ")
    for (i = 1; i <= 3; i++) {
        if (!n[names[i], 0]) continue
        printf "| %s, %d cells |", names[i], n[names[i], 0]
        for (w = 0; w <= ways; w++)
            printf " %.3f (%.2f) |", exp(losses[names[i], w] / n[names[i], w]), exp(worst[names[i], w])
        printf "\n| the same, over that at 1/64 | 1 |"
        for (w = 1; w <= ways; w++) printf " %.3f |", exp(gains[names[i], w] / n[names[i], w])
        print ""
    }
}
