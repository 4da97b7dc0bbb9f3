#include "settings/setting.h"

#include "base/mem.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void *field_at(struct settings *s, size_t offset)
{
    return (char *)s + offset;
}

const void *setting_field(const struct setting *setting, const struct settings *s)
{
    return (const char *)s + setting->offset;
}

/* --- values in words --------------------------------------------------------------- */

/* As users write it: 1e6, not 1e+06. */
static void append_number(struct text *text, double x)
{
    char digits[40];
    snprintf(digits, sizeof digits, "%g", x);
    if (strtod(digits, NULL) != x)
        snprintf(digits, sizeof digits, "%.17g", x);
    char *exponent = strchr(digits, 'e');
    if (exponent == NULL)
        text_append(text, "%s", digits);
    else
        text_append(text, "%.*se%d", (int)(exponent - digits), digits,
                    atoi(exponent + 1));
}

static bool is_ranged(const struct setting *setting)
{
    return setting->kind == SETTING_COUNT || setting->kind == SETTING_NUMBER;
}

static void append_words(const struct setting *setting, struct text *text)
{
    for (const struct setting_word *w = setting->words; w && w->word; w++) {
        bool last = w[1].word == NULL && !is_ranged(setting);
        text_append(text, "%s%s",
                    w == setting->words ? ""
                    : last              ? " or "
                                        : ", ",
                    w->word);
    }
}

void setting_values(const struct setting *setting, struct text *text)
{
    const char *noun = setting->kind == SETTING_COUNT ? "a count" : "a number";
    if (setting->values) {
        text_append(text, "%s", setting->values);
        return;
    }
    if (setting->kind == SETTING_FLAG)
        text_append(text, "true or false");
    append_words(setting, text);
    if (!is_ranged(setting))
        return;
    text_append(text, "%s%s in [", setting->words ? " or " : "",
                setting->noun ? setting->noun : noun);
    append_number(text, setting->min);
    text_append(text, ",");
    append_number(text, setting->max);
    text_append(text, "]");
}

void setting_default(const struct setting *setting, struct text *text)
{
    const char *words = setting->initial ? setting->initial : setting->unset;
    text_append(text, "%s", words ? words : "");
}

const char *setting_readers(const struct setting *setting)
{
    static const struct {
        int readers;
        const char *names;
    } sets[] = {
        {SETTING_BUILDER, "pssmlt, smlt"},
        {SETTING_LENGTHS, "mmlt, pfmlt, rjmlt, smlt over mmlt"},
        {SETTING_MODES, "pfmlt, rjmlt"},
        {SETTING_DIRECT, "mmlt, pfmlt, rjmlt, mlt"},
        {SETTING_SPLIT, "pssmlt, mmlt, smlt"},
        {SETTING_GUESS, "pssmlt, mmlt"},
        {SETTING_SMLT, "smlt"},
        {SETTING_RJMLT, "rjmlt"},
        {SETTING_MLT, "mlt"},
        {SETTING_PRIMARY, "all with chains but mlt"},
        {SETTING_CONNECTS, "pssmlt, bdpt"},
    };
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++)
        if (setting->readers == sets[i].readers)
            return sets[i].names;
    return "";
}

void setting_help(const struct setting *setting, struct text *text)
{
    const char *readers = setting_readers(setting);
    struct text initial = {0};
    setting_default(setting, &initial);
    setting_values(setting, text);
    text_append(text, ": %s", setting->help);
    if (readers[0] || initial.length > 0)
        text_append(text, " (%s%s%s%s)", readers, readers[0] ? "; " : "",
                    initial.length > 0 ? "default " : "", initial.data);
    mem_free(initial.data);
}

/* --- reading ----------------------------------------------------------------------- */

static bool refuse(const struct setting *setting, const char *value,
                   const struct place *at, struct err *err)
{
    struct text help = {0};
    setting_help(setting, &help);
    err_set(err, ERR_USAGE, at, "%s: '%s' is not possible; give %s", setting->name, value,
            help.data);
    mem_free(help.data);
    return false;
}

