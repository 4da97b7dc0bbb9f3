# awk [-v column=7] -f student.awk -f race.awk CELLS REGRETS CHOICES: how many times the error of the
# best single method auto has at equal work, its pilots counted.
# CELLS: scene, method, mutations a pixel, seed, CPU seconds, relMSE without the worst 1 %,
# relMSE; column tells which error. Means over seeds; errors in inverse proportion to time.
# The film sampling of auto's pt and bdpt is adaptive where CELLS has such rows.
# REGRETS: scene, method, error by the automatic p_l over that by the best one.
# CHOICES: seconds, scene, mpp, seed, chosen, share, predicted, "by pilots of X % ...".
BEGIN {
    FS = ","
    if (!column) column = 6
    method_count = split("pt bdpt pssmlt mmlt pfmlt", methods, " ")
    adaptive = "-film_sampling-adaptive"
}

FILENAME == ARGV[1] { k = $1 SUBSEP $2; n[k]++; cpu[k] += $5; error[k] += $column; next }
FILENAME == ARGV[2] { regret[$1, $2] = $3; next }

# Error times time.
function cost(scene, method,    k) {
    k = scene SUBSEP method
    return n[k] ? cpu[k] * error[k] / n[k] ^ 2 : 0
}
function chosen_cost(scene, method) {
    return n[scene, method adaptive] ? cost(scene, method adaptive) : cost(scene, method)
}
# The least of all methods, with the best p_l of each if manual.
function best(scene, manual,    i, c, least) {
    least = 1e300
    for (i = 1; i <= method_count; i++) {
        c = cost(scene, methods[i])
        if (manual && (scene, methods[i]) in regret) c /= regret[scene, methods[i]]
        if (c > 0 && c < least) { least = c; winner = methods[i] }
    }
    return least
}
function add(name, key, scene, x) { of_scene[name, key, scene] += x }

{
    key = $1
    if (!n[$2, "bdpt"]) next
    pilots = 0
    if (match($0, /by pilots of [0-9.]+ %/)) pilots = substr($0, RSTART + 13, RLENGTH - 15) / 100
    c = chosen_cost($2, $5) / (1 - pilots)
    ratio = c / best($2, 0)
    if (!(key in runs)) budgets[++budget_count] = key
    if (!((key, $2) in count)) order[key, ++scenes[key]] = $2
    runs[key]++; count[key, $2]++
    add("choice", key, $2, log(cost($2, $5) / best($2, 0)))
    add("auto", key, $2, log(ratio))
    add("manual", key, $2, log(c / best($2, 1)))
    add("bdpt", key, $2, log(c / cost($2, "bdpt")))
    if (n[$2, "pssmlt"]) add("pssmlt", key, $2, log(c / cost($2, "pssmlt")))
    else lacking[key, $2] = 1
    share[key] += pilots
    within[key] += ratio <= 1.1
    if (ratio > worst[key]) { worst[key] = ratio; name[key] = $2 }
    took[key, $2, $5]++
    if ($7 > 0) insert(key, $7 / (cost($2, $5) / (key * (1 - pilots))))
}

# Keeps what is predicted over what is measured sorted.
function insert(key, x,    i) {
    for (i = ++predictions[key]; i > 1 && predicted[key, i - 1] > x; i--)
        predicted[key, i] = predicted[key, i - 1]
    predicted[key, i] = x
}

# Geometric mean over scenes, all of which have as many runs, and its 95 % interval; over pssmlt of the
# scenes where that was measured.
function interval(what, key,    i, m, x, s, s2, h) {
    for (i = 1; i <= scenes[key]; i++) {
        if (what == "pssmlt" && lacking[key, order[key, i]]) continue
        x = of_scene[what, key, order[key, i]] / count[key, order[key, i]]
        s += x; s2 += x * x; m++
    }
    h = half_width(m, s, s2)
    return sprintf("%.3f [%.2f, %.2f]", exp(s / m), exp(s / m - h), exp(s / m + h))
}
function choices(key, scene,    i, text) {
    for (i = 1; i <= method_count; i++)
        if (took[key, scene, methods[i]])
            text = text (text ? ", " : "") methods[i] " " took[key, scene, methods[i]]
    return text
}

END {
    print "| seconds | runs | choice alone | auto over the best | over the best with its best p_l | within 1.10 | worst | pilots | over bdpt | over pssmlt |"
    print "|---|---|---|---|---|---|---|---|---|---|"
    for (b = 1; b <= budget_count; b++) {
        key = budgets[b]; r = runs[key]
        printf "| %s | %d | %s | %s | %s | %.0f %% | %.2f, %s | %.1f %% | %s | %s |\n",
            key, r, interval("choice", key), interval("auto", key), interval("manual", key),
            100 * within[key] / r, worst[key], name[key], 100 * share[key] / r,
            interval("bdpt", key), interval("pssmlt", key)
    }
    for (b = 1; b <= budget_count; b++) {
        key = budgets[b]; r = predictions[key]
        printf "\n%s s: predicted error of the chosen over what it is, median %.2f, middle nine tenths %.2f to %.2f.\n",
            key, predicted[key, int((r + 1) / 2)], predicted[key, int(r / 20) + 1], predicted[key, int(19 * r / 20) + 1]
    }
    print "\nError at 5 CPU s; others over the best.\n"
    printf "| scene | best | relMSE | pt | bdpt | pssmlt | mmlt | pfmlt |"
    for (b = 1; b <= budget_count; b++) printf " %s s: chosen | auto over the best |", budgets[b]
    printf "\n|---|---|---|---|---|---|---|---|"
    for (b = 1; b <= budget_count; b++) printf "---|---|"
    print ""
    for (i = 1; i <= scenes[budgets[1]]; i++) {
        s = order[budgets[1], i]
        least = best(s, 0)
        printf "| %s | %s | %.3g |", s, winner, least / 5
        for (m = 1; m <= method_count; m++) {
            c = cost(s, methods[m])
            printf (c ? " %.2f |" : " |"), c / least
        }
        for (b = 1; b <= budget_count; b++) {
            key = budgets[b]
            printf " %s | %.2f |", choices(key, s), exp(of_scene["auto", key, s] / count[key, s])
        }
        print ""
    }
}
