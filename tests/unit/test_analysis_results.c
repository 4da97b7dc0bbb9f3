/* analysis/results and analysis/families: rows become cells and seeds, whatever columns
 * there are; cells that differ in p_l alone come together. */
#include "analysis/families.h"

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

static void write_in(const char *folder, const char *name, const char *text)
{
    struct err err = {0};
    char *path = text_join(folder, name);
    assert_true(text_write_file(path, text, strlen(text), &err));
    mem_free(path);
}

static int set_up(void **state)
{
    char folder[] = "/tmp/etalon_results_XXXXXX";
    assert_non_null(mkdtemp(folder));
    *state = text_copy(folder);
    return 0;
}

static int tear_down(void **state)
{
    static const char *const names[] = {"runs.csv", "curves.csv", NULL};
    for (int i = 0; names[i]; i++) {
        char *path = text_join(*state, names[i]);
        unlink(path);
        mem_free(path);
    }
    rmdir(*state);
    mem_free(*state);
    return 0;
}

static struct results *load(const char *folder)
{
    struct err err = {0};
    struct results *results = results_load(folder, &err);
    if (results == NULL)
        fail_msg("%s", err.message);
    return results;
}

/* --- loading --------------------------------------------------------------------- */

static const char table[] =
    "job,label,scene_label,integrator,seed,budget_seconds,budget_mutations_per_pixel,"
    "p_l,p_l_source,relmse,rmse,reference,reference_relmse,reference_rmse,biased\n"
    "a2,pssmlt p_l=auto,box,pssmlt,2,0,64,0.4,auto,0.02,0.1,,,,false\n"
    "a1,pssmlt p_l=auto,box,pssmlt,1,0,64,0.6,auto,0.03,0.2,ref.exr,0.001,0.01,false\n"
    "b1,\"p, label\",box,pfmlt,1,0,64,0.3,manual,0.04,0.3,,,,true\n"
    "c1,pssmlt p_l=auto,box,pssmlt,1,5,64,0.6,auto,.nan,.nan,,,,false\n"
    "d1,bdpt,box,bdpt,1,0,64,.nan,,0.05,0.4,,,,\n"
    "a9,pssmlt p_l=auto,box,pssmlt,2,0,64,0.8,auto,0.01,0.1,,,,false\n"
    "x,pssmlt,box,pssmlt,one,0,64,0.8,auto,0.01,0.1,,,,false\n";

static void rows_become_cells(void **state)
{
    write_in(*state, "runs.csv", table);
    write_in(*state, "curves.csv",
             "job,cpu_s,wall_s,mutations_per_pixel,relmse\n"
             "a9,2,1,10,0.5\nb1,1,1,8,0.4\na9,4,2,20,0.25\nzz,1,1,1,1\n");
    struct results *r = load(*state);
    assert_int_equal(r->cell_count, 4);
    assert_int_equal(r->superseded, 1);
    assert_int_equal(r->unreadable, 1);
    const struct results_cell *a = &r->cells[0];
    assert_string_equal(a->label, "pssmlt p_l=auto");
    assert_int_equal(a->run_count, 2);
    assert_string_equal(a->runs[0].job, "a1");
    assert_string_equal(a->runs[1].job, "a9"); /* the later row of seed 2 */
    assert_true(a->is_auto && a->has_chains && isnan(a->p_l) && !a->is_biased);
    assert_true(fabs(a->p_l_mean - 0.7) < 1e-12);
    assert_string_equal(a->reference, "ref.exr");
    assert_true(a->noise_is_known[RESULTS_RELMSE] && a->noise[RESULTS_RELMSE] == 0.001);
    assert_true(a->noise[RESULTS_MSE] == 0.01 * 0.01);
    assert_false(a->noise_is_known[RESULTS_RELMSE_TRIMMED]);
    assert_true(a->runs[0].error[RESULTS_MSE] == 0.2 * 0.2);
    assert_true(isnan(a->runs[0].error[RESULTS_RELMSE_TRIMMED]));
    assert_int_equal(a->runs[0].snapshot_count, 0);
    assert_int_equal(a->runs[1].snapshot_count, 2);
    assert_true(a->runs[1].snapshots[1].at[RESULTS_CPU] == 4.0);
    assert_true(a->runs[1].snapshots[1].at[RESULTS_MUTATIONS] == 20.0);
    assert_true(a->runs[1].snapshots[1].error[RESULTS_RELMSE] == 0.25);
    assert_true(isnan(a->runs[1].snapshots[1].error[RESULTS_MSE]));
    assert_string_equal(r->cells[1].label, "p, label");
    assert_true(r->cells[1].is_biased && r->cells[1].p_l == 0.3);
    assert_true(r->cells[2].budget_is_time && r->cells[2].budget == 5.0);
    assert_false(r->cells[3].has_chains);
    assert_true(results_number(r, &a->runs[0], "seed") == 1.0);
    assert_true(isnan(results_number(r, &a->runs[0], "eta_s")));
    assert_null(results_find_seed(a, 3));
    results_destroy(r);
}

