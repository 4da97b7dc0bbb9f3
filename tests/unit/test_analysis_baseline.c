/* analysis/cells and analysis/baseline: tables of runs as cells, and these kept as a
 * file. */
#include "analysis/baseline.h"

#include "base/mem.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "support/near.h"

struct fixture {
    char folder[40], path[60];
    struct cells cells;
    struct log log;
    struct err err;
};

static int set_up(void **state)
{
    struct fixture *f = mem_alloc(1, sizeof *f);
    snprintf(f->folder, sizeof f->folder, "/tmp/etalon_baseline_XXXXXX");
    assert_non_null(mkdtemp(f->folder));
    snprintf(f->path, sizeof f->path, "%s/t.csv", f->folder);
    log_init(&f->log);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    struct fixture *f = *state;
    unlink(f->path);
    rmdir(f->folder);
    cells_deinit(&f->cells);
    log_deinit(&f->log);
    mem_free(f);
    return 0;
}

static bool load(struct fixture *f, const char *table)
{
    assert_true(text_write_file(f->path, table, strlen(table), &f->err));
    struct csv *runs = csv_read(f->path, &f->err);
    assert_non_null(runs);
    bool ok = cells_from_runs(runs, &f->cells, &f->log, &f->err);
    csv_destroy(runs);
    return ok;
}

static bool noted(const struct fixture *f, const char *part)
{
    for (size_t i = 0; i < f->log.count; i++)
        if (strstr(f->log.notes[i].text, part))
            return true;
    return false;
}

static const struct cell_statistic *find(const struct fixture *f, size_t cell,
                                         const char *name)
{
    const struct cell_statistic *s = cell_find(&f->cells.items[cell], name);
    assert_non_null(s);
    return s;
}

/* --- cells ----------------------------------------------------------------------- */

static const char runs[] =
    "job,label,scene_label,seed,commit,budget_seconds,budget_mutations_per_pixel,kernel,"
    "b,b_se,eta_s,by_length,b_by_length,b_se_by_length,experiment,cell,relmse\n"
    "1,mmlt,box,7,abc,0,16,gaussian,1,0.1,.nan,3 4,0.5 0.25,0.1 0.2,e,k,1\n"
    "2,mmlt,box,5,abc,0,16,gaussian,2,0.1,0.5,3 5,0.7 0.125,0.1 0.2,e,k,100\n"
    "3,mmlt,box,6,abc,0,64,gaussian,3,0.1,0.5,,,,e,k,.nan\n"
    "4,mmlt,box,9,abc,5,0,gaussian,3,0.1,0.5,,,,e,k,0\n";

static void runs_become_cells(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, runs));
    assert_int_equal(f->cells.count, 3);
    const struct cell *cell = &f->cells.items[0];
    assert_string_equal(cell->scene, "box");
    assert_string_equal(cell->label, "mmlt");
    assert_string_equal(cell->budget, "mpp=16");
    assert_string_equal(f->cells.items[1].budget, "mpp=64");
    assert_string_equal(f->cells.items[2].budget, "5s");
    assert_string_equal(cell->id, "k");
    assert_string_equal(cell->experiment, "e");
    assert_string_equal(cell->commit, "abc");
    assert_int_equal(cell->runs, 2);
    assert_int_equal(cell->seed_first, 5);
    assert_int_equal(cell->seed_last, 7);
    assert_string_equal(find(f, 0, "kernel")->text, "gaussian");
    assert_true(noted(f, "no column 'p_l'"));
    assert_false(noted(f, "no column 'b'"));
}

static void means_have_errors_from_replicates(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, runs));
    const struct cell_statistic *b = find(f, 0, "b");
    assert_near(b->mean, 1.5, 0.0);
    assert_near(b->se, 0.5, 1e-15);
    assert_true(isnan(b->se_within)); /* never beside replicates */
    assert_near(find(f, 1, "b")->se_within, 0.1, 0.0);
    assert_true(isnan(find(f, 1, "b")->se));
    const struct cell_statistic *eta = find(f, 0, "eta_s");
    assert_int_equal(eta->count, 1);
    assert_int_equal(eta->missing, 1);
    assert_near(eta->mean, 0.5, 0.0);
}

