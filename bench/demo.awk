# Error of each p_l from the runs of config/demo.yaml. Input, apart by tabs: first the runs
# (job, p_l_source, p_l, seed, rule), then their curves (job, cpu_s, relmse_trimmed). The
# name of a run is "auto" by the rule tours, "published" by zsolnai2013, else its p_l.
#
# All errors are read at the same CPU time: a curve is interpolated linearly in log-log
# between its snapshots. Means over seeds are geometric. Intervals are Student's 95 %
# intervals over the seeds: of the mean of log error, or of the mean difference of log
# errors of two runs with the same seed (paired).
#
# -v out=curves   p_l, CPU time, mean error, lo, hi: blocks apart by two empty lines
# -v out=values   name, p_l, mean error, lo, hi, ratio automatic/this, lo, hi, seeds, time
# In both "auto" is first, then "published", then the manual values in the order of the runs.
BEGIN {
    FS = OFS = "\t"
    # 97.5 % quantiles of Student's t for 1 to 11 degrees of freedom.
    names[1] = "auto"
    names[2] = "published"
    name_count = 2
    split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262 2.228 2.201", quantile, " ")
}

function log_error_at(job, t,    i) {
    for (i = 2; i <= rows[job] && time[job, i] < t; i++)
        ;
    if (i > rows[job]) i = rows[job]
    return log(error[job, i - 1]) + log(error[job, i] / error[job, i - 1]) * \
           log(t / time[job, i - 1]) / log(time[job, i] / time[job, i - 1])
}

# Of x[1..n]: estimate, lo and hi, as factors.
function interval(x, n,    i, sum, squares, half) {
    for (i = 1; i <= n; i++) sum += x[i]
    for (i = 1; i <= n; i++) squares += (x[i] - sum / n) ^ 2
    half = quantile[n - 1] * sqrt(squares / (n - 1) / n)
    return exp(sum / n) OFS exp(sum / n - half) OFS exp(sum / n + half)
}

function errors_of(name, t,    i, x) {
    for (i = 1; i <= seeds; i++) x[i] = log_error_at(job_of[name, seed[i]], t)
    return interval(x, seeds)
}

function ratio_to(name, t,    i, x) {
    for (i = 1; i <= seeds; i++)
        x[i] = log_error_at(job_of["auto", seed[i]], t) - \
               log_error_at(job_of[name, seed[i]], t)
    return interval(x, seeds)
}

NR == FNR {
    name = $2 != "auto" ? $3 : $5 == "tours" ? "auto" : "published"
    if (!(name in p_l) && $2 != "auto") names[++name_count] = name
    if (name == "auto") seed[++seeds] = $4
    p_l[name] += $3
    job_of[name, $4] = $1
    next
}
{
    i = ++rows[$1]
    time[$1, i] = $2
    error[$1, i] = $3
}
END {
    for (job in rows) {
        if (time[job, 1] > first) first = time[job, 1]
        if (!last || time[job, rows[job]] < last) last = time[job, rows[job]]
    }
    for (j = 1; j <= name_count; j++) {
        name = names[j]
        value = p_l[name] / seeds
        if (out == "values")
            print name, value, errors_of(name, last), ratio_to(name, last), seeds, last
        else {
            for (k = 0; k <= 12; k++) {
                t = first * (last / first) ^ (k / 12)
                print value, t, errors_of(name, t)
            }
            print "\n"
        }
    }
}
