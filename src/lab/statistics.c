#include "lab/statistics.h"

#include "base/machine.h"
#include "base/mem.h"
#include "build_info.h"
#include "integrator/registry.h"
#include "lab/scalar.h"

#include <stdio.h>
#include <string.h>

/* LIST is text in the record itself. */
enum kind { TEXT, LIST, NUMBER, LONG, INT, FLAG };

enum scope { ALL, CHAINS };

struct row {
    const char *name;
    enum kind kind;
    enum scope scope;
    size_t offset; /* into struct statistics_record */
};

#define AT(field)    offsetof(struct statistics_record, field)
#define RUN(field)   offsetof(struct statistics_record, run.statistics.field)
#define SET(field)   offsetof(struct statistics_record, settings.field)
#define FOUND(field) offsetof(struct statistics_record, run.verdict.field)
#define CAUSE(cause) RUN(counters.failures[cause])

static const struct row rows[] = {
    {"scene", TEXT, ALL, AT(scene)},
    {"integrator", TEXT, ALL, SET(integrator)},
    {"mode", TEXT, CHAINS, AT(mode)},
    {"kernel", TEXT, CHAINS, AT(kernel)},
    {"estimator", TEXT, CHAINS, AT(estimator)},
    {"builder", TEXT, CHAINS, AT(builder)},
    {"max_depth", INT, ALL, AT(run.max_depth)},
    {"chains", LONG, CHAINS, RUN(chains)},
    {"bootstrap_paths", NUMBER, ALL, RUN(bootstrap_paths)},
    {"seed", LONG, ALL, SET(seed)},
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
    {"longest_stay", NUMBER, CHAINS, RUN(longest_stay)},
    {"chains_never_moved", NUMBER, CHAINS, RUN(chains_never_moved)},
    {"interrupted", FLAG, ALL, AT(run.interrupted)},
    {"sigma", NUMBER, CHAINS, AT(sigma)},
    {"s1", NUMBER, CHAINS, AT(s1)},
    {"s2", NUMBER, CHAINS, AT(s2)},
    {"rule", TEXT, CHAINS, SET(rule)},
    {"start", NUMBER, CHAINS, SET(start)},
    {"start_cap", NUMBER, CHAINS, SET(start_cap)},
    {"budget_seconds", NUMBER, ALL, SET(seconds)},
    {"budget_mutations_per_pixel", NUMBER, ALL, SET(mutations_per_pixel)},
    {"keep_all", FLAG, ALL, SET(keep_all)},
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
    {"per", TEXT, CHAINS, AT(per)},
    {"direct", TEXT, CHAINS, AT(direct)},
    {"allocation", TEXT, CHAINS, AT(allocation)},
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
    {"replica_agreement", NUMBER, ALL, FOUND(agreement)},
    {"rhat_max", NUMBER, ALL, FOUND(rhat_max)},
    {"rhat_tiles", INT, ALL, FOUND(tiles)},
    {"rhat_tiles_bad", INT, ALL, FOUND(tiles_bad)},
    {"ess_min", NUMBER, ALL, FOUND(ess_min)},
    {"relmse_estimated", NUMBER, ALL, FOUND(relmse)},
    {"relmse_estimated_se", NUMBER, ALL, FOUND(relmse_se)},
    {"se_bar_95", NUMBER, ALL, FOUND(bar_95)},
    {"energy_top", NUMBER, ALL, FOUND(energy_top)},
    {"never_moved_share", NUMBER, CHAINS, FOUND(never_share)},
    {"longest_stay_share", NUMBER, CHAINS, FOUND(stay_share)},
    {"memory_films", NUMBER, ALL, AT(run.memory.films)},
    {"memory_peak", NUMBER, ALL, AT(memory_peak)},
    {"unsampled_share", NUMBER, ALL, RUN(unsampled)},
    {"blind_to", LIST, ALL, AT(run.blind_to)},
    {"until_converged", FLAG, ALL, SET(until_converged)},
    {"until_relmse", NUMBER, ALL, SET(until_relmse)},
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
};

#define ROW_COUNT ((int)(sizeof rows / sizeof rows[0]))

static void list_append(struct statistics_record *record, enum statistics_list list,
                        double value)
{
    char *text = record->lists[list];
    size_t used = strlen(text);
    snprintf(text + used, STATISTICS_LIST_SIZE - used, "%s%.6g", used ? " " : "", value);
}

static void fill_lists(struct statistics_record *record)
{
    for (int i = 0; i < record->run.statistics.length_count; i++) {
        const struct length_statistics *l = &record->run.statistics.lengths[i];
        list_append(record, LIST_LENGTHS, l->length);
        list_append(record, LIST_CHAINS, l->chains);
        list_append(record, LIST_B, l->b);
        list_append(record, LIST_B_SE, l->b_se);
        list_append(record, LIST_P_L, l->p_l);
        list_append(record, LIST_ETA_S, l->whole.eta_s);
        list_append(record, LIST_ETA_L, l->whole.eta_l);
        list_append(record, LIST_ETA_0, l->whole.eta_0);
        list_append(record, LIST_FAILURE_RATE, l->failure_rate);
    }
}