static void relmse_is_a_logarithm(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, runs));
    assert_near(find(f, 0, "relmse")->mean, log(10.0), 1e-12);
    assert_near(find(f, 0, "relmse")->se, log(10.0), 1e-12);
    assert_int_equal(find(f, 1, "relmse")->missing, 1); /* .nan */
    assert_int_equal(find(f, 2, "relmse")->missing, 1); /* 0 */
    assert_true(cell_scale("relmse") == CELL_LOG && cell_scale("b[3]") == CELL_LINEAR);
    assert_true(cell_scale("kernel") == CELL_SETTING);
}

static void lengths_are_statistics_of_their_own(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, runs));
    assert_near(find(f, 0, "b[3]")->mean, 0.6, 1e-15);
    assert_int_equal(find(f, 0, "b[4]")->count, 1);
    assert_int_equal(find(f, 0, "b[4]")->missing, 1);
    assert_near(find(f, 0, "b[5]")->mean, 0.125, 0.0);
    assert_near(find(f, 0, "b[5]")->se_within, 0.2, 0.0);
    assert_null(cell_find(&f->cells.items[1], "b[3]"));
}

static void newer_contents_win(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "label,scene_label,seed,commit,cell,b\n"
                        "pt,box,1,abc,old,1\npt,box,1,abc,new,3\npt,box,2,def,new,5\n"));
    assert_int_equal(f->cells.count, 1);
    assert_string_equal(f->cells.items[0].id, "new");
    assert_near(find(f, 0, "b")->mean, 4.0, 0.0);
    assert_true(noted(f, "left out: a newer run"));
    assert_true(noted(f, "several commits"));
    assert_string_equal(f->cells.items[0].commit, "(several)");
}

/* Two rows of one seed are no replicates of each other. */
static void a_seed_counts_once(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "job,label,scene_label,seed,cell,b\n1,pt,box,1,k,1\n"
                        "2,pt,box,2,k,5\n3,pt,box,1,k,3\n4,pt,box,x,k,9\n"
                        ",pt,box,4,k,9\n6,pt,box,3,.nan,7\n"));
    assert_int_equal(f->cells.items[0].runs, 3);
    assert_near(find(f, 0, "b")->mean, 5.0, 0.0);
    assert_string_equal(f->cells.items[0].id, "k");
    assert_true(noted(f, "has the same seed"));
    assert_true(noted(f, "it has no seed, or no job"));
    assert_true(noted(f, "its contents are not stated"));
}

static void a_table_without_contents_is_noted(void **state)
{
    struct fixture *f = *state;
    assert_true(load(f, "label,scene_label,seed,b\npt,box,1,1\n"));
    assert_true(noted(f, "no column 'cell'"));
    assert_string_equal(f->cells.items[0].id, "");
    cells_deinit(&f->cells);
    assert_false(load(f, "label,b\npt,1\n"));
    assert_int_equal(f->err.line, 1);
}

/* --- files ----------------------------------------------------------------------- */

static void assert_same_number(double a, double b)
{
    assert_true(a == b || (isnan(a) && isnan(b)));
}

