# awk -f student.awk -f race.awk CELLS CHOICES: how many times the error of the best single method that of
# the chosen one is at equal work, with and without the work of the pilots.
# CELLS: scene, method, mutations a pixel, seed, CPU seconds, relMSE without the worst 1 %,
# relMSE. CHOICES: seconds, scene, mpp, seed, chosen, share, predicted, "by pilots of X % ...".
BEGIN { FS = "," }

FILENAME == ARGV[1] {
    if ($2 ~ /\+/) next
    k = $1 SUBSEP $2
    n[k]++; cpu[k] += $5; error[k] += $6
    next
}

{
    key = $1
    if (!(($2, "bdpt") in n)) next
    best = 0
    split("pt bdpt pssmlt mmlt", methods, " ")
    for (i in methods) {
        k = $2 SUBSEP methods[i]
        if (!(k in n)) continue
        e = n[k] ^ 2 / (cpu[k] * error[k])
        efficiency[methods[i]] = e
        if (e > best) best = e
    }
    pilots = 0
    if (match($0, /by pilots of [0-9.]+ %/)) pilots = substr($0, RSTART + 13, RLENGTH - 15) / 100
    ratio = best / efficiency[$5]
    if (!(key in runs)) budgets[++budget_count] = key
    runs[key]++
    choice[key] += log(ratio)
    whole[key] += log(ratio / (1 - pilots))
    square[key] += log(ratio / (1 - pilots)) ^ 2
    bdpt[key] += log(best / efficiency["bdpt"])
    pssmlt[key] += log(efficiency["pssmlt"] / efficiency[$5] / (1 - pilots))
    share[key] += pilots
    within[key] += ratio / (1 - pilots) <= 1.1
    if (ratio > worst[key]) { worst[key] = ratio; name[key] = $2 }
    if (!((key, $2) in row)) { order[key, ++scenes[key]] = $2 }
    row[key, $2] = row[key, $2] " " $5
    mean[key, $2] += log(ratio / (1 - pilots)); count[key, $2]++
}

END {
    print "| seconds | runs | choice | with pilots | 95 % | within 1.10 | worst | pilots | always bdpt | to pssmlt |"
    print "|---|---|---|---|---|---|---|---|---|---|"
    for (b = 1; b <= budget_count; b++) {
        key = budgets[b]; r = runs[key]
        # Scenes are the independent units.
        sum = squares = 0
        for (i = 1; i <= scenes[key]; i++) {
            x = mean[key, order[key, i]] / count[key, order[key, i]]
            sum += x; squares += x * x
        }
        m = sum / scenes[key]
        h = half_width(scenes[key], sum, squares)
        printf "| %s | %d | %.3f | %.3f | %.2f to %.2f | %d | %.1f, %s | %.1f %% | %.3f | %.2f |\n",
            key, r, exp(choice[key] / r), exp(whole[key] / r), exp(m - h), exp(m + h),
            within[key], worst[key], name[key], 100 * share[key] / r, exp(bdpt[key] / r),
            exp(pssmlt[key] / r)
    }
    for (b = 1; b <= budget_count; b++) {
        key = budgets[b]
        printf "\n%s s\n\n| scene | chosen | times the best, with pilots |\n|---|---|---|\n", key
        for (i = 1; i <= scenes[key]; i++) {
            s = order[key, i]
            printf "| %s |%s | %.2f |\n", s, row[key, s], exp(mean[key, s] / count[key, s])
        }
    }
}
