/* Fills in the record from the results of a run. */
#include "lab/statistics.h"

#include "base/machine.h"
#include "build_info.h"
#include "integrator/registry.h"

#include <stdio.h>
#include <string.h>

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

static void fill_moves(struct statistics_record *record)
{
    for (int i = 0; i < record->run.statistics.move_count; i++) {
        const struct move_statistics *m = &record->run.statistics.moves[i];
        char *names = record->lists[LIST_MOVES];
        size_t used = strlen(names);
        snprintf(names + used, STATISTICS_LIST_SIZE - used, "%s%s", used ? " " : "",
                 m->name);
        list_append(record, LIST_MOVES_PROPOSED, m->proposed);
        list_append(record, LIST_MOVES_ACCEPTANCE, m->acceptance);
        list_append(record, LIST_MOVES_SUBPATH,
                    m->failures[FAILURE_CAMERA_PATH] + m->failures[FAILURE_LIGHT_PATH]);
        list_append(record, LIST_MOVES_BLOCKED, m->failures[FAILURE_BLOCKED]);
        list_append(record, LIST_MOVES_ZERO, m->failures[FAILURE_ZERO]);
        list_append(record, LIST_MOVES_CLASS, m->failures[FAILURE_CLASS]);
        list_append(record, LIST_MOVES_WORK, m->work);
        list_append(record, LIST_MOVES_WEIGHT, m->weight);
    }
}

/* The curve of predicted errors, if there is one. */
static void fill_prediction(struct statistics_record *record)
{
    const struct tours_choice *c = &record->run.statistics.tours;
    record->predicted_relmse = c->found ? c->relmse : (double)NAN;
    record->predicted_halves = c->found ? c->halves : (double)NAN;
    record->predicted_clipped = c->found ? c->curve.clipped : (double)NAN;
    record->predicted_allocation = c->found ? c->allocation : (double)NAN;
    for (int i = 0; i < TOURS_POINTS && c->found; i++) {
        list_append(record, LIST_PREDICTED_P, tours_p[i]);
        list_append(record, LIST_PREDICTED_RELMSE, c->curve.relmse[i]);
        list_append(record, LIST_PREDICTED_COST, c->curve.cost[i]);
    }
}

static void fill_chains(struct statistics_record *record)
{
    const struct settings *settings = &record->settings;
    record->biased = settings_uses(settings, "mode") &&
                     text_equal(settings_mode(settings), "paper");
    record->p_l_counted = plarge_counted(&record->run.statistics.start);
    record->p_l_source = record->run.statistics.plarge_auto ? "auto" : "manual";
    record->p_l_reason = "not decided: the run ended before its measured start did";
    if (record->run.statistics.plarge.reason[0])
        record->p_l_reason = record->run.statistics.plarge.reason;
}

/* Of `auto`, whether the chosen integrator has. */
static bool has_chains(const struct settings *settings, const struct run_statistics *s)
{
    return s->race.used ? s->race.chains
                        : integrator_find(settings->integrator)->methods->chains;
}

void statistics_record_init(struct statistics_record *record,
                            const struct run_result *run, const struct settings *settings,
                            const struct scene *scene, const char *left_out)
{
    *record = (struct statistics_record){
        .scene = scene->desc->path,
        .left_out = left_out,
        .commit = BUILD_COMMIT,
        .compiler = BUILD_COMPILER,
        .flags = BUILD_FLAGS,
        .rays = accel_description(scene->accel),
        .chains = has_chains(settings, &run->statistics),
        .width = scene->camera.width,
        .height = scene->camera.height,
        .emission_scale = scene->emission_scale,
        .seconds_load = scene->load_seconds,
        .memory_peak = machine_memory_peak(),
        .settings = settings_resolve(settings, scene),
        .run = *run,
        .verdict = verdict_name(run->verdict.call),
        .ended_by = run_end_name(run->end),
    };
    machine_cpu_model(record->cpu_model, sizeof record->cpu_model);
    fill_chains(record);
    fill_lists(record);
    fill_moves(record);
    fill_prediction(record);
}
