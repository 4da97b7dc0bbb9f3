#ifndef ETALON_LAB_STATISTICS_H
#define ETALON_LAB_STATISTICS_H

/* The statistics of one run under their public names, from one table. The YAML file, the
 * attributes of the picture and the columns of results are all made from it. Names are
 * appended at the end of the table, never renamed. Columns that repeat a setting come
 * from the table of settings; a new one follows all others until it is given its place
 * here, which must be before the next row is appended. */

#include "base/text.h"
#include "image/exr.h"
#include "run/run.h"

/* Figures by path length or move, as lists in one string. */
enum statistics_list {
    LIST_LENGTHS,
    LIST_CHAINS,
    LIST_B,
    LIST_B_SE,
    LIST_P_L,
    LIST_ETA_S,
    LIST_ETA_L,
    LIST_ETA_0,
    LIST_FAILURE_RATE,
    LIST_PREDICTED_P,
    LIST_PREDICTED_RELMSE,
    LIST_PREDICTED_COST,
    LIST_MOVES,
    LIST_MOVES_PROPOSED,
    LIST_MOVES_ACCEPTANCE,
    LIST_MOVES_SUBPATH,
    LIST_MOVES_BLOCKED,
    LIST_MOVES_ZERO,
    LIST_MOVES_CLASS,
    LIST_MOVES_WORK,
    LIST_MOVES_WEIGHT,
    LISTS
};

#define STATISTICS_LIST_SIZE 1600

/* The values of the columns. Strings are borrowed and must outlive the record. */
struct statistics_record {
    const char *scene; /* path as the user gave it */
    const char *left_out;
    const char *p_l_source, *p_l_reason;
    const char *commit, *compiler, *flags, *rays;
    const char *verdict, *ended_by;
    bool chains; /* the integrator has chains; without, columns of chains are absent */
    int width, height;
    /* p_l that the rule gives for rates per counted state (plarge_counted). */
    double p_l_counted;
    /* The rule tours (struct tours_choice); NAN without its curve. */
    double predicted_relmse, predicted_halves, predicted_clipped, predicted_allocation;
    double emission_scale, seconds_load;
    double memory_peak; /* peak memory of the process at the end of the run, bytes */
    bool biased;        /* the method does not converge to the picture */
    char cpu_model[128];
    char lists[LISTS][STATISTICS_LIST_SIZE]; /* those by length: empty unless lengths
                                                have own chains */
    struct settings settings;                /* as resolved */
    struct run_result run;
};

/* left_out: features that the scene does not need, in words. */
void statistics_record_init(struct statistics_record *record,
                            const struct run_result *run, const struct settings *settings,
                            const struct scene *scene, const char *left_out);

int statistics_count(void);
const char *statistics_name(int index);

/* Appends the value as a YAML scalar; absent values are .nan or "". */
void statistics_append(struct text *text, const struct statistics_record *record,
                       int index);

/* Flat YAML, one "name: value" a line. The caller owns it (mem_free). */
char *statistics_yaml(const struct statistics_record *record);
bool statistics_write(const char *path, const struct statistics_record *record,
                      struct err *err);

/* All of them as "etalon:name" string attributes; values are not quoted. */
struct exr_attribute *statistics_attributes(const struct statistics_record *record,
                                            int *count);
void statistics_attributes_destroy(struct exr_attribute *attributes, int count);

#endif
