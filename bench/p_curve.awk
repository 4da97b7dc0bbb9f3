# From the measured curves and the rule's starts (bench/p_curve.sh): regrets of the rule, of
# zsolnai2013 and of constants; awk -f student.awk -f p_curve.awk CURVES RULE.
#
# Error times cost of a mutation is fitted by a cubic in x = ln((p + .005) / (1.03 - p)) to
# the logarithms of all runs of a cell; the cost is a line in p, from CPU seconds of all runs
# less those of the bootstrap, 100000 large steps. A regret is the fit at p over its least
# value, both between the least and the greatest constant measured: p_l = 1 counts as .9.
# Its interval (95 %) is that of the difference of two values of the fit.
#
# The least value of a noisy fit is too low: if p^ is the best p of a fit to n seeds, p* the
# true one, and the curve a parabola about it, then the fit at p* lies above that at p^ by
# as much as the truth at p^ lies above that at p*, say k / n in the mean. So a regret comes
# out as R + k / n. The best p of one half of the seeds, judged by the other half, is beaten
# by p by R - 2 k / n. Twice the first and once the second make 3 R: the corrected regret.
BEGIN {
    FS = ","
    bootstrap = 1e5
    terms = 4
    way_count = split("tours zsolnai2013 0.1 0.3 0.5", ways, " ")
    for (way = 3; way <= way_count; way++) constant[way] = ways[way]
}

FILENAME == ARGV[1] {
    cell = $1 SUBSEP $2 SUBSEP $3
    if (!(cell in runs)) cells[++cell_count] = cell
    k = ++runs[cell]
    seed_half[cell, k] = $4 % 2
    halves_seen[cell, $4 % 2] = 1
    p[cell, k] = $5; error[cell, k] = $6
    # Least squares of cpu = (n + N) c0 + (n p + N) c1, each run with the weight 1/cpu^2.
    u = ($7 + bootstrap) / $8; v = ($7 * $5 + bootstrap) / $8
    uu[cell] += u * u; uv[cell] += u * v; vv[cell] += v * v; u1[cell] += u; v1[cell] += v
    next
}

{
    cell = $1 SUBSEP $2 SUBSEP $3
    k = ++starts[cell]
    chosen[cell, 1, k] = $5; chosen[cell, 2, k] = $6
    tapes[cell] += $7
    fallen[cell] += /not by predicted/
    level[cell, k] = predicted($10)
}

# The predicted error at .5.
function predicted(list,    x) { split(list, x, " "); return x[11] }

function x_of(p) { return log((p + 0.005) / (1.03 - p)) }
function clamp(p) { return p < 0.05 ? 0.05 : p > 0.9 ? 0.9 : p }

# Solves A c = b and inverts A (Gauss-Jordan), both of `terms` rows.
function invert(    i, j, k, g) {
    for (i = 1; i <= terms; i++) for (j = 1; j <= terms; j++) inverse[i, j] = i == j
    for (i = 1; i <= terms; i++) {
        g = A[i, i]
        for (j = 1; j <= terms; j++) { A[i, j] /= g; inverse[i, j] /= g }
        for (k = 1; k <= terms; k++) {
            if (k == i) continue
            g = A[k, i]
            for (j = 1; j <= terms; j++) {
                A[k, j] -= g * A[i, j]; inverse[k, j] -= g * inverse[i, j]
            }
        }
    }
}

function value(p,    i, sum, x) {
    x = x_of(clamp(p))
    for (i = terms; i >= 1; i--) sum = sum * x + c[i]
    return sum
}

