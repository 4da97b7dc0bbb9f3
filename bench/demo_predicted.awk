# The error that the starts of the demo's runs by the rule tours predicted for every p_l.
# Input, apart by tabs: rule, p_l_source, p_l, predicted_p, predicted_relmse, predicted_cost
# of each run. Prints p_l and the geometric mean over the runs of the error at equal work
# (that of the chosen p_l); NaN for both if no run has a prediction (too few tours).
BEGIN {
    FS = OFS = "\t"
}

# Linear in p[] between the points.
function at(x, values,    i) {
    for (i = 2; i < n && p[i] < x; i++)
        ;
    return values[i - 1] + (values[i] - values[i - 1]) * (x - p[i - 1]) / (p[i] - p[i - 1])
}

$1 == "tours" && $2 == "auto" && $4 != "" {
    n = split($4, p, " ")
    split($5, relmse, " ")
    split($6, cost, " ")
    runs++
    for (i = 1; i <= n; i++)
        sum[i] += log(relmse[i] * cost[i] / at($3, cost))
}
END {
    if (!runs) print "NaN\tNaN"
    for (i = 1; i <= n; i++)
        print p[i], exp(sum[i] / runs)
}
