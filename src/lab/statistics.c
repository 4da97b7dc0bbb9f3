#include "lab/statistics.h"

#include "base/mem.h"
#include "lab/scalar.h"
#include "settings/setting.h"

#include <string.h>

/* LIST: text in the record; SETTING: place of the column of a setting. */
enum kind { TEXT, LIST, NUMBER, LONG, INT, FLAG, SETTING };

enum scope { ALL, CHAINS };

struct row {
    const char *name;
    enum kind kind;
    enum scope scope;
    size_t offset; /* into struct statistics_record */
};

#define AT(field)    offsetof(struct statistics_record, field)
#define RUN(field)   offsetof(struct statistics_record, run.statistics.field)
#define FOUND(field) offsetof(struct statistics_record, run.verdict.field)
#define CAUSE(cause) RUN(counters.failures[cause])

static const struct row rows[] = {
    {"scene", TEXT, ALL, AT(scene)},
    {"integrator", SETTING, ALL, 0},
    {"mode", SETTING, ALL, 0},
    {"kernel", SETTING, ALL, 0},
    {"estimator", SETTING, ALL, 0},
    {"builder", SETTING, ALL, 0},
    {"max_depth", INT, ALL, AT(run.max_depth)},
    {"chains", LONG, CHAINS, RUN(chains)},
    {"bootstrap_paths", NUMBER, ALL, RUN(bootstrap_paths)},
    {"seed", SETTING, ALL, 0},
    {"threads", INT, ALL, AT(run.threads)},
    {"commit", TEXT, ALL, AT(commit)},
    {"width", INT, ALL, AT(width)},
    {"height", INT, ALL, AT(height)},
    {"seconds_total", NUMBER, ALL, AT(run.seconds_total)},
    {"seconds_cpu", NUMBER, ALL, AT(run.seconds_cpu)},
    {"seconds_startup", NUMBER, ALL, RUN(seconds_startup)},
    {"paths", NUMBER, ALL, RUN(paths)},
    {"mutations_per_pixel", NUMBER, ALL, AT(run.mutations_per_pixel)},
    {"b", NUMBER, ALL, RUN(b)},
    {"b_se", NUMBER, ALL, RUN(b_se)},
    {"eta_s", NUMBER, CHAINS, RUN(start.eta_s)},
    {"eta_s_se", NUMBER, CHAINS, RUN(start.eta_s_se)},
    {"eta_l", NUMBER, CHAINS, RUN(start.eta_l)},
    {"eta_l_se", NUMBER, CHAINS, RUN(start.eta_l_se)},
    {"eta_0", NUMBER, CHAINS, RUN(start.eta_0)},
    {"eta_0_se", NUMBER, CHAINS, RUN(start.eta_0_se)},
    {"r", NUMBER, CHAINS, RUN(start.r)},
    {"r_lo", NUMBER, CHAINS, RUN(start.r_lo)},
    {"r_hi", NUMBER, CHAINS, RUN(start.r_hi)},
    {"p_l", NUMBER, CHAINS, RUN(plarge.p_l)},
    {"p_l_lo", NUMBER, CHAINS, RUN(plarge.p_l_lo)},
    {"p_l_hi", NUMBER, CHAINS, RUN(plarge.p_l_hi)},
    {"p_l_source", TEXT, CHAINS, AT(p_l_source)},
    {"p_l_reason", TEXT, CHAINS, AT(p_l_reason)},
    {"acceptance", NUMBER, CHAINS, RUN(acceptance)},
    {"failure_rate", NUMBER, CHAINS, RUN(failure_rate)},
    {"excluded", NUMBER, CHAINS, RUN(excluded)},
    {"n_nonfinite", NUMBER, ALL, RUN(nonfinite)},
    {"n_saturated", NUMBER, ALL, RUN(saturated)},
    {"left_out", TEXT, ALL, AT(left_out)},
    {"eta_s_run", NUMBER, CHAINS, RUN(whole.eta_s)},
    {"eta_s_run_se", NUMBER, CHAINS, RUN(whole.eta_s_se)},
    {"eta_l_run", NUMBER, CHAINS, RUN(whole.eta_l)},
    {"eta_l_run_se", NUMBER, CHAINS, RUN(whole.eta_l_se)},
    {"eta_0_run", NUMBER, CHAINS, RUN(whole.eta_0)},
    {"eta_0_run_se", NUMBER, CHAINS, RUN(whole.eta_0_se)},
    {"r_run", NUMBER, CHAINS, RUN(whole.r)},
    {"r_run_lo", NUMBER, CHAINS, RUN(whole.r_lo)},
    {"r_run_hi", NUMBER, CHAINS, RUN(whole.r_hi)},
    {"start_mutations", NUMBER, CHAINS, RUN(start_mutations)},
    {"start_looks", INT, CHAINS, RUN(start_looks)},
    {"p_l_unsure", FLAG, CHAINS, RUN(plarge.unsure)},
    {"longest_stay", NUMBER, CHAINS, RUN(most_rejections_in_row)},
    {"chains_never_moved", NUMBER, CHAINS, RUN(chains_never_moved)},
    {"interrupted", FLAG, ALL, AT(run.interrupted)},
    {"sigma", SETTING, ALL, 0},
    {"s1", SETTING, ALL, 0},
    {"s2", SETTING, ALL, 0},
    {"rule", SETTING, ALL, 0},
    {"start", SETTING, ALL, 0},
    {"start_cap", SETTING, ALL, 0},
    {"budget_seconds", SETTING, ALL, 0},
    {"budget_mutations_per_pixel", SETTING, ALL, 0},
    {"keep_all", SETTING, ALL, 0},
    {"emission_scale", NUMBER, ALL, AT(emission_scale)},
    {"seconds_load", NUMBER, ALL, AT(seconds_load)},
    {"rays", TEXT, ALL, AT(rays)},
    {"compiler", TEXT, ALL, AT(compiler)},
    {"flags", TEXT, ALL, AT(flags)},
    {"biased", FLAG, CHAINS, AT(biased)},
    {"total_paths", NUMBER, CHAINS, RUN(counters.total)},
    {"excluded_paths", NUMBER, CHAINS, RUN(counters.excluded)},
    {"final_failure_paths", NUMBER, CHAINS, RUN(counters.final_failures)},
    {"acceptance_paths", NUMBER, CHAINS, RUN(counters.accepted)},
    {"final_failure_rate", NUMBER, CHAINS, RUN(final_failure_rate)},
    {"acceptance_rate", NUMBER, CHAINS, RUN(acceptance_rate)},
    {"failures_camera_path", NUMBER, CHAINS, CAUSE(FAILURE_CAMERA_PATH)},
    {"failures_light_path", NUMBER, CHAINS, CAUSE(FAILURE_LIGHT_PATH)},
    {"failures_blocked", NUMBER, CHAINS, CAUSE(FAILURE_BLOCKED)},
    {"failures_zero", NUMBER, CHAINS, CAUSE(FAILURE_ZERO)},
    {"second_stage_paths", NUMBER, CHAINS, RUN(counters.second_stage)},
    {"second_stage_acceptance", NUMBER, CHAINS, RUN(second_acceptance)},
    {"z_small", NUMBER, CHAINS, RUN(start.z_small)},
    {"p_l_counted", NUMBER, CHAINS, AT(p_l_counted)},
    {"per", SETTING, ALL, 0},
    {"direct", SETTING, ALL, 0},
    {"allocation", SETTING, ALL, 0},
    {"plain_samples", NUMBER, CHAINS, RUN(plain_samples)},
    {"plain_b", NUMBER, CHAINS, RUN(plain_b)},
    {"plain_b_se", NUMBER, CHAINS, RUN(plain_b_se)},
    {"by_length", LIST, CHAINS, AT(lists[LIST_LENGTHS])},
    {"chains_by_length", LIST, CHAINS, AT(lists[LIST_CHAINS])},
    {"b_by_length", LIST, CHAINS, AT(lists[LIST_B])},
    {"b_se_by_length", LIST, CHAINS, AT(lists[LIST_B_SE])},
    {"p_l_by_length", LIST, CHAINS, AT(lists[LIST_P_L])},
    {"eta_s_run_by_length", LIST, CHAINS, AT(lists[LIST_ETA_S])},
    {"eta_l_run_by_length", LIST, CHAINS, AT(lists[LIST_ETA_L])},
    {"eta_0_run_by_length", LIST, CHAINS, AT(lists[LIST_ETA_0])},
    {"failure_rate_run_by_length", LIST, CHAINS, AT(lists[LIST_FAILURE_RATE])},
    {"cpu_model", LIST, ALL, AT(cpu_model)},
    {"verdict", TEXT, ALL, AT(verdict)},
    {"verdict_reason", LIST, ALL, FOUND(words)},
    {"replicas", INT, ALL, FOUND(replicas)},
    {"replica_spans", INT, ALL, FOUND(spans)},
    {"replica_agreement", NUMBER, ALL, FOUND(agreement_p)},
    {"rhat_max", NUMBER, ALL, FOUND(rhat_max)},
    {"rhat_tiles", INT, ALL, FOUND(tiles)},
    {"rhat_tiles_bad", INT, ALL, FOUND(tiles_bad)},
    {"ess_min", NUMBER, ALL, FOUND(ess_min)},
    {"relmse_estimated", NUMBER, ALL, FOUND(relmse)},
    {"relmse_estimated_se", NUMBER, ALL, FOUND(relmse_se)},
    {"se_bar_95", NUMBER, ALL, FOUND(bar_95)},
    {"energy_top", NUMBER, ALL, FOUND(energy_top)},
    {"never_moved_share", NUMBER, CHAINS, FOUND(never_moved_share)},
    {"longest_stay_share", NUMBER, CHAINS, FOUND(stuck_share)},
    {"memory_films", NUMBER, ALL, AT(run.memory.films)},
    {"memory_peak", NUMBER, ALL, AT(memory_peak)},
    {"unsampled_share", NUMBER, ALL, RUN(unsampled)},
    {"blind_to", LIST, ALL, AT(run.blind_to)},
    {"until_converged", SETTING, ALL, 0},
    {"until_relmse", SETTING, ALL, 0},
    {"ended_by", TEXT, ALL, AT(ended_by)},
    {"until_looks", INT, ALL, AT(run.until.looks)},
    {"until_relmse_bound", NUMBER, ALL, AT(run.until.bound)},
    {"acceptance_se", NUMBER, CHAINS, RUN(whole.acceptance_se)},
    {"acceptance_freedom", NUMBER, CHAINS, RUN(whole.acceptance_freedom)},
    {"failure_rate_se", NUMBER, CHAINS, RUN(whole.failure_rate_se)},
    {"failure_rate_freedom", NUMBER, CHAINS, RUN(whole.failure_rate_freedom)},
    {"acceptance_start", NUMBER, CHAINS, RUN(start.acceptance)},
    {"acceptance_start_se", NUMBER, CHAINS, RUN(start.acceptance_se)},
    {"failure_rate_start", NUMBER, CHAINS, RUN(start.failure_rate)},
    {"failure_rate_start_se", NUMBER, CHAINS, RUN(start.failure_rate_se)},
    {"p_l_se", NUMBER, CHAINS, RUN(plarge.p_l_se)},
    {"p_l_freedom", NUMBER, CHAINS, RUN(plarge.p_l_freedom)},
    {"r_se", NUMBER, CHAINS, RUN(start.r_se)},
    {"r_freedom", NUMBER, CHAINS, RUN(start.r_freedom)},
    {"r_run_se", NUMBER, CHAINS, RUN(whole.r_se)},
    {"r_run_freedom", NUMBER, CHAINS, RUN(whole.r_freedom)},
    {"eta_s_freedom", NUMBER, CHAINS, RUN(start.eta_s_freedom)},
    {"eta_l_freedom", NUMBER, CHAINS, RUN(start.eta_l_freedom)},
    {"eta_0_freedom", NUMBER, CHAINS, RUN(start.eta_0_freedom)},
    {"eta_s_run_freedom", NUMBER, CHAINS, RUN(whole.eta_s_freedom)},
    {"eta_l_run_freedom", NUMBER, CHAINS, RUN(whole.eta_l_freedom)},
    {"eta_0_run_freedom", NUMBER, CHAINS, RUN(whole.eta_0_freedom)},
    {"b_freedom", NUMBER, CHAINS, RUN(b_freedom)},
    {"b_samples", NUMBER, CHAINS, RUN(b_samples)},
    {"b_trusted", FLAG, CHAINS, RUN(b_trusted)},
    {"seeds", NUMBER, CHAINS, RUN(whole.seeds)},
    {"seeds_effective", NUMBER, CHAINS, RUN(seeds_effective)},
    {"n_edges_cut", NUMBER, ALL, RUN(edges_cut)},
    {"p_l_zsolnai2013", NUMBER, CHAINS, RUN(p_l_zsolnai2013)},
    {"predicted_p", LIST, CHAINS, AT(lists[LIST_PREDICTED_P])},
    {"predicted_relmse", LIST, CHAINS, AT(lists[LIST_PREDICTED_RELMSE])},
    {"predicted_cost", LIST, CHAINS, AT(lists[LIST_PREDICTED_COST])},
    {"predicted_relmse_at_p_l", NUMBER, CHAINS, AT(predicted_relmse)},
    {"predicted_halves_regret", NUMBER, CHAINS, AT(predicted_halves)},
    {"predicted_clipped", NUMBER, CHAINS, AT(predicted_clipped)},
    {"predicted_allocation_gain", NUMBER, CHAINS, AT(predicted_allocation)},
    {"jump_probability", SETTING, ALL, 0},
    {"jumps", NUMBER, CHAINS, RUN(jumps)},
    {"jump_acceptance", NUMBER, CHAINS, RUN(jump_acceptance)},
    {"failures_inverse", NUMBER, CHAINS, CAUSE(FAILURE_INVERSE)},
    {"metropolis", SETTING, ALL, 0},
    {"two_stage", SETTING, ALL, 0},
    {"split_floor", NUMBER, CHAINS, RUN(split.floor)},
    {"split_ceiling", NUMBER, CHAINS, RUN(split.ceiling)},
    {"split_passes", NUMBER, CHAINS, RUN(split.passes)},
    {"split_large", NUMBER, CHAINS, RUN(split.large)},
    {"split_b", NUMBER, CHAINS, RUN(split.b)},
    {"split_b_se", NUMBER, CHAINS, RUN(split.b_se)},
    {"split_samples", NUMBER, CHAINS, RUN(split.samples)},
    {"split_relmse", NUMBER, CHAINS, RUN(split.relmse)},
    {"split_passes_alone", NUMBER, CHAINS, RUN(split.passes_alone)},
    {"split_chains_alone", NUMBER, CHAINS, RUN(split.chains_alone)},
    {"split_reason", LIST, CHAINS, RUN(split.reason)},
    {"by_move", LIST, CHAINS, AT(lists[LIST_MOVES])},
    {"proposed_by_move", LIST, CHAINS, AT(lists[LIST_MOVES_PROPOSED])},
    {"acceptance_by_move", LIST, CHAINS, AT(lists[LIST_MOVES_ACCEPTANCE])},
    {"failures_subpath_by_move", LIST, CHAINS, AT(lists[LIST_MOVES_SUBPATH])},
    {"failures_blocked_by_move", LIST, CHAINS, AT(lists[LIST_MOVES_BLOCKED])},
    {"failures_zero_by_move", LIST, CHAINS, AT(lists[LIST_MOVES_ZERO])},
    {"failures_class", NUMBER, CHAINS, CAUSE(FAILURE_CLASS)},
    {"failures_class_by_move", LIST, CHAINS, AT(lists[LIST_MOVES_CLASS])},
    {"work_by_move", LIST, CHAINS, AT(lists[LIST_MOVES_WORK])},
    {"weight_by_move", LIST, CHAINS, AT(lists[LIST_MOVES_WEIGHT])},
    {"layers", SETTING, ALL, 0},
    {"chosen", LIST, ALL, RUN(race.chosen)},
    {"chosen_reason", LIST, ALL, RUN(race.reason)},
    {"chosen_relmse", NUMBER, ALL, RUN(race.relmse)},
    {"race_paths", NUMBER, ALL, RUN(race.paths)},
    {"shadow_rays", SETTING, ALL, 0},
    {"film_sampling", SETTING, ALL, 0},
    {"film_sampling_start", NUMBER, ALL, RUN(adaptive.start)},
    {"film_sampling_predicted", NUMBER, ALL, RUN(adaptive.predicted)},
};

