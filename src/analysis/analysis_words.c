#include "analysis/analysis_words.h"

#include "base/mem.h"
#include "image/metric.h"

#include <math.h>

#define MOST_NAMED 5 /* methods behind the best */

const char *analysis_error_words(enum results_error error)
{
    static const char *const words[RESULTS_ERRORS] = {
        [RESULTS_RELMSE] = "relMSE of all pixels",
        [RESULTS_RELMSE_TRIMMED] = ("relMSE " METRIC_TRIM_WORDS),
        [RESULTS_MSE] = "MSE",
        [RESULTS_ESTIMATED] = "relMSE by each run's own error bars",
    };
    return words[error];
}

void analysis_append_group(struct text *text, const struct results_cell *group)
{
    char *budget = results_budget(group);
    text_append(text, "%s, %s", group->scene, budget);
    mem_free(budget);
}

/* --- who is best ----------------------------------------------------------------- */

static void append_name(struct text *text, const struct results_cell *cell)
{
    text_append(text, "%s%s", cell->label, cell->is_biased ? " (biased)" : "");
}

static void append_ratio(struct text *text, const struct interval *ratio)
{
    text_append(text, "%.3g", ratio->value);
    if (interval_is_known(ratio))
        text_append(text, " [%.3g, %.3g]", ratio->lo, ratio->hi);
}

/* "pt is best", or "pt is lowest, not told apart from mmlt, pssmlt". */
static void append_first(struct text *text, const struct analysis_ranking *ranking)
{
    size_t together = 0;
    for (size_t i = 1; i < ranking->count; i++)
        together += !ranking->items[i].is_apart;
    append_name(text, ranking->items[0].cell);
    text_append(text,
                together == 0 ? " is best" : " is lowest, but not told apart from ");
    if (together == ranking->count - 1 && together > MOST_NAMED) {
        text_append(text, "any other");
        return;
    }
    for (size_t i = 1, named = 0; i < ranking->count; i++) {
        if (ranking->items[i].is_apart)
            continue;
        text_append(text, "%s", named++ ? ", " : "");
        append_name(text, ranking->items[i].cell);
    }
}

static void append_others(struct text *text, const struct analysis_ranking *ranking)
{
    for (size_t i = 1; i < ranking->count && i <= MOST_NAMED; i++) {
        const struct analysis_rank *rank = &ranking->items[i];
        text_append(text, i > 1 ? ", " : "; ");
        append_name(text, rank->cell);
        text_append(text, i > 1 ? " " : " has ");
        append_ratio(text, &rank->ratio);
        text_append(text, i > 1 ? "" : " times its error");
    }
    if (ranking->count > MOST_NAMED + 1)
        text_append(text, ", and %zu more", ranking->count - MOST_NAMED - 1);
}

void analysis_append_best(struct text *text, const struct analysis_ranking *ranking)
{
    if (ranking->count == 0) {
        text_append(text, "no error is known");
        return;
    }
    if (ranking->count == 1) {
        append_name(text, ranking->items[0].cell);
        text_append(text, " has %.3g, and nothing to compare with",
                    ranking->items[0].error);
    } else {
        append_first(text, ranking);
        append_others(text, ranking);
    }
    if (ranking->by_bars)
        text_append(text, "; 1 seed: intervals by each run's own error bars");
    else if (ranking->seeds == 1)
        text_append(text, "; 1 seed: nothing tells the differences from chance");
    else
        text_append(text, "; %zu seeds", ranking->seeds);
}

/* --- regret ---------------------------------------------------------------------- */

static void append_policy(struct text *text, const struct analysis_policy *policy)
{
    if (policy->cells == 0) {
        text_append(text, "%s: not known", policy->name);
        return;
    }
    text_append(text, "%s: %.3f in the geometric mean of %zu cell%s", policy->name,
                policy->mean, policy->cells, policy->cells == 1 ? "" : "s");
    if (policy->left_out > 0)
        text_append(text, " of %zu", policy->cells + policy->left_out);
    text_append(text, ", %.3f at worst (%s)", policy->worst, policy->worst_name);
}

void analysis_append_regret(struct text *text, const struct analysis_summary *summary)
{
    const struct analysis_policy *constant = analysis_best_constant(summary);
    bool any = false;
    for (size_t i = 0; i < summary->count && isnan(summary->items[i].p_l); i++) {
        text_append(text, "%s", any ? "; " : "");
        append_policy(text, &summary->items[i]);
        any = true;
    }
    if (constant == NULL)
        return;
    text_append(text, "%sbest constant ", any ? "; " : "");
    append_policy(text, constant);
}
