# From rows of runs.csv (columns as bench/zsolnai13_table1.sh names them, apart by tabs): the
# table of [Zsolnai13, Table 1] for our scenes, what each way to set p_l costs, and how well
# the rule `tours` predicts. A cell is a scene, an integrator and a budget; a way is a rule
# or a constant. csv=FILE: a row for each cell and way.
#
# The error of a run is its trimmed relMSE without the reference's noise, at equal time, as it
# falls as 1/t: times mutations, times what one takes. That is taken as linear in p_l, by
# least squares over all runs of the cell, since single CPU times are noisy on a machine that
# others use.
#
# Regret of a way: its error over that of the best constant. The best is chosen without one
# seed and taken on it, for each seed in turn (of one seed: chosen and taken on it); the
# regret is the geometric mean. The interval of a cell takes the logarithms of its errors as
# way + seed + noise, the noise alike for all ways (a randomised block design).
BEGIN {
    FS = "\t"
    way_count = split("zsolnai2013 tours 0.1 0.3 0.5", ways, " ")
    constant = 3 # the first that is one
    unit = 5
}

{
    budget_text = $3 > 0 ? $3 " s" : "mutations, of 2 to 9 CPU seconds a run"
    cell = $1 SUBSEP $2 SUBSEP budget_text
    way = $4 == "auto" ? $5 : $6 + 0
    run = cell SUBSEP way SUBSEP $7
    if (!(cell in seen)) { seen[cell] = 1; cells[++cell_count] = cell }
    if (!((cell, $7) in seen)) { seen[cell, $7] = 1; seeds[cell] = seeds[cell] " " $7 }
    error[run] = ($8 - $9) * $20 / ($3 > 0 ? $3 : unit)
    fit(cell, $6, $10 / $20)
    noise[cell] = $9
    p_l[run] = $6
    for (i = 0; i < 3; i++) add(cell SUBSEP "eta" i, $(11 + i))
    if ($4 == "auto") { add(cell SUBSEP "published", $14); add(cell SUBSEP way, $6) }
    if (way == "tours" && $15 > 0 && $8 > $9) {
        predicted[++predicted_count] = $15 / ($8 - $9)
        add("halves", $16 > 1.05)
    }
    if (way == "tours" && $17 ~ /[0-9] /)
        add(cell SUBSEP "tilt", log(curve("0.1") / curve("0.5")))
}

# The predicted error at equal work, of a row of the rule tours.
function curve(p,    at, count, x, y, c) {
    count = split($17, x, " ")
    split($18, y, " ")
    split($19, c, " ")
    for (at = 1; at < count && x[at] != p; at++) {}
    return y[at] * c[at]
}

# Sums for the line of y over x.
function fit(key, x, y) {
    fits[key]++
    sx[key] += x; sy[key] += y; sxx[key] += x * x; sxy[key] += x * y
}
function fitted(key, x,    k, d, slope) {
    k = fits[key]
    d = k * sxx[key] - sx[key]^2
    slope = d > 0 ? (k * sxy[key] - sx[key] * sy[key]) / d : 0
    return sy[key] / k + slope * (x - sx[key] / k)
}

function add(key, x,    d) { # running mean and sum of squares about it
    if (x !~ /^[-+0-9]/) return
    d = x - mean[key]
    mean[key] += d / ++n[key]
    squares[key] += d * (x - mean[key])
}
function se(key) { return n[key] > 1 ? sqrt(squares[key] / (n[key] - 1) / n[key]) : 0 }

# The 97.5 % point of Student's t, by its expansion about the normal one.
function student(d,    z) {
    z = 1.959964
    return z + (z^3 + z) / 4 / d + (5 * z^5 + 16 * z^3 + 3 * z) / 96 / d^2 \
        + (3 * z^7 + 19 * z^5 + 17 * z^3 - 15 * z) / 384 / d^3
}

# Seeds that have an error above the noise under every way: fills y[way, 1..]; their number.
function common(cell,    list, count, i, w, k, e, ok) {
    count = split(seeds[cell], list, " ")
    k = 0
    for (i = 1; i <= count; i++) {
        ok = 1
        for (w = 1; w <= way_count; w++) {
            e = error[cell, ways[w], list[i]]
            e *= fitted(cell, p_l[cell, ways[w], list[i]])
            ok = ok && e > 0
            if (e > 0) y[w, k + 1] = log(e)
        }
        k += ok
    }
    return k
}