static void a_baseline_comes_back(void **state)
{
    struct fixture *f = *state;
    struct cells back;
    assert_true(load(f, runs));
    mem_free(f->cells.items[0].label);
    f->cells.items[0].label = text_copy("a, \"b\"");
    assert_true(baseline_write(f->path, &f->cells, &f->err));
    assert_true(baseline_read(f->path, &back, &f->err));
    assert_int_equal(back.count, f->cells.count);
    for (size_t i = 0; i < back.count; i++) {
        const struct cell *a = &f->cells.items[i], *b = &back.items[i];
        size_t had = 0;
        assert_ptr_equal(cells_find(&back, a), b);
        assert_string_equal(a->id, b->id);
        assert_string_equal(a->experiment, b->experiment);
        assert_string_equal(a->commit, b->commit);
        assert_true(a->runs == b->runs && a->seed_first == b->seed_first &&
                    a->seed_last == b->seed_last);
        for (size_t k = 0; k < a->count; k++) {
            const struct cell_statistic *s = &a->statistics[k];
            const struct cell_statistic *t = cell_find(b, s->name);
            had += cell_has(s);
            assert_true(cell_has(s) == (t != NULL));
            if (t == NULL)
                continue;
            assert_true(text_equal(s->text ? s->text : "", t->text ? t->text : ""));
            assert_true(s->count == t->count && s->missing == t->missing);
            assert_same_number(s->mean, t->mean);
            assert_same_number(s->se, t->se);
            assert_same_number(s->se_within, t->se_within);
        }
        assert_int_equal(b->count, had);
    }
    cells_deinit(&back);
}

#define HEADER                                                                   \
    "scene_label,label,budget,cell,experiment,commit,runs,seed_first,seed_last," \
    "statistic,"                                                                 \
    "n,missing,value,se,se_within\n"
#define CELL "box,pt,mpp=1,k,e,abc,"

static void what_is_wrong_has_its_line(void **state)
{
    static const struct {
        const char *text, *message;
        int line;
    } cases[] = {
        {"a,b\n1,2\n", "no column 'scene_label'", 1},
        {HEADER, "no rows", 1},
        {HEADER CELL "2,1,2,b,2,0,one,0.1,.nan\n", "value: 'one'", 2},
        {HEADER CELL "2,1,2,b,2,0,.nan,0.1,.nan\n", "value: '.nan'", 2},
        {HEADER CELL "2,1,2,b,2,0,1,.nan,.nan\n", "se: '.nan'", 2},
        {HEADER CELL "2,1,2,b,2,0,1,-1,.nan\n", "se: '-1'", 2},
        {HEADER CELL "2,1,2,b,1,0,1,1,.nan\n", "not 2 runs together", 2},
        {HEADER CELL "0,1,2,b,0,0,1,1,.nan\n", "runs: '0'", 2},
        {HEADER CELL "2,3,2,b,2,0,1,1,.nan\n", "seed_last: '2'", 2},
        {HEADER CELL "2,1,2,b,2,-1,1,1,.nan\n", "missing: '-1'", 2},
        {HEADER CELL "2,1,2,,2,0,1,1,.nan\n", "no name", 2},
        {HEADER CELL "2,1,2,b,2,0,1,1,.nan\n" CELL "2,1,2,b,2,0,1,1,.nan\n", "twice", 3},
        {HEADER CELL
         "2,1,2,b,2,0,1,1,.nan\nbox,pt,mpp=1,l,e,abc,2,1,2,p_l,2,0,1,1,.nan\n",
         "cell: 'l'", 3},
        {HEADER CELL "2,1,2,b,2,0,1,1\n", "14 cells", 2},
        {HEADER CELL "2,1,2,b,2,0,1,1,.nan\n" CELL "2,1,2,p_", "ends within", 3},
    };
    struct fixture *f = *state;
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct err err = {0};
        struct cells cells;
        assert_true(text_write_file(f->path, cases[i].text, strlen(cases[i].text), &err));
        assert_false(baseline_read(f->path, &cells, &err));
        if (strstr(err.message, cases[i].message) == NULL)
            fail_msg("'%s' does not say \"%s\"", err.message, cases[i].message);
        assert_string_equal(err.file, f->path);
        assert_int_equal(err.line, cases[i].line);
        cells_deinit(&cells);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(runs_become_cells, set_up, tear_down),
        cmocka_unit_test_setup_teardown(means_have_errors_from_replicates, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(relmse_is_a_logarithm, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lengths_are_statistics_of_their_own, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(newer_contents_win, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_seed_counts_once, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_table_without_contents_is_noted, set_up,
                                        tear_down),
        cmocka_unit_test_setup_teardown(a_baseline_comes_back, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_wrong_has_its_line, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
