/* Numerical stability: every integrator and mode on cases driven to extremes, each held
 * against what is known of it (tests/support/stability.h).
 *
 *   stability FOLDER [CATEGORY]
 *
 * Leaves table.csv, table.md and index.html in FOLDER. Exits with 1 if a case failed. */

#include "support/stability_cases.h"
#include "table_file.h"

#define ROWS_MOST 8192

int main(int argc, char **argv)
{
    static struct stability_row rows[ROWS_MOST];
    int count = 0;
    for (int i = 0; i < STABILITY_SWEEPS; i++) {
        const struct stability_sweep *c = &stability_sweeps[i];
        if (argc > 2 && !strstr(argv[2], c->category))
            continue;
        for (int k = 0; k < c->count; k++) {
        int begin = count;
        count += stability_run(c, c->x[k], rows + count);
        for (int j = begin; j < count; j++)
            fprintf(stderr, "%-10s %-22s %8.3g %-16s %.6g %.6g se %.2g z %.2f %s\n", c->category,
                    c->name, rows[j].x, rows[j].setup, rows[j].value, rows[j].reference,
                    rows[j].se, rows[j].residual, rows[j].note);
        }
    }
    stability_judge(rows, count);
    int of[4] = {0};
    for (int j = 0; j < count; j++)
    {
        of[rows[j].verdict]++;
        if (rows[j].verdict) printf("%s %s %s %g %s z %.2f: %s\n", verdict_name[rows[j].verdict], rows[j].of->category, rows[j].of->name, rows[j].x, rows[j].setup, rows[j].residual, rows[j].note);
    }
    printf("%d rows: %d passed, %d warned, %d failed, %d refused\n", count, of[0], of[1], of[2], of[3]);
    return of[FAILED] > 0;
}