#define ROW_COUNT ((int)(sizeof rows / sizeof rows[0]))

static const struct setting *setting_of(const char *column)
{
    for (int i = 0; settings_row(i); i++)
        if (settings_row(i)->column && text_equal(settings_row(i)->column, column))
            return settings_row(i);
    return NULL;
}

static bool has_place(const char *column)
{
    for (int i = 0; i < ROW_COUNT; i++)
        if (rows[i].kind == SETTING && text_equal(rows[i].name, column))
            return true;
    return false;
}

/* The index-th column of settings that have no place in the rows; these follow the rows,
 * in the order of the table of settings. NULL past the end. */
static const struct setting *appended(int index)
{
    for (int i = 0; settings_row(i); i++) {
        const struct setting *setting = settings_row(i);
        if (setting->column && !has_place(setting->column) && index-- == 0)
            return setting;
    }
    return NULL;
}

int statistics_count(void)
{
    int count = ROW_COUNT;
    while (appended(count - ROW_COUNT))
        count++;
    return count;
}

const char *statistics_name(int index)
{
    return index < ROW_COUNT ? rows[index].name : appended(index - ROW_COUNT)->column;
}

/* Absent values are "" for texts and .nan for numbers. */
static void append_scalar(struct text *text, enum kind kind, const void *at, bool absent,
                          bool quoted)
{
    if (kind == TEXT || kind == LIST) {
        const char *value = kind == LIST ? at : *(const char *const *)at;
        value = absent ? "" : value;
        if (quoted)
            scalar_append_string(text, value);
        else
            text_append(text, "%s", value);
    } else if (absent) {
        scalar_append_number(text, (double)NAN);
    } else if (kind == NUMBER) {
        scalar_append_number(text, *(const double *)at);
    } else if (kind == LONG) {
        text_append(text, "%ld", *(const long *)at);
    } else if (kind == INT) {
        text_append(text, "%d", *(const int *)at);
    } else {
        text_append(text, *(const bool *)at ? "true" : "false");
    }
}