# Fits a cubic to the runs of the cell whose seeds are in one half, or to all (half = -1):
# c, inverse, and the best p of it.
function fit_runs(cell, half,    d, c0, c1, k, i, j, x, row, q) {
    d = uu[cell] * vv[cell] - uv[cell]^2
    c0 = (u1[cell] * vv[cell] - v1[cell] * uv[cell]) / d
    c1 = (v1[cell] * uu[cell] - u1[cell] * uv[cell]) / d
    split("", A); split("", B)
    for (k = 1; k <= runs[cell]; k++) {
        if (half >= 0 && seed_half[cell, k] != half) continue
        q = error[cell, k] * (c0 + c1 * p[cell, k])
        height[k] = log(q > 1e-12 ? q : 1e-12)
        for (i = 1; i <= terms; i++) row[i] = x_of(p[cell, k])^(i - 1)
        for (i = 1; i <= terms; i++) {
            B[i] += row[i] * height[k]
            for (j = 1; j <= terms; j++) A[i, j] += row[i] * row[j]
        }
    }
    invert()
    for (i = 1; i <= terms; i++) {
        c[i] = 0
        for (j = 1; j <= terms; j++) c[i] += inverse[i, j] * B[j]
    }
    best = 0.5
    for (x = 0.05; x <= 0.9; x += 0.005) if (value(x) < value(best)) best = x
    cost_ratio = (c0 + 0.9 * c1) / (c0 + 0.1 * c1)
}

# Fits the cell's curve: that of all its runs, sd of the residuals, and the 10 % band; then
# ln regrets of the ways by one half of the seeds over the best p of the other.
function fit(cell,    k, x, degrees, h, way, other) {
    split("", crossed)
    for (h = 0; h < 2; h++) {
        if (!halves_seen[cell, 0] || !halves_seen[cell, 1]) break
        fit_runs(cell, 1 - h)
        other = best
        fit_runs(cell, h)
        for (way = 1; way <= way_count; way++)
            crossed[way] += 0.5 * (regret(cell, way) + value(best) - value(other))
    }
    fit_runs(cell, -1)
    sd = 0
    degrees = runs[cell] - terms
    for (k = 1; k <= runs[cell]; k++) sd += (height[k] - value(p[cell, k]))^2
    sd = sqrt(sd / degrees)
    t = t95(degrees)
    band_lo = band_hi = best
    for (x = best; x >= 0.05 && value(x) < value(best) + log(1.1); x -= 0.005) band_lo = x
    for (x = best; x <= 0.9 && value(x) < value(best) + log(1.1); x += 0.005) band_hi = x
    if (band_hi > 0.89) band_hi = 1
    if (band_lo < 0.06) band_lo = 0
}

# Half width of the interval of ln regret at p.
function regret_half_width(p,    i, j, d, sum) {
    for (i = 1; i <= terms; i++) d[i] = x_of(clamp(p))^(i - 1) - x_of(best)^(i - 1)
    for (i = 1; i <= terms; i++) for (j = 1; j <= terms; j++) sum += d[i] * inverse[i, j] * d[j]
    return t * sd * sqrt(sum > 0 ? sum : 0)
}

function add(key, x,    d) {
    d = x - mean[key]
    mean[key] += d / ++n[key]
    squares[key] += d * (x - mean[key])
}

# ln regret of a way in the present cell, the mean over seeds.
function regret(cell, way,    k, sum) {
    if (way in constant) return value(constant[way]) - value(best)
    for (k = 1; k <= starts[cell]; k++) sum += value(chosen[cell, way, k]) - value(best)
    return sum / starts[cell]
}

function mean_p(cell, way,    k, sum) {
    for (k = 1; k <= starts[cell]; k++) sum += log(chosen[cell, way, k])
    return exp(sum / starts[cell])
}
function spread_p(cell, way,    k, lo, hi) {
    lo = hi = chosen[cell, way, 1]
    for (k = 2; k <= starts[cell]; k++) {
        if (chosen[cell, way, k] < lo) lo = chosen[cell, way, k]
        if (chosen[cell, way, k] > hi) hi = chosen[cell, way, k]
    }
    return sprintf("%.2f-%.2f", lo, hi)
}