static void poor_tables_will_do(void **state)
{
    write_in(*state, "runs.csv", "seed,job,label,scene_label\n1,a,l p_l=auto,s\n");
    struct results *r = load(*state);
    assert_null(r->curves);
    assert_int_equal(r->cell_count, 1);
    assert_false(r->cells[0].has_chains);
    assert_true(isnan(r->cells[0].budget) && isnan(r->cells[0].runs[0].error[0]));
    results_destroy(r);
    write_in(*state, "runs.csv", "seed,job,label,scene_label,p_l\n1,a,l p_l=auto,s,.4\n");
    r = load(*state);
    assert_true(r->cells[0].is_auto && r->cells[0].has_chains);
    results_destroy(r);
    write_in(*state, "runs.csv", "seed,job,label,scene_label\n");
    r = load(*state);
    assert_int_equal(r->cell_count, 0);
    results_destroy(r);
}

/* Of a scene that has changed only what was run since counts, whatever the seeds. */
static void contents_are_not_mixed(void **state)
{
    write_in(*state, "runs.csv",
             "job,label,scene_label,seed,cell,relmse\n1,pt,s,1,old,9\n2,pt,s,2,old,9\n"
             "3,pt,s,3,.nan,3\n4,pt,s,1,new,1\n5,bdpt,s,1,old,2\n");
    struct results *r = load(*state);
    assert_int_equal(r->cell_count, 2);
    assert_int_equal(r->superseded, 2);
    assert_int_equal(r->cells[0].run_count, 2);
    assert_true(r->cells[0].runs[0].error[RESULTS_RELMSE] == 1.0);
    assert_true(r->cells[0].runs[1].error[RESULTS_RELMSE] == 3.0); /* does not tell */
    assert_int_equal(r->cells[1].run_count, 1);
    results_destroy(r);
}

static void other_files_are_refused(void **state)
{
    struct err err = {0};
    assert_null(results_load(*state, &err));
    assert_non_null(strstr(err.message, "no runs.csv"));
    err = (struct err){0};
    write_in(*state, "runs.csv", "job,label,seed\n");
    assert_null(results_load(*state, &err));
    assert_non_null(strstr(err.message, "'scene_label'"));
    err = (struct err){0};
    write_in(*state, "runs.csv", "job,label,scene_label,seed\na,b\n");
    assert_null(results_load(*state, &err));
    assert_int_equal(err.line, 2);
    err = (struct err){0};
    write_in(*state, "runs.csv", "job,label,scene_label,seed\n");
    write_in(*state, "curves.csv", "job,wall_s\na\n");
    assert_null(results_load(*state, &err));
    assert_int_equal(err.line, 2);
}

/* --- families -------------------------------------------------------------------- */

#define HEAD                                                                       \
    "job,label,scene_label,integrator,kernel,per,seed,budget_mutations_per_pixel," \
    "p_l,p_l_source\n"

static struct results *load_families(const char *folder, const char *rows,
                                     struct families *families)
{
    char *text = text_format("%s%s", HEAD, rows);
    write_in(folder, "runs.csv", text);
    mem_free(text);
    struct results *results = load(folder);
    families_make(results, families);
    return results;
}

static void sweeps_come_together(void **state)
{
    struct families f;
    struct results *r = load_families(
        *state,
        "1,pssmlt p_l=0.9,a,pssmlt,exp,,1,64,0.9,manual\n"
        "2,pssmlt p_l=auto,a,pssmlt,exp,,1,64,0.5,auto\n"
        "3,pssmlt p_l=0.1,a,pssmlt,exp,,1,64,0.1,manual\n"
        "4,pssmlt p_l=0.1,b,pssmlt,exp,,1,64,0.1,manual\n"  /* scene */
        "5,pssmlt p_l=0.1,a,pssmlt,exp,,1,128,0.1,manual\n" /* budget */
        "6,mmlt p_l=0.2,a,mmlt,exp,all,1,64,0.2,manual\n"
        "7,pssmlt kernel=g p_l=0.3,a,pssmlt,g,,1,64,0.3,manual\n"
        "8,bdpt,a,bdpt,,,1,64,.nan,\n",
        &f);
    assert_int_equal(f.count, 5);
    assert_string_equal(f.items[0].name, "pssmlt");
    assert_ptr_equal(f.items[0].automatic, &r->cells[1]);
    assert_int_equal(f.items[0].manual_count, 2);
    assert_true(f.items[0].manual[0]->p_l == 0.1 && f.items[0].manual[1]->p_l == 0.9);
    for (size_t i = 1; i < f.count; i++) {
        assert_null(f.items[i].automatic);
        assert_int_equal(f.items[i].manual_count, 1);
    }
    assert_string_equal(f.items[4].name, "pssmlt kernel=g");
    families_deinit(&f);
    results_destroy(r);
}

