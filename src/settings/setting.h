#ifndef ETALON_SETTINGS_SETTING_H
#define ETALON_SETTINGS_SETTING_H

/* One row of the table of settings: everything about a setting except its effect. */

#include "base/text.h"
#include "settings/settings.h"

/* What the field holds. */
enum setting_kind {
    SETTING_FLAG,   /* bool */
    SETTING_COUNT,  /* long in [min,max], or one of `words` */
    SETTING_NUMBER, /* double in [min,max], or one of `words` */
    SETTING_NAME,   /* const char *: one of `words` */
    SETTING_CHOICE, /* enum: the value of one of `words` */
    SETTING_OWN,    /* read and printed by the row's own functions */
};

/* A word, and the value that a count, a number or an enum takes from it. */
struct setting_word {
    const char *word; /* NULL ends a list */
    double value;
};

/* Which integrators read a setting; 0: all. The words of `integrator` have these sets as
 * values. */
enum {
    SETTING_CHAINS = 1,      /* pssmlt, mmlt, pfmlt, rjmlt, smlt, mlt */
    SETTING_BUILDER = 2,     /* pssmlt, smlt */
    SETTING_LENGTHS = 4,     /* mmlt, pfmlt, rjmlt, smlt */
    SETTING_MODES = 8,       /* pfmlt, rjmlt */
    SETTING_DIRECT = 16,     /* mmlt, pfmlt, rjmlt, mlt */
    SETTING_SPLIT = 32,      /* pssmlt, mmlt, smlt */
    SETTING_GUESS = 64,      /* pssmlt, mmlt */
    SETTING_SMLT = 128,      /* that one */
    SETTING_RJMLT = 256,     /* that one */
    SETTING_MLT = 512,       /* that one */
    SETTING_PRIMARY = 1024,  /* all with chains but mlt */
    SETTING_CONNECTS = 2048, /* pssmlt, bdpt */
    SETTING_PASSES = 4096,   /* pt, bdpt, and auto, which may choose them */
};

/* What resuming from a checkpoint requires of a setting. */
enum setting_resume {
    RESUME_UNSTATED, /* not stated: a test rejects the row */
    RESUME_SAME,     /* it determines the bits of the run: part of its identity */
    RESUME_BUDGET,   /* checkpoint_open compares it with the work done */
    RESUME_FREE,     /* it does not change the bits rendered so far */
};

struct setting {
    const char *name; /* key in files and of --set */
    enum setting_kind kind;
    int readers;         /* SETTING_CHAINS, ...; 0: all integrators */
    size_t offset, size; /* of the field; size 0: another spelling of other settings */
    double min, max;
    const struct setting_word *words;
    const char *initial; /* default, as a user would write it; NULL: the field is 0 */
    const char *unset;   /* meaning of a field that is 0, if there is no default */
    const char
        *noun; /* name of a count or a number in help; NULL: "a count" or "a number" */
    const char *values; /* values in help; NULL: made from kind, words and range */
    const char *help;   /* what it does */
    enum setting_resume resume;
    const char *column; /* statistics column that repeats the resolved value */
    const char *seen; /* without `column`: the statistics column that shows its effect */
    size_t clears;    /* offset of a double that is set to 0 as well; 0: none */
    bool (*read)(const struct setting *setting, struct settings *s, const char *value,
                 const struct place *at, struct err *err);
    void (*print)(const struct setting *setting, const struct settings *s,
                  struct text *text);
};

/* The table, in the order of help and document; NULL past its end. */
const struct setting *settings_row(int index);
const struct setting *settings_find(const char *name); /* NULL if there is none */

/* Sets the field from text. On failure the error lists the valid values, and the field is
 * unchanged. */
bool setting_read(const struct setting *setting, struct settings *s, const char *value,
                  const struct place *at, struct err *err);

/* Appends the value as setting_read takes it; nothing if it is left open. */
void setting_print(const struct setting *setting, const struct settings *s,
                   struct text *text);

/* Whether the chosen integrator reads it. */
bool setting_used(const struct setting *setting, const struct settings *s);

const void *setting_field(const struct setting *setting, const struct settings *s);

/* The integrators that read it, unless all do or all with chains; else "". */
const char *setting_readers(const struct setting *setting);

/* Append, for people: which values it takes ("a count in [1,1e6]"), its default (nothing
 * if there is none), and the line of help: values, what it does, readers, default. */
void setting_values(const struct setting *setting, struct text *text);
void setting_default(const struct setting *setting, struct text *text);
void setting_help(const struct setting *setting, struct text *text);

#endif
