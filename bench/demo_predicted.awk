# The error that the starts of the demo's automatic runs predicted for every p_l. Input,
# apart by tabs: p_l_source, p_l, predicted_p, predicted_relmse, predicted_cost,
# p_l_zsolnai2013 of each run. Prints p_l and the geometric mean over the runs of the error
# at equal work (that of the chosen p_l), after two empty lines the published rule's p_l and
# the error there. NaN for both if no run has a prediction (too few tours).
BEGIN {
    FS = OFS = "\t"
}

# Linear in p[] between the points.
function at(x, values,    i) {
    for (i = 2; i < n && p[i] < x; i++)
        ;
    return values[i - 1] + (values[i] - values[i - 1]) * (x - p[i - 1]) / (p[i] - p[i - 1])
}

$1 == "auto" && $3 != "" {
    n = split($3, p, " ")
    split($4, relmse, " ")
    split($5, cost, " ")
    runs++
    published += $6
    for (i = 1; i <= n; i++)
        sum[i] += log(relmse[i] * cost[i] / at($2, cost))
}
END {
    if (!runs) {
        print "NaN\tNaN\n\n\nNaN\tNaN"
        exit
    }
    for (i = 1; i <= n; i++) {
        sum[i] /= runs
        print p[i], exp(sum[i])
    }
    print "\n"
    print published / runs, exp(at(published / runs, sum))
}
