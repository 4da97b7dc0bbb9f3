/* Nothing of a setting is forgotten: each field of struct settings has a row, and each
 * row says all that others make of it. That identities and statistics keep to what rows
 * say is in test_lab_identity.c and test_lab_statistics.c, the document in
 * tests/cli/settings.sh. Nothing here is left to chance. */

#include "base/mem.h"
#include "integrator/registry.h"
#include "support/setting_examples.h"

#include <string.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#ifndef __has_builtin
#define __has_builtin(x) 0
#endif

/* Fields that no user sets. */
static const struct {
    size_t offset, size;
} not_settings[] = {{offsetof(struct settings, memory_limit), sizeof(double)}};

/* covered: 1 where a byte belongs to some field. False where the compiler does not tell
 * what is padding: gcc does, from 11 on. */
static bool mark_padding(unsigned char *covered)
{
#if __has_builtin(__builtin_clear_padding)
    struct settings s;
    memset(&s, 0xff, sizeof s);
    __builtin_clear_padding(&s);
    const unsigned char *bytes = (const unsigned char *)&s;
    for (size_t i = 0; i < sizeof s; i++)
        covered[i] |= bytes[i] == 0;
    return true;
#else
    (void)covered;
    return false;
#endif
}

/* Two rows may share no byte either: one would undo what the other has set. */
static void every_field_has_one_row(void **state)
{
    (void)state;
    unsigned char covered[sizeof(struct settings)] = {0};
    for (size_t i = 0; i < sizeof not_settings / sizeof *not_settings; i++)
        memset(covered + not_settings[i].offset, 1, not_settings[i].size);
    for (int i = 0; settings_row(i); i++) {
        const struct setting *row = settings_row(i);
        for (size_t j = 0; j < row->size; j++)
            if (covered[row->offset + j]++)
                fail_msg("%s shares byte %zu with another", row->name, row->offset + j);
    }
    if (!mark_padding(covered))
        skip();
    for (size_t i = 0; i < sizeof covered; i++)
        if (!covered[i])
            fail_msg("no row sets byte %zu of struct settings", i);
}

static void check_size(const struct setting *row)
{
    static const size_t sizes[] = {[SETTING_FLAG] = sizeof(bool),
                                   [SETTING_COUNT] = sizeof(long),
                                   [SETTING_NUMBER] = sizeof(double),
                                   [SETTING_NAME] = sizeof(const char *),
                                   [SETTING_CHOICE] = sizeof(enum direct)};
    if (row->kind != SETTING_OWN && row->size != sizes[row->kind])
        fail_msg("%s: its field is of another kind", row->name);
    bool words = row->kind == SETTING_NAME || row->kind == SETTING_CHOICE;
    if ((words && !row->words) || (row->kind == SETTING_OWN && !row->read) ||
        (row->kind == SETTING_OWN && row->size > 0 && !row->print))
        fail_msg("%s: no words, or no functions of its own", row->name);
}

static void every_row_is_whole(void **state)
{
    (void)state;
    for (int i = 0; settings_row(i); i++) {
        const struct setting *row = settings_row(i);
        assert_ptr_equal(settings_find(row->name), row); /* no name twice */
        check_size(row);
        if (!row->help || !row->help[0])
            fail_msg("%s: no help", row->name);
        if (row->resume == RESUME_UNSTATED)
            fail_msg("%s: does it decide the bits of a run?", row->name);
        if ((row->column == NULL) == (row->seen == NULL))
            fail_msg("%s: statistics either repeat it or show what came of it",
                     row->name);
        if (row->initial && row->unset)
            fail_msg("%s: it has a default and has none", row->name);
    }
    assert_null(settings_row(-1));
}

/* What a row takes is what it prints, and what it prints it takes. */
static void check_round_trip(const struct setting *row, const char *value)
{
    struct settings once, twice;
    struct text first = {0}, second = {0};
    struct err err = {0};
    settings_init(&once);
    settings_init(&twice);
    assert_true(settings_set(&once, row->name, value, NULL, &err));
    setting_print(row, &once, &first);
    if (row->size > 0) {
        if (first.length == 0)
            fail_msg("%s=%s prints nothing", row->name, value);
        assert_true(settings_set(&twice, row->name, first.data, NULL, &err));
        setting_print(row, &twice, &second);
        assert_string_equal(first.data, second.data);
        assert_memory_equal(&once, &twice, sizeof once);
    }
    mem_free(first.data);
    mem_free(second.data);
}

static void values_survive_print_and_parse(void **state)
{
    (void)state;
    for (int i = 0; settings_row(i); i++) {
        struct setting_examples e = setting_examples(settings_row(i), false);
        if (e.count == 0)
            fail_msg("%s: no example", settings_row(i)->name);
        for (int j = 0; j < e.count; j++)
            check_round_trip(settings_row(i), e.texts[j]);
    }
}

/* Different texts of one setting are different settings, but for those that stand for
 * each other. */
static void words_differ(void **state)
{
    (void)state;
    for (int i = 0; settings_row(i); i++) {
        const struct setting *row = settings_row(i);
        bool words = row->kind == SETTING_NAME || row->kind == SETTING_CHOICE;
        for (const struct setting_word *w = row->words; words && w->word; w++)
            for (const struct setting_word *v = row->words; v != w; v++) {
                assert_string_not_equal(w->word, v->word);
                if (row->kind == SETTING_CHOICE && w->value == v->value)
                    fail_msg("%s: %s is %s", row->name, w->word, v->word);
            }
    }
}

/* Words of the table that are names elsewhere. */
static void integrators_are_those_of_the_registry(void **state)
{
    (void)state;
    const struct setting_word *word = settings_find("integrator")->words;
    for (int i = 0; integrator_types[i]; i++, word++) {
        assert_non_null(word->word);
        assert_string_equal(word->word, integrator_types[i]->name);
        bool chains = ((int)word->value & SETTING_CHAINS) != 0;
        assert_int_equal(chains, integrator_types[i]->methods->chains);
    }
    assert_null(word->word);
}

static void kernels_are_those_of_chains(void **state)
{
    (void)state;
    const struct setting_word *word = settings_find("kernel")->words;
    for (int i = 0; kernel_types[i]; i++, word++)
        assert_string_equal(word->word, kernel_types[i]->name);
    assert_null(word->word);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_field_has_one_row),
        cmocka_unit_test(every_row_is_whole),
        cmocka_unit_test(values_survive_print_and_parse),
        cmocka_unit_test(words_differ),
        cmocka_unit_test(integrators_are_those_of_the_registry),
        cmocka_unit_test(kernels_are_those_of_chains),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
