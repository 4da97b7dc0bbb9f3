#ifndef ETALON_SETTINGS_SETTING_H
#define ETALON_SETTINGS_SETTING_H

/* One row of the table of settings: all that is known of a setting but what it does. */

#include "base/text.h"
#include "settings/settings.h"

/* What the field holds. */
enum setting_kind {
    SETTING_FLAG,   /* bool */
    SETTING_COUNT,  /* long in [min,max], or one of `words` */
    SETTING_NUMBER, /* double in [min,max], or one of `words` */
    SETTING_NAME,   /* const char *: one of `words` */
    SETTING_CHOICE, /* enum: the value of one of `words` */
    SETTING_OWN,    /* what `read` and `print` make of it */
};

/* A word, and the value that a count, a number or an enum takes from it. */
struct setting_word {
    const char *word; /* NULL ends a list */
    double value;
};

/* Which integrators read a setting: 0 is all. The words of `integrator` have as values
 * the sets that they belong to. */
enum {
    SETTING_CHAINS = 1,  /* pssmlt, mmlt, pfmlt */
    SETTING_PSSMLT = 2,  /* that one */
    SETTING_LENGTHS = 4, /* mmlt, pfmlt */
    SETTING_PFMLT = 8,   /* that one */
};

/* What going on from a checkpoint asks of a setting. */
enum setting_resume {
    RESUME_UNSTATED, /* forgotten: a test refuses it */
    RESUME_SAME,     /* it decides the bits of the run: part of its identity */
    RESUME_BUDGET,   /* checkpoint_open compares it with what was spent */
    RESUME_FREE,     /* it decides no bits of what was rendered so far */
};

struct setting {
    const char *name; /* key in files and of --set */
    enum setting_kind kind;
    int readers;         /* SETTING_CHAINS, ...; 0: all integrators */
    size_t offset, size; /* of the field; size 0: another spelling of other settings */
    double min, max;
    const struct setting_word *words;
    const char *initial; /* default, as a user would write it; NULL: the field is 0 */
    const char *unset;   /* what a field that is 0 means, if there is no default */
    const char *noun;    /* of a count or a number, in the place of "a count" */
    const char *values;  /* in the place of what follows from kind, words and range */
    const char *help;    /* what it does */
    enum setting_resume resume;
    const char *column; /* of statistics, that repeats it, as resolved */
    const char *seen; /* without one: the column of the run that shows what came of it */
    size_t clears;    /* offset of a double that is set to 0 besides; 0: none */
    bool (*read)(const struct setting *setting, struct settings *s, const char *value,
                 const struct place *at, struct err *err);
    void (*print)(const struct setting *setting, const struct settings *s,
                  struct text *text);
};

/* The table, in the order of help and document; NULL past its end. */
const struct setting *settings_row(int index);
const struct setting *settings_find(const char *name); /* NULL if there is none */

/* Sets the field from text; fails with the values that it takes and leaves it as it was.
 */
bool setting_read(const struct setting *setting, struct settings *s, const char *value,
                  const struct place *at, struct err *err);

/* Appends the value as setting_read takes it; nothing where it is left open. */
void setting_print(const struct setting *setting, const struct settings *s,
                   struct text *text);

/* Whether the chosen integrator reads it. */
bool setting_used(const struct setting *setting, const struct settings *s);

const void *setting_field(const struct setting *setting, const struct settings *s);

/* The integrators that read it, if they are not all or all with chains; else "". */
const char *setting_readers(const struct setting *setting);

/* Append, for people: which values it takes ("a count in [1,1e6]"), its default (nothing
 * if there is none), and the line of help: values, what it does, readers, default. */
void setting_values(const struct setting *setting, struct text *text);
void setting_default(const struct setting *setting, struct text *text);
void setting_help(const struct setting *setting, struct text *text);

#endif
