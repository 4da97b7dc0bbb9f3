#include "analysis/analysis_summary.h"

#include "base/mem.h"
#include "base/text.h"
#include "analysis/analysis_regret.h"

#include <math.h>
#include <stdlib.h>

/* --- names ----------------------------------------------------------------------- */

static char *automatic_name(const struct results *results,
                            const struct results_cell *cell)
{
    const char *rule = results_text(results, &cell->runs[0], "rule");
    const char *per = results_text(results, &cell->runs[0], "per");
    bool per_length = text_equal(per, "length");
    return text_format("automatic%s%s%s", rule[0] ? ", " : "", rule,
                       per_length ? " per length" : "");
}

static char *cell_name(const struct family *family)
{
    const struct results_cell *cell = family->manual[0];
    char *budget = results_budget(cell);
    char *name = text_format("%s, %s, %s", cell->scene, budget, family->name);
    mem_free(budget);
    return name;
}

/* --- policies -------------------------------------------------------------------- */

/* The policy of that name; takes the name. */
static struct analysis_policy *policy_of(struct analysis_summary *summary, char *name,
                                         double p_l)
{
    for (size_t i = 0; i < summary->count; i++)
        if (text_equal(summary->items[i].name, name)) {
            mem_free(name);
            return &summary->items[i];
        }
    summary->items = mem_grow(summary->items, &summary->capacity, summary->count + 1,
                              sizeof *summary->items);
    struct analysis_policy *policy = &summary->items[summary->count++];
    *policy = (struct analysis_policy){
        .name = name, .p_l = p_l, .worst_name = text_copy("")};
    return policy;
}

/* mean holds the sum of logarithms until all are added. */
static void policy_add(struct analysis_policy *policy, const struct family *family,
                       double regret)
{
    if (!(regret > 0.0))
        return;
    policy->cells++;
    policy->mean += log(regret);
    if (policy->cells > 1 && regret <= policy->worst)
        return;
    policy->worst = regret;
    mem_free(policy->worst_name);
    policy->worst_name = cell_name(family);
}

/* Families that differ in the rule alone have the same manual cells. */
static bool shares_manual(const struct families *families, size_t family)
{
    for (size_t i = 0; i < family; i++)
        if (families->items[i].manual_count > 0 &&
            families->items[i].manual[0] == families->items[family].manual[0])
            return true;
    return false;
}

static int compare_policies(const void *a, const void *b)
{
    const struct analysis_policy *x = a, *y = b;
    if (isnan(x->p_l) || isnan(y->p_l))
        return isnan(y->p_l) - isnan(x->p_l);
    return (x->p_l > y->p_l) - (x->p_l < y->p_l);
}

static void add_family(const struct results *results, const struct families *families,
                       size_t index, enum results_axis axis, enum results_error error,
                       struct analysis_summary *summary)
{
    const struct family *family = &families->items[index];
    if (family->automatic)
        policy_add(
            policy_of(summary, automatic_name(results, family->automatic), (double)NAN),
            family, analysis_regret_value(family, axis, error));
    if (shares_manual(families, index))
        return;
    summary->cells++;
    for (size_t i = 0; i < family->manual_count; i++) {
        struct family constant = *family;
        constant.automatic = family->manual[i];
        double p_l = family->manual[i]->p_l;
        policy_add(policy_of(summary, text_format("p_l = %g", p_l), p_l), family,
                   analysis_regret_value(&constant, axis, error));
    }
}

void analysis_summary_make(const struct results *results, const struct families *families,
                           enum results_axis axis, enum results_error error,
                           struct analysis_summary *summary)
{
    *summary = (struct analysis_summary){0};
    for (size_t i = 0; i < families->count; i++)
        if (families->items[i].manual_count >= 2)
            add_family(results, families, i, axis, error, summary);
    for (size_t i = 0; i < summary->count; i++) {
        struct analysis_policy *policy = &summary->items[i];
        policy->left_out = summary->cells - policy->cells;
        policy->mean = policy->cells ? exp(policy->mean / (double)policy->cells)
                                     : (double)NAN;
        policy->worst = policy->cells ? policy->worst : (double)NAN;
    }
    if (summary->count > 0)
        qsort(summary->items, summary->count, sizeof *summary->items, compare_policies);
}

void analysis_summary_deinit(struct analysis_summary *summary)
{
    for (size_t i = 0; i < summary->count; i++) {
        mem_free(summary->items[i].name);
        mem_free(summary->items[i].worst_name);
    }
    mem_free(summary->items);
    *summary = (struct analysis_summary){0};
}

const struct analysis_policy *
analysis_best_constant(const struct analysis_summary *summary)
{
    const struct analysis_policy *best = NULL;
    for (size_t i = 0; i < summary->count; i++) {
        const struct analysis_policy *policy = &summary->items[i];
        if (!isnan(policy->p_l) && policy->cells == summary->cells && policy->cells > 0 &&
            (best == NULL || policy->mean < best->mean))
            best = policy;
    }
    return best;
}
