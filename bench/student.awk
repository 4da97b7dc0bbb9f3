# Intervals of means: -f bench/student.awk before another program.

# Quantile .975 of Student's t with n degrees of freedom, within 1 % from n = 3 on.
function t95(n) {
    return n == 1 ? 12.706 : n == 2 ? 4.303 : 1.96 + 2.37 / n + 2.82 / n ^ 2 + 2.5 / n ^ 3
}

# Half of the 95 % interval of the mean of n numbers, by their sum and that of squares.
function half_width(n, sum, squares,    v) {
    if (n < 2) return "nan"
    v = (squares - sum * sum / n) / (n - 1)
    return t95(n - 1) * sqrt((v > 0 ? v : 0) / n)
}
