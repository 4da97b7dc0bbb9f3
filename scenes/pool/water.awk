# The water of the pool: waves as a sum of sines, a grid with its exact normals, as PLY.
#   awk -f water.awk > water.ply
# x -2.05 to 2.05, z -1.55 to 1.55, 5 cm into the walls, so that no light passes at the edge.
function wave(i, kx, kz, a, p) { WX[i] = kx; WZ[i] = kz; A[i] = a; P[i] = p; WAVES = i }
BEGIN {
    NX = 112; NZ = 80; LEVEL = -0.12
    wave(1, 5.1, 3.7, 0.0080, 0.3)
    wave(2, -7.9, 4.4, 0.0050, 1.9)
    wave(3, 3.3, -10.2, 0.0045, 4.0)
    wave(4, 11.7, 7.1, 0.0030, 2.6)
    wave(5, -13.3, -6.2, 0.0022, 5.1)
    wave(6, 6.0, 16.4, 0.0016, 0.8)
    printf "ply\nformat ascii 1.0\nelement vertex %d\n", (NX + 1) * (NZ + 1)
    print "property float x\nproperty float y\nproperty float z"
    print "property float nx\nproperty float ny\nproperty float nz"
    printf "element face %d\nproperty list uchar int vertex_indices\nend_header\n", NX * NZ
    for (j = 0; j <= NZ; j++)
        for (i = 0; i <= NX; i++) {
            x = -2.05 + 4.1 * i / NX; z = -1.55 + 3.1 * j / NZ
            y = LEVEL; dx = 0; dz = 0
            for (w = 1; w <= WAVES; w++) {
                phase = WX[w] * x + WZ[w] * z + P[w]
                y += A[w] * sin(phase)
                dx += A[w] * WX[w] * cos(phase); dz += A[w] * WZ[w] * cos(phase)
            }
            n = sqrt(1 + dx * dx + dz * dz)
            printf "%.3f %.5f %.3f %.3f %.3f %.3f\n", x, y, z, -dx / n, 1 / n, -dz / n
        }
    for (j = 0; j < NZ; j++)
        for (i = 0; i < NX; i++) {
            a = j * (NX + 1) + i; b = a + NX + 1
            printf "4 %d %d %d %d\n", a, b, b + 1, a + 1
        }
}