/* A setting that the integrator does not read is absent. */
static void append_setting(struct text *text, const struct statistics_record *record,
                           const struct setting *setting, bool quoted)
{
    static const enum kind kinds[] = {
        [SETTING_FLAG] = FLAG, [SETTING_COUNT] = LONG,  [SETTING_NUMBER] = NUMBER,
        [SETTING_NAME] = LIST, [SETTING_CHOICE] = LIST, [SETTING_OWN] = LIST,
    };
    const struct settings *s = &record->settings;
    enum kind kind = kinds[setting->kind];
    struct text words = {0};
    text_append(&words, "%s", "");
    setting_print(setting, s, &words);
    append_scalar(text, kind, kind == LIST ? words.data : setting_field(setting, s),
                  !setting_used(setting, s), quoted);
    mem_free(words.data);
}

static void append_value(struct text *text, const struct statistics_record *record,
                         int index, bool quoted)
{
    const struct row *row = index < ROW_COUNT ? &rows[index] : NULL;
    if (row == NULL)
        append_setting(text, record, appended(index - ROW_COUNT), quoted);
    else if (row->kind == SETTING)
        append_setting(text, record, setting_of(row->name), quoted);
    else
        append_scalar(text, row->kind, (const char *)record + row->offset,
                      row->scope == CHAINS && !record->chains, quoted);
}