# The constant that is lowest over the k seeds but one (0: over all).
function best_without(k, without,    w, i, sum, lowest, best) {
    best = 0
    for (w = constant; w <= way_count; w++) {
        sum = 0
        for (i = 1; i <= k; i++) sum += i == without ? 0 : exp(y[w, i])
        if (best == 0 || sum < lowest) { best = w; lowest = sum }
    }
    return best
}

function mean_log(w, k,    i, sum) {
    for (i = sum = 0; i < k; i++) sum += y[w, i + 1]
    return sum / k
}

# Half width of the 95 % interval of the log of a ratio of two ways.
function half_width(k,    w, i, sum, all, of_seed, d) {
    if (k < 2) return 0
    for (w = 1; w <= way_count; w++) all += mean_log(w, k) / way_count
    for (i = 1; i <= k; i++) {
        of_seed = 0
        for (w = 1; w <= way_count; w++) of_seed += y[w, i] / way_count
        for (w = 1; w <= way_count; w++) sum += (y[w, i] - mean_log(w, k) - of_seed + all)^2
    }
    d = (k - 1) * (way_count - 1)
    return student(d) * sqrt(2 * sum / d / k)
}

function log_regret(w, k,    i, sum) {
    for (i = 1; i <= k; i++) sum += y[w, i] - y[best_without(k, k > 1 ? i : 0), i]
    return sum / k
}

function shown(key, format,    e) {
    e = se(key)
    return n[key] == 0 ? "?" : sprintf(format, mean[key]) (e > 0 ? sprintf(" +- %.1g", e) : "")
}

function table_row(cell, k,    part, w, g, best, width) {
    split(cell, part, SUBSEP)
    printf "| %s | %s | %s | %s | %s | %.3g | %s | %s |", part[1], part[2],
        shown(cell SUBSEP "eta0", "%.3f"), shown(cell SUBSEP "eta1", "%.3f"),
        shown(cell SUBSEP "eta2", "%.3f"),
        (mean[cell, "eta2"] > 0 ? mean[cell, "eta0"] / mean[cell, "eta2"] : 0),
        shown(cell SUBSEP "published", "%.2f"), shown(cell SUBSEP "tours", "%.2f")
    if (k == 0) { print " ? | ? | ? | ? | ? | ? | ? | 0 |"; unresolved++; return }
    best = best_without(k, 0)
    width = half_width(k)
    printf " %s |", ways[best]
    for (w = 1; w <= way_count; w++) {
        g = log_regret(w, k)
        printf (w < constant && g > log(1.1) ? " **%.2f** |" : " %.2f |"), exp(g)
        tell(part[3] SUBSEP part[2] SUBSEP w, w, k, g, best, part[1])
        tell(part[3] SUBSEP "all" SUBSEP w, w, k, g, best, part[1] ", " part[2])
        if (csv) csv_row(cell, w, k, g, width)
    }
    print (k > 1 ? sprintf(" %.2f | ", exp(width)) : " ? | ") k " |"
    if (n[cell, "tilt"]) {
        tilt[++tilts] = mean[cell, "tilt"]
        tilt_true[tilts] = mean_log(constant, k) - mean_log(way_count, k)
    }
}

# What a cell adds to the summary of `key`.
function tell(key, w, k, g, best, name) {
    add("regret" SUBSEP key, g)
    add("naive" SUBSEP key, mean_log(w, k) - mean_log(best, k))
    add("tours" SUBSEP key, mean_log(2, k) - mean_log(w, k))
    if (key in worst && g <= worst[key]) return
    worst[key] = g
    worst_name[key] = name
}

function csv_row(cell, w, k, g, width,    part, i, list, text) {
    split(cell, part, SUBSEP)
    for (i = 1; i <= k; i++) text = text (i > 1 ? " " : "") sprintf("%.4g", exp(y[w, i]))
    printf "%s,%s,\"%s\",%s,%s,%.4g,%d,%s,%.4g,%s\n", part[1], part[2], part[3], ways[w],
        (w < constant ? sprintf("%.4g", mean[cell, ways[w]]) : ways[w]), noise[cell], k, text,
        exp(g), (k > 1 ? sprintf("%.4g,%.4g", exp(g - width), exp(g + width)) : ".nan,.nan") > csv
}

