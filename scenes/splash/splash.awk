# The liquid of the splash: a surface of revolution (pool, crown, ripples) whose crown is
# scalloped round its rim, as PLY with normals from differences.
#   awk -f splash.awk > splash.ply
# Its outer edge lies within the wall of the bowl.
BEGIN {
    N = 160
    # knots of the profile: radius, height, and how much of the scallop they take
    k = split("0 -0.10 0  0.12 -0.10 0  0.25 -0.085 0  0.34 -0.03 0  0.385 0.06 0.02  0.42 0.17 0.1  " \
              "0.455 0.28 0.35  0.485 0.36 0.75  0.505 0.395 1  0.522 0.395 1  0.522 0.36 0.8  0.50 0.28 0.4  " \
              "0.47 0.17 0.12  0.455 0.08 0.03  0.475 0.025 0  0.53 0.01 0  0.60 0.025 0  0.67 0.008 0  " \
              "0.74 0.0 0  0.81 0.010 0  0.89 0.002 0  0.97 0.004 0  1.05 0.0 0", t, " ")
    K = int(k / 3)
    for (i = 1; i <= K; i++) { R[i] = t[3 * i - 2]; H[i] = t[3 * i - 1]; S[i] = t[3 * i] }
    FINE = 3; M = (K - 1) * FINE + 1
    pi2 = 6.283185307179586
    for (m = 0; m < M; m++) {
        i = int(m / FINE) + 1; f = m / FINE - (i - 1)
        if (i >= K) { i = K - 1; f = 1 }
        r[m] = spline(R, i, f); h[m] = spline(H, i, f); s[m] = spline(S, i, f)
    }
    r[0] = 0; r[M - 1] = R[K]
    for (m = 0; m < M; m++)
        for (j = 0; j < N; j++) {
            a = pi2 * j / N
            # twelve points round the rim, some taller
            c = 0.5 + 0.5 * cos(12 * a); c = c * c * (1 + 0.35 * sin(3 * a + 1) + 0.2 * sin(5 * a))
            radius = r[m] * (1 + 0.16 * s[m] * (c - 0.3)); height = h[m] + 0.17 * s[m] * (c - 0.4)
            X[m, j] = radius * cos(a); Y[m, j] = height; Z[m, j] = radius * sin(a)
        }
    printf "ply\nformat ascii 1.0\nelement vertex %d\n", M * N
    print "property float x\nproperty float y\nproperty float z"
    print "property float nx\nproperty float ny\nproperty float nz"
    printf "element face %d\nproperty list uchar int vertex_indices\nend_header\n", (M - 1) * N
    for (m = 0; m < M; m++)
        for (j = 0; j < N; j++) {
            normal(m, j)
            printf "%.4f %.4f %.4f %.3f %.3f %.3f\n", X[m, j], Y[m, j], Z[m, j], nx, ny, nz
        }
    for (j = 0; j < N; j++)
        printf "3 0 %d %d\n", N + (j + 1) % N, N + j
    for (m = 1; m < M - 1; m++)
        for (j = 0; j < N; j++) {
            a = m * N + j; b = m * N + (j + 1) % N
            printf "4 %d %d %d %d\n", a, b, b + N, a + N
        }
}
function spline(v, i, f,   a, b, c, d) { # Catmull-Rom
    a = i > 1 ? v[i - 1] : v[i]; b = v[i]; c = v[i + 1]; d = i + 2 <= K ? v[i + 2] : v[i + 1]
    return b + 0.5 * f * (c - a + f * (2 * a - 5 * b + 4 * c - d + f * (3 * (b - c) + d - a)))
}
function normal(m, j,   p, q, o, e, ux, uy, uz, vx, vy, vz, n) {
    if (m == 0) { nx = 0; ny = 1; nz = 0; return }
    p = m + 1 < M ? m + 1 : m; q = m - 1; o = (j + 1) % N; e = (j + N - 1) % N
    ux = X[p, j] - X[q, j]; uy = Y[p, j] - Y[q, j]; uz = Z[p, j] - Z[q, j]
    vx = X[m, o] - X[m, e]; vy = Y[m, o] - Y[m, e]; vz = Z[m, o] - Z[m, e]
    nx = vy * uz - vz * uy; ny = vz * ux - vx * uz; nz = vx * uy - vy * ux
    n = sqrt(nx * nx + ny * ny + nz * nz)
    nx /= n; ny /= n; nz /= n
}