/* What only some of the chain integrators have is left empty for the others. */
static void fill_designs(struct statistics_record *record)
{
    const struct settings *settings = &record->settings;
    bool multiplexed = record->run.statistics.length_count > 0;
    bool pfmlt = text_equal(settings->integrator, "pfmlt");
    record->builder = multiplexed ? "" : settings->builder;
    record->per = !multiplexed ? "" : settings->per_length ? "length" : "all";
    bool separate = record->run.statistics.plain_lengths > 0;
    record->direct = !multiplexed ? "" : separate ? "separate" : "joint";
    record->allocation = !multiplexed              ? ""
                         : settings->by_brightness ? "brightness"
                                                   : "error";
    record->mode = pfmlt ? settings->mode : "";
    record->biased = pfmlt && text_equal(settings->mode, "paper");
    record->p_l_counted = plarge_counted(&record->run.statistics.start);
}

static void fill_chains(struct statistics_record *record)
{
    const struct settings *settings = &record->settings;
    struct kernel kernel;
    kernel_init(&kernel, settings_kernel(settings), settings->sigma, settings->s1,
                settings->s2);
    record->kernel = kernel.type->name;
    record->sigma = kernel.sigma;
    record->s1 = kernel.s1;
    record->s2 = kernel.s2;
    record->estimator = settings_estimator(settings) == ESTIMATOR_KELEMEN ? "kelemen"
                                                                          : "plain";
    record->p_l_source = record->run.statistics.plarge_auto ? "auto" : "manual";
    record->p_l_reason = "not decided: the run ended before its measured start did";
    if (record->run.statistics.plarge.reason[0])
        record->p_l_reason = record->run.statistics.plarge.reason;
}

void statistics_record_init(struct statistics_record *record,
                            const struct run_result *run, const struct settings *settings,
                            const struct scene *scene, const char *left_out)
{
    *record = (struct statistics_record){
        .scene = scene->desc->path,
        .left_out = left_out,
        .mode = "",
        .commit = BUILD_COMMIT,
        .compiler = BUILD_COMPILER,
        .flags = BUILD_FLAGS,
        .rays = accel_description(scene->accel),
        .chains = integrator_find(settings->integrator)->methods->chains,
        .width = scene->camera.width,
        .height = scene->camera.height,
        .emission_scale = scene->emission_scale,
        .seconds_load = scene->load_seconds,
        .memory_peak = machine_memory_peak(),
        .settings = *settings,
        .run = *run,
        .verdict = verdict_name(run->verdict.call),
        .ended_by = run_end_name(run->end),
    };
    machine_cpu_model(record->cpu_model, sizeof record->cpu_model);
    fill_chains(record);
    fill_designs(record);
    fill_lists(record);
}

int statistics_count(void)
{
    return ROW_COUNT;
}

const char *statistics_name(int index)
{
    return rows[index].name;
}

static void append_value(struct text *text, const struct statistics_record *record,
                         int index, bool quoted)
{
    const struct row *row = &rows[index];
    const void *at = (const char *)record + row->offset;
    bool absent = row->scope == CHAINS && !record->chains;
    if (row->kind == TEXT || row->kind == LIST) {
        const char *value = row->kind == LIST ? at : *(const char *const *)at;
        value = absent ? "" : value;
        if (quoted)
            scalar_append_string(text, value);
        else
            text_append(text, "%s", value);
    } else if (absent) {
        scalar_append_number(text, (double)NAN);
    } else if (row->kind == NUMBER) {
        scalar_append_number(text, *(const double *)at);
    } else if (row->kind == LONG) {
        text_append(text, "%ld", *(const long *)at);
    } else if (row->kind == INT) {
        text_append(text, "%d", *(const int *)at);
    } else {
        text_append(text, *(const bool *)at ? "true" : "false");
    }
}

void statistics_append(struct text *text, const struct statistics_record *record,
                       int index)
{
    append_value(text, record, index, true);
}

char *statistics_yaml(const struct statistics_record *record)
{
    struct text text = {0};
    for (int i = 0; i < ROW_COUNT; i++) {
        text_append(&text, "%s: ", rows[i].name);
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
    struct exr_attribute *attributes = mem_alloc((size_t)ROW_COUNT, sizeof *attributes);
    for (int i = 0; i < ROW_COUNT; i++) {
        struct text value = {0};
        append_value(&value, record, i, false);
        attributes[i].name = text_format("etalon:%s", rows[i].name);
        attributes[i].value = value.data;
    }
    *count = ROW_COUNT;
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
