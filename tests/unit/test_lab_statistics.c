/* lab/statistics: the public names in their order, each with the value that it stands
 * for; what an integrator does not have is .nan or "". */
#include "lab/statistics.h"

#include "base/doc.h"
#include "base/mem.h"
#include "support/setting_examples.h"

#include <stdlib.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* The order is public: columns may be appended, never renamed or moved. */
static const char *const first_names[] = {
    "scene",
    "integrator",
    "mode",
    "kernel",
    "estimator",
    "builder",
    "max_depth",
    "chains",
    "bootstrap_paths",
    "seed",
    "threads",
    "commit",
    "width",
    "height",
    "seconds_total",
    "seconds_cpu",
    "seconds_startup",
    "paths",
    "mutations_per_pixel",
    "b",
    "b_se",
    "eta_s",
    "eta_s_se",
    "eta_l",
    "eta_l_se",
    "eta_0",
    "eta_0_se",
    "r",
    "r_lo",
    "r_hi",
    "p_l",
    "p_l_lo",
    "p_l_hi",
    "p_l_source",
    "p_l_reason",
    "acceptance",
    "failure_rate",
    "excluded",
    "n_nonfinite",
    "n_saturated",
    "left_out",
};

#define FIRST ((int)(sizeof first_names / sizeof first_names[0]))

static struct statistics_record example(bool chains)
{
    struct statistics_record r = {
        .scene = "a b.pbrt",
        .left_out = "lens, quadrics",
        .verdict = "converged",
        .ended_by = "budget",
        .lists = {[LIST_LENGTHS] = "1 2 5", [LIST_B] = "0.5 0.25 1e-06"},
        .p_l_source = "auto",
        .p_l_reason = "r = 0.5: flat",
        .commit = "0123abc",
        .compiler = "cc",
        .flags = "-O3",
        .rays = "rays",
        .chains = chains,
        .width = 31,
        .height = 17,
        .emission_scale = 1024.0,
        .seconds_load = 0.5,
        .settings = {.integrator = chains ? "pssmlt" : "bdpt",
                     .mode = "exact",
                     .kernel = "gaussian",
                     .estimator = "plain",
                     .builder = "pt",
                     .sigma = 0.02,
                     .s1 = 0.001,
                     .s2 = 0.016,
                     .rule = "zsolnai2013",
                     .seed = 9,
                     .start = 0.02,
                     .start_cap = 0.2,
                     .mutations_per_pixel = 64.0},
        .run = {.seconds_total = 12.25,
                .seconds_cpu = 24.5,
                .mutations_per_pixel = 64.0,
                .max_depth = 6,
                .threads = 2,
                .interrupted = true},
    };
    struct run_statistics *s = &r.run.statistics;
    *s = (struct run_statistics){
        .paths = 1e7,
        .chains = 77,
        .bootstrap_paths = 1e5,
        .b = 0.1,
        .b_se = 0.001,
        .start = {.eta_s = 0.8,
                  .eta_s_se = 0.01,
                  .eta_l = 0.3,
                  .eta_l_se = 0.02,
                  .eta_0 = 0.6,
                  .eta_0_se = 0.03,
                  .r = 0.5,
                  .r_lo = 0.4,
                  .r_hi = 0.55},
        .whole = {.eta_s = 0.81},
        .plarge = {.p_l = 0.79, .p_l_lo = 0.7, .p_l_hi = 0.9},
        .start_mutations = 5000.0,
        .start_looks = 3,
        .seconds_startup = 0.75,
        .acceptance = 0.45,
        .failure_rate = 0.125,
        .excluded = 4.0,
        .most_rejections_in_row = 99.0,
        .nonfinite = 1.0,
        .saturated = 2.0,
    };
    return r;
}

static void names_keep_their_order(void **state)
{
    (void)state;
    assert_true(statistics_count() >= FIRST);
    for (int i = 0; i < FIRST; i++)
        assert_string_equal(statistics_name(i), first_names[i]);
    for (int i = 0; i < statistics_count(); i++)
        for (int j = 0; j < i; j++)
            assert_string_not_equal(statistics_name(i), statistics_name(j));
}

static bool is_name(const char *name)
{
    for (int i = 0; i < statistics_count(); i++)
        if (text_equal(statistics_name(i), name))
            return true;
    return false;
}

/* What a setting declares is there, under its name. */
static void settings_have_their_columns(void **state)
{
    (void)state;
    for (int i = 0; settings_row(i); i++) {
        const struct setting *row = settings_row(i);
        const char *name = row->column ? row->column : row->seen;
        if (!name || !is_name(name))
            fail_msg("%s: there is no column %s", row->name, name ? name : "at all");
    }
}

static char *column_of(const struct settings *settings, const char *name)
{
    struct statistics_record record = example(true);
    record.settings = *settings;
    struct text text = {0};
    for (int i = 0; i < statistics_count(); i++)
        if (text_equal(statistics_name(i), name))
            statistics_append(&text, &record, i);
    return text.data;
}

/* A column that repeats a setting tells each of its values apart; one of an integrator
 * that does not read the setting is the same for all. */
static void check_column(const struct setting *row, const char *integrator, bool differs)
{
    struct setting_examples e = setting_examples(row, false);
    char *first = NULL;
    bool seen = false;
    for (int i = 0; i < e.count; i++) {
        struct settings s;
        struct err err = {0};
        settings_init(&s);
        s.integrator = integrator;
        assert_true(settings_set(&s, row->name, e.texts[i], NULL, &err));
        char *value = column_of(&s, row->column);
        assert_non_null(value);
        first = first ? first : text_copy(value);
        seen = seen || !text_equal(value, first);
        mem_free(value);
    }
    if (seen != differs)
        fail_msg("%s of %s: its column %s", row->name, integrator,
                 seen ? "is of another integrator" : "does not tell its values apart");
    mem_free(first);
}

