#ifndef ETALON_TESTS_SUPPORT_SETTING_EXAMPLES_H
#define ETALON_TESTS_SUPPORT_SETTING_EXAMPLES_H

/* Texts that a setting takes: all words, and of numbers both ends and the default. */

#include "settings/setting.h"

#include <stdio.h>

struct setting_examples {
    int count;
    char texts[16][64];
};

static inline void setting_examples_add(struct setting_examples *e, const char *text)
{
    snprintf(e->texts[e->count++], sizeof e->texts[0], "%s", text);
}

/* `least`: of a count, in the place of its upper end what is two above the lower one: no
 * run with a thousand threads. None for a setting with a reader of its own that is not
 * listed here. */
static inline struct setting_examples setting_examples(const struct setting *setting,
                                                       bool least)
{
    static const char *const own[][2] = {
        {"budget", "seconds=3"}, {"budget", "mutations_per_pixel=3"},
        {"size", "64x48"},       {"size", "5x7"},
        {"layers", "work"},      {"layers", "failures,work"}};
    struct setting_examples e = {0};
    char text[64];
    for (const struct setting_word *w = setting->words; w && w->word; w++)
        setting_examples_add(&e, w->word);
    if (setting->kind == SETTING_FLAG) {
        setting_examples_add(&e, "true");
        setting_examples_add(&e, "false");
    }
    if (setting->kind == SETTING_COUNT || setting->kind == SETTING_NUMBER) {
        bool count = setting->kind == SETTING_COUNT;
        double most = least && count ? setting->min + 2.0 : setting->max;
        snprintf(text, sizeof text, "%.17g", setting->min);
        setting_examples_add(&e, text);
        snprintf(text, sizeof text, "%.17g", most);
        setting_examples_add(&e, text);
    }
    if (setting->initial)
        setting_examples_add(&e, setting->initial);
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (text_equal(setting->name, own[i][0]))
            setting_examples_add(&e, own[i][1]);
    return e;
}

#endif