/* Labels of the user's own say nothing of p_l; the columns do. */
static void labels_do_not_matter(void **state)
{
    struct families f;
    struct results *r = load_families(*state,
                                      "1,mine,a,mmlt,exp,all,1,64,0.5,auto\n"
                                      "2,by length,a,mmlt,exp,length,1,64,0.6,auto\n"
                                      "3,theirs,a,mmlt,exp,all,1,64,0.3,manual\n",
                                      &f);
    assert_int_equal(f.count, 2);
    for (size_t i = 0; i < 2; i++) {
        assert_ptr_equal(f.items[i].automatic, &r->cells[i]);
        assert_int_equal(f.items[i].manual_count, 1);
        assert_ptr_equal(f.items[i].manual[0], &r->cells[2]);
    }
    families_deinit(&f);
    results_destroy(r);
}

/* ... unless there is an axis that no column tells. */
static void labels_tell_other_axes(void **state)
{
    struct families f;
    struct results *r = load_families(
        *state,
        "1,p_l=auto chains=1,a,mmlt,exp,all,1,64,0.5,auto\n"
        "2,p_l=auto chains=2,a,mmlt,exp,all,1,64,0.6,auto\n"
        "3,p_l=0.3 chains=1,a,mmlt,exp,all,1,64,.3,manual\n"
        "4,p_l=0.3 chains=2,a,mmlt,exp,all,1,64,.3,manual\n"
        "5,p_l=0.6 chains=2,a,mmlt,exp,all,1,64,.6,manual\n",
        &f);
    assert_int_equal(f.count, 2);
    assert_string_equal(f.items[1].name, "chains=2");
    assert_int_equal(f.items[0].manual_count, 1);
    assert_int_equal(f.items[1].manual_count, 2);
    assert_ptr_equal(f.items[1].manual[0], &r->cells[3]);
    families_deinit(&f);
    results_destroy(r);
}

/* Runs whose trimmed error leaves out another share of the pixels have none, nor have
 * their curves; the noise that they state counts if no other does. */
static void other_trims_are_left_out(void **state)
{
    write_in(*state, "runs.csv",
             "job,label,scene_label,seed,relmse,relmse_trimmed,relmse_trim,"
             "reference_relmse,reference_relmse_trimmed\n"
             "a1,a,box,1,0.5,0.25,.nan,0.125,.nan\n"
             "a2,a,box,2,0.5,0.25,0.01,0.0625,0.03125\n"
             "b1,b,box,1,0.5,0.25,0.001,0.125,.nan\n");
    write_in(*state, "curves.csv",
             "job,cpu_s,relmse,relmse_trimmed\na1,1,2,1\na2,1,2,1\nb1,1,2,1\n");
    struct results *r = load(*state);
    const struct results_cell *a = &r->cells[0], *b = &r->cells[1];
    assert_int_equal(r->other_trim, 2);
    assert_true(isnan(a->runs[0].error[RESULTS_RELMSE_TRIMMED]));
    assert_true(isnan(a->runs[0].snapshots[0].error[RESULTS_RELMSE_TRIMMED]));
    assert_true(a->runs[0].error[RESULTS_RELMSE] == 0.5);
    assert_true(a->runs[0].snapshots[0].error[RESULTS_RELMSE] == 2.0);
    assert_true(a->runs[1].error[RESULTS_RELMSE_TRIMMED] == 0.25);
    assert_true(a->runs[1].snapshots[0].error[RESULTS_RELMSE_TRIMMED] == 1.0);
    assert_true(a->noise[RESULTS_RELMSE] == 0.0625);
    assert_true(a->noise[RESULTS_RELMSE_TRIMMED] == 0.03125);
    assert_true(b->noise[RESULTS_RELMSE] == 0.125);
    assert_false(b->noise_is_known[RESULTS_RELMSE_TRIMMED]);
    results_destroy(r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(rows_become_cells, set_up, tear_down),
        cmocka_unit_test_setup_teardown(poor_tables_will_do, set_up, tear_down),
        cmocka_unit_test_setup_teardown(contents_are_not_mixed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(other_files_are_refused, set_up, tear_down),
        cmocka_unit_test_setup_teardown(sweeps_come_together, set_up, tear_down),
        cmocka_unit_test_setup_teardown(labels_do_not_matter, set_up, tear_down),
        cmocka_unit_test_setup_teardown(labels_tell_other_axes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(other_trims_are_left_out, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