function interval(key,    h) {
    h = n[key] > 1 ? student(n[key] - 1) * se(key) : 0
    return sprintf("%.3f [%.3f, %.3f]", exp(mean[key]), exp(mean[key] - h), exp(mean[key] + h))
}

function summary(budget, integrator,    w, key) {
    if (!n["regret", budget, integrator, 1]) return
    printf "\n%s, %d cells\n\n", integrator, n["regret", budget, integrator, 1]
    printf "| way | geometric mean of regret | best constant chosen on all seeds "
    print "| worst cell | error of tours over its own |"
    print "|---|---|---|---|---|"
    for (w = 1; w <= way_count; w++) {
        key = budget SUBSEP integrator SUBSEP w
        printf "| %s | %s | %.3f | %.2f, %s | %s |\n", ways[w], interval("regret" SUBSEP key),
            exp(mean["naive", key]), exp(worst[key]), worst_name[key],
            (w == 2 ? "1" : interval("tours" SUBSEP key))
    }
}

function correlation(x, y, count,    i, mx, my, xx, yy, xy) {
    for (i = 1; i <= count; i++) { mx += x[i] / count; my += y[i] / count }
    for (i = 1; i <= count; i++) {
        xx += (x[i] - mx)^2
        yy += (y[i] - my)^2
        xy += (x[i] - mx) * (y[i] - my)
    }
    return xx * yy > 0 ? xy / sqrt(xx * yy) : 0
}

function prediction(    part, count) {
    count = predicted_count
    if (count == 0) return
    sort(predicted, count)
    printf "\nPredicted relMSE over measured, %d runs under tours: median %.2f, middle half ", count,
        predicted[int((count + 1) / 2)]
    printf "%.2f to %.2f, ", predicted[int(count / 4) + 1], predicted[int(3 * count / 4) + 1]
    printf "middle nine tenths %.2f to %.2f.\n", predicted[int(count / 20) + 1],
        predicted[int(19 * count / 20) + 1]
    printf "Halves of the chains disagreed by more than 5 %% in %.0f %% of them.\n",
        100 * mean["halves"]
    printf "Error at 0.1 over that at 0.5, predicted and measured: correlation of the "
    printf "logarithms over %d cells %.2f.\n", tilts, correlation(tilt, tilt_true, tilts)
}

function sort(a, count,    i, j, x) {
    for (i = 2; i <= count; i++) {
        x = a[i]
        for (j = i - 1; j > 0 && a[j] > x; j--) a[j + 1] = a[j]
        a[j + 1] = x
    }
}

END {
    if (csv) {
        printf "scene,integrator,budget,way,p_l,reference_relmse_trimmed," > csv
        print "seeds,errors,regret,regret_lo,regret_hi" > csv
    }
    for (i = 1; i <= cell_count; i++) {
        split(cells[i], part, SUBSEP)
        if (!(part[3] in budgets)) { budgets[part[3]] = 1; budget[++budget_count] = part[3] }
    }
    for (b = 1; b <= budget_count; b++) {
        unresolved = 0
        printf "%sBudget: %s\n\n", (b > 1 ? "\n" : ""), budget[b]
        printf "| scene | integrator | eta_l | eta_s | eta_0 | r | p_l, zsolnai2013 | p_l, tours "
        printf "| best constant | regret: zsolnai2013 | tours | 0.1 | 0.3 | 0.5 | times or over "
        print "| seeds |"
        print "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|"
        for (i = 1; i <= cell_count; i++) {
            split(cells[i], part, SUBSEP)
            if (part[3] == budget[b]) table_row(cells[i], common(cells[i]))
        }
        if (unresolved)
            printf "\n%d cells are not above the noise of their reference.\n", unresolved
        split("all pssmlt mmlt pfmlt", integrators, " ")
        for (i = 1; i <= 4; i++) summary(budget[b], integrators[i])
    }
    print "\nIn brackets: 95 % over cells."
    prediction()
}