function cell_row(cell,    part, way, g, k, inside, key, label) {
    split(cell, part, SUBSEP)
    printf "| %s | %s | %s | %.0f | %.2f | %.2f to %.2f | %.2f | %s | %d of %d | %.2f |", part[1],
        part[2], part[3], tapes[cell] / starts[cell], best, band_lo, band_hi, cost_ratio,
        spread_p(cell, 1), fallen[cell], starts[cell], mean_p(cell, 2)
    label = part[1] ", " part[2]
    for (way = 1; way <= way_count; way++) {
        g = regret(cell, way)
        printf (way < 3 && g > log(1.1) ? " **%.2f**" : " %.2f"), exp(g)
        k = regret_half_width(way in constant ? constant[way] : mean_p(cell, way))
        printf " (%.2f) |", exp(k)
        for (i = 1; i <= 2; i++) {
            key = (i == 1 ? "all" : part[2]) SUBSEP way
            add(key, g)
            if (way in crossed) add("corrected" SUBSEP key, (2 * g + crossed[way]) / 3)
            if (!(key in worst) || g > worst[key]) { worst[key] = g; name[key] = label }
        }
    }
    for (k = 1; k <= starts[cell]; k++) {
        inside = chosen[cell, 1, k] >= band_lo && chosen[cell, 1, k] <= band_hi
        add("inside" SUBSEP "all", inside); add("inside" SUBSEP part[2], inside)
        inside = chosen[cell, 2, k] >= band_lo && chosen[cell, 2, k] <= band_hi
        add("inside2" SUBSEP "all", inside); add("inside2" SUBSEP part[2], inside)
        if (level[cell, k] > 0) ratio[++ratios] = level[cell, k] / measured(cell)
    }
    print ""
}

# Geometric mean of the measured errors at .5.
function measured(cell,    k, sum, count) {
    for (k = 1; k <= runs[cell]; k++)
        if (p[cell, k] == 0.5 && error[cell, k] > 0) { sum += log(error[cell, k]); count++ }
    return exp(sum / count)
}

function summary(which,    way, key) {
    if (!n[which, 1]) return
    printf "\n%s, %d cells; p_l in the measured 10 %% band: tours %.0f %%, zsolnai2013 %.0f %%\n\n",
        which, n[which, 1], 100 * mean["inside", which], 100 * mean["inside2", which]
    print "| way | geometric mean of regret | corrected | worst cell |\n|---|---|---|---|"
    for (way = 1; way <= way_count; way++) {
        key = which SUBSEP way
        printf "| %s | %s | %s | %.2f, %s |\n", ways[way], interval(key),
            n["corrected", key] == n[key] ? interval("corrected" SUBSEP key) : "not told",
            exp(worst[key]), name[key]
    }
}

# Geometric mean over cells, with its 95 % interval.
function interval(key,    h) {
    if (n[key] < 2) return "not told"
    h = half_width(n[key], 0, squares[key]) # of deviations from the mean
    return sprintf("%.3f [%.3f, %.3f]", exp(mean[key]), exp(mean[key] - h), exp(mean[key] + h))
}

END {
    print "| scene | integrator | mutations a pixel | start, a chain | best p_l | within 10 % | cost of .9 over .1 | p_l, tours | not by tours | p_l, zsolnai2013 | regret (times or over): tours | zsolnai2013 | 0.1 | 0.3 | 0.5 |"
    print "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
    for (i_cell = 1; i_cell <= cell_count; i_cell++) {
        if (!starts[cells[i_cell]]) continue
        fit(cells[i_cell])
        cell_row(cells[i_cell])
    }
    summary("all"); summary("pssmlt"); summary("mmlt"); summary("pfmlt")
    if (!ratios) exit
    for (i = 2; i <= ratios; i++) {
        x = ratio[i]
        for (j = i - 1; j > 0 && ratio[j] > x; j--) ratio[j + 1] = ratio[j]
        ratio[j + 1] = x
    }
    printf "\nPredicted relMSE at .5 over that measured there, without the worst 1 %% of pixels, "
    printf "%d starts: median %.2f, middle nine tenths %.2f to %.2f.\n", ratios,
        ratio[int((ratios + 1) / 2)], ratio[int(ratios / 20) + 1], ratio[int(19 * ratios / 20) + 1]
}