static const struct setting_word *find_word(const struct setting *setting,
                                            const char *value)
{
    for (const struct setting_word *w = setting->words; w && w->word; w++)
        if (text_equal(w->word, value))
            return w;
    return NULL;
}

static bool is_within(const struct setting *setting, double x)
{
    return x >= setting->min && x <= setting->max;
}

static bool take_flag(void *field, const char *value)
{
    bool yes = text_equal(value, "true");
    if (!yes && !text_equal(value, "false"))
        return false;
    *(bool *)field = yes;
    return true;
}

static bool take_count(const struct setting *setting, void *field, const char *value)
{
    const struct setting_word *word = find_word(setting, value);
    long x;
    if (word)
        x = (long)word->value;
    else if (!text_to_long(value, &x) || !is_within(setting, (double)x))
        return false;
    *(long *)field = x;
    return true;
}

static bool take_number(const struct setting *setting, void *field, const char *value)
{
    const struct setting_word *word = find_word(setting, value);
    double x;
    if (word)
        x = word->value;
    else if (!text_to_double(value, &x) || !is_within(setting, x))
        return false;
    *(double *)field = x;
    return true;
}

static bool take_word(const struct setting *setting, void *field, const char *value)
{
    const struct setting_word *word = find_word(setting, value);
    if (word == NULL)
        return false;
    if (setting->kind == SETTING_NAME) {
        *(const char **)field = word->word;
    } else {
        int chosen = (int)word->value;
        assert(setting->size == sizeof chosen);
        memcpy(field, &chosen,
               sizeof chosen); /* the enums of settings have the size of int */
    }
    return true;
}

static bool take(const struct setting *setting, void *field, const char *value)
{
    switch (setting->kind) {
    case SETTING_FLAG:
        return take_flag(field, value);
    case SETTING_COUNT:
        return take_count(setting, field, value);
    case SETTING_NUMBER:
        return take_number(setting, field, value);
    case SETTING_NAME:
    case SETTING_CHOICE:
        return take_word(setting, field, value);
    case SETTING_OWN:
        break;
    }
    return false;
}

bool setting_read(const struct setting *setting, struct settings *s, const char *value,
                  const struct place *at, struct err *err)
{
    bool own = setting->kind == SETTING_OWN;
    if (own ? !setting->read(setting, s, value, at, err)
            : !take(setting, field_at(s, setting->offset), value))
        return refuse(setting, value, at, err);
    if (setting->clears > 0)
        *(double *)field_at(s, setting->clears) = 0.0;
    return true;
}

/* --- printing ---------------------------------------------------------------------- */

/* A value outside the range stands for a word, or for a setting that is left open. */
static void print_number(const struct setting *setting, double x, struct text *text)
{
    if (is_within(setting, x)) {
        text_append(text, "%.17g", x);
        return;
    }
    for (const struct setting_word *w = setting->words; w && w->word; w++)
        if (w->value == x || (isnan(w->value) && isnan(x))) {
            text_append(text, "%s", w->word);
            return;
        }
}

static void print_choice(const struct setting *setting, const void *field,
                         struct text *text)
{
    int chosen;
    memcpy(&chosen, field, sizeof chosen);
    for (const struct setting_word *w = setting->words; w->word; w++)
        if ((int)w->value == chosen)
            text_append(text, "%s", w->word);
}

void setting_print(const struct setting *setting, const struct settings *s,
                   struct text *text)
{
    const void *field = setting_field(setting, s);
    const char *name;
    switch (setting->kind) {
    case SETTING_FLAG:
        text_append(text, *(const bool *)field ? "true" : "false");
        break;
    case SETTING_COUNT:
        print_number(setting, (double)*(const long *)field, text);
        break;
    case SETTING_NUMBER:
        print_number(setting, *(const double *)field, text);
        break;
    case SETTING_NAME:
        name = *(const char *const *)field;
        text_append(text, "%s", name ? name : "");
        break;
    case SETTING_CHOICE:
        print_choice(setting, field, text);
        break;
    case SETTING_OWN:
        if (setting->print)
            setting->print(setting, s, text);
        break;
    }
}