void statistics_append(struct text *text, const struct statistics_record *record,
                       int index)
{
    append_value(text, record, index, true);
}

char *statistics_yaml(const struct statistics_record *record)
{
    struct text text = {0};
    int count = statistics_count();
    for (int i = 0; i < count; i++) {
        text_append(&text, "%s: ", statistics_name(i));
        append_value(&text, record, i, true);
        text_append(&text, "\n");
    }
    return text.data;
}

bool statistics_write(const char *path, const struct statistics_record *record,
                      struct err *err)
{
    char *yaml = statistics_yaml(record);
    bool ok = text_write_file(path, yaml, strlen(yaml), err);
    mem_free(yaml);
    return ok;
}

struct exr_attribute *statistics_attributes(const struct statistics_record *record,
                                            int *count)
{
    *count = statistics_count();
    struct exr_attribute *attributes = mem_alloc((size_t)*count, sizeof *attributes);
    for (int i = 0; i < *count; i++) {
        struct text value = {0};
        append_value(&value, record, i, false);
        attributes[i].name = text_format("etalon:%s", statistics_name(i));
        attributes[i].value = value.data;
    }
    return attributes;
}

void statistics_attributes_destroy(struct exr_attribute *attributes, int count)
{
    for (int i = 0; i < count; i++) {
        mem_free((char *)attributes[i].name);
        mem_free((char *)attributes[i].value);
    }
    mem_free(attributes);
}