/* An integrator that reads the setting. */
static const char *reader_of(const struct setting *row)
{
    static const char *const names[] = {"pfmlt", "pssmlt", "smlt",
                                        "rjmlt", "mlt",    "bdpt"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        struct settings s;
        settings_init(&s);
        s.integrator = names[i];
        if (setting_used(row, &s))
            return names[i];
    }
    fail_msg("%s: nobody reads it", row->name);
    return NULL;
}

static void columns_repeat_their_settings(void **state)
{
    (void)state;
    for (int i = 0; settings_row(i); i++) {
        const struct setting *row = settings_row(i);
        bool several = row->kind == SETTING_NUMBER || row->words == NULL ||
                       row->words[1].word != NULL;
        if (row->column == NULL)
            continue;
        check_column(row, reader_of(row), several);
        if (row->readers != 0)
            check_column(row, row->readers & SETTING_PASSES ? "mlt" : "pt", false);
    }
}

struct expected {
    const char *name, *value;
};

static const struct expected with_chains[] = {
    {"scene", "a b.pbrt"},
    {"integrator", "pssmlt"},
    {"mode", ""}, /* of pfmlt and rjmlt alone */
    {"allocation", ""},
    {"kernel", "gaussian"},
    {"estimator", "plain"},
    {"builder", "pt"},
    {"max_depth", "6"},
    {"chains", "77"},
    {"bootstrap_paths", "100000"},
    {"seed", "9"},
    {"threads", "2"},
    {"commit", "0123abc"},
    {"width", "31"},
    {"height", "17"},
    {"seconds_total", "12.25"},
    {"seconds_cpu", "24.5"},
    {"seconds_startup", "0.75"},
    {"paths", "10000000"},
    {"mutations_per_pixel", "64"},
    {"b", "0.1"},
    {"b_se", "0.001"},
    {"eta_s", "0.8"},
    {"eta_s_se", "0.01"},
    {"eta_l", "0.3"},
    {"eta_l_se", "0.02"},
    {"eta_0", "0.6"},
    {"eta_0_se", "0.03"},
    {"r", "0.5"},
    {"r_lo", "0.4"},
    {"r_hi", "0.55"},
    {"p_l", "0.79"},
    {"p_l_lo", "0.7"},
    {"p_l_hi", "0.9"},
    {"p_l_source", "auto"},
    {"p_l_reason", "r = 0.5: flat"},
    {"acceptance", "0.45"},
    {"failure_rate", "0.125"},
    {"excluded", "4"},
    {"n_nonfinite", "1"},
    {"n_saturated", "2"},
    {"left_out", "lens, quadrics"},
    {"eta_s_run", "0.81"},
    {"start_mutations", "5000"},
    {"start_looks", "3"},
    {"p_l_unsure", "false"},
    {"longest_stay", "99"},
    {"interrupted", "true"},
    {"sigma", "0.02"},
    {"s1", "0.001"},
    {"s2", "0.016"},
    {"emission_scale", "1024"},
    {"biased", "false"},
    {"by_length", "1 2 5"},
    {"b_by_length", "0.5 0.25 1e-06"},
    {NULL, NULL},
};

static const struct expected without_chains[] = {
    {"scene", "a b.pbrt"},   {"kernel", ""},         {"builder", ""},
    {"chains", ".nan"},      {"seed", "9"},          {"b", "0.1"},
    {"eta_s", ".nan"},       {"p_l", ".nan"},        {"p_l_reason", ""},
    {"start_looks", ".nan"}, {"p_l_unsure", ".nan"}, {"n_nonfinite", "1"},
    {"interrupted", "true"}, {NULL, NULL},
};

static void check_yaml(bool chains, const struct expected *expected)
{
    struct statistics_record record = example(chains);
    struct err err = {0};
    char *yaml = statistics_yaml(&record);
    struct doc *doc = doc_parse(yaml, strlen(yaml), "yaml", &err);
    assert_non_null(doc);
    assert_int_equal(doc_count(doc_root(doc)), statistics_count());
    for (; expected->name; expected++)
        assert_string_equal(doc_text(doc_get(doc_root(doc), expected->name)),
                            expected->value);
    doc_destroy(doc);
    mem_free(yaml);
}

static void yaml_holds_the_values(void **state)
{
    (void)state;
    check_yaml(true, with_chains);
    check_yaml(false, without_chains);
}

static void attributes_hold_the_values(void **state)
{
    (void)state;
    struct statistics_record record = example(true);
    int count;
    struct exr_attribute *attributes = statistics_attributes(&record, &count);
    assert_int_equal(count, statistics_count());
    for (int i = 0; i < count; i++) {
        assert_memory_equal(attributes[i].name, "etalon:", 7);
        assert_string_equal(attributes[i].name + 7, statistics_name(i));
        for (const struct expected *e = with_chains; e->name; e++)
            if (text_equal(e->name, statistics_name(i)))
                assert_string_equal(attributes[i].value, e->value);
    }
    statistics_attributes_destroy(attributes, count);
}

static void a_file_that_cannot_be_written_is_an_error(void **state)
{
    (void)state;
    struct statistics_record record = example(true);
    struct err err = {0};
    assert_false(statistics_write("/nowhere/at/all.yaml", &record, &err));
    assert_int_equal(err.code, ERR_IO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_keep_their_order),
        cmocka_unit_test(settings_have_their_columns),
        cmocka_unit_test(columns_repeat_their_settings),
        cmocka_unit_test(yaml_holds_the_values),
        cmocka_unit_test(attributes_hold_the_values),
        cmocka_unit_test(a_file_that_cannot_be_written_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
