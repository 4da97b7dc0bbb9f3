#include "analysis/families.h"

#include "base/mem.h"

#include <stdlib.h>
#include <string.h>

/* The settings that all cells of a family share, as far as tables have columns for them.
 */
static const char *const design_columns[] = {
    "integrator", "mode",  "kernel",    "estimator", "builder", "direct",
    "allocation", "sigma", "s1",        "s2",        "width",   "height",
    "max_depth",  "start", "start_cap", "keep_all",  NULL,
};
/* Settings of automatic cells only; they do not matter to manual ones. */
static const char *const auto_columns[] = {"rule", "per", NULL};

struct maker {
    const struct results *results;
    char **residues; /* of each cell: its label without its p_l */
    size_t *designs; /* of each cell: the first one that has the same design */
    struct families *families;
    size_t capacity;
};

/* --- labels ---------------------------------------------------------------------- */

/* "pssmlt p_l=0.3 kernel=gaussian" -> "pssmlt kernel=gaussian". */
static char *without_p_l(const char *label)
{
    static const char key[] = "p_l=";
    struct text rest = {0};
    text_append(&rest, "%s", "");
    while (*label) {
        size_t blanks = strspn(label, " ");
        size_t word = strcspn(label + blanks, " ");
        if (strncmp(label + blanks, key, sizeof key - 1) != 0)
            text_append(&rest, "%.*s", (int)(blanks + word), label);
        label += blanks + word;
    }
    size_t skip = strspn(rest.data, " ");
    char *residue = text_copy(rest.data[skip] ? rest.data + skip : label);
    mem_free(rest.data);
    return residue;
}

/* --- what belongs together ------------------------------------------------------- */

static bool same_columns(const struct results *results, const struct results_cell *a,
                         const struct results_cell *b, const char *const *columns)
{
    for (; *columns; columns++)
        if (!text_equal(results_text(results, &a->runs[0], *columns),
                        results_text(results, &b->runs[0], *columns)))
            return false;
    return true;
}

static bool same_design(const struct results *results, const struct results_cell *a,
                        const struct results_cell *b)
{
    return results_same_budget(a, b) && same_columns(results, a, b, design_columns);
}

static size_t first_of_design(const struct results *results, size_t cell)
{
    for (size_t i = 0; i < cell; i++)
        if (results->cells[i].has_chains &&
            same_design(results, &results->cells[i], &results->cells[cell]))
            return i;
    return cell;
}

static const char *residue_of(const struct maker *m, const struct results_cell *cell)
{
    return m->residues[cell - m->results->cells];
}

static size_t design_of(const struct maker *m, const struct results_cell *cell)
{
    return m->designs[cell - m->results->cells];
}

/* Whether two cells would be the same member of a family. */
static bool same_member(const struct maker *m, const struct results_cell *a,
                        const struct results_cell *b)
{
    if (a->is_auto != b->is_auto)
        return false;
    return a->is_auto ? same_columns(m->results, a, b, auto_columns) : a->p_l == b->p_l;
}

static bool belongs(const struct maker *m, const struct results_cell *cell,
                    const struct results_cell *first, bool by_label)
{
    return cell->has_chains && design_of(m, cell) == design_of(m, first) &&
           (!by_label || text_equal(residue_of(m, cell), residue_of(m, first)));
}

/* Whether by the columns alone two cells of the design are the same member: then another
 * setting, which only labels show, distinguishes them. */
static bool is_ambiguous(const struct maker *m, const struct results_cell *first)
{
    const struct results_cell *cells = m->results->cells;
    for (size_t i = 0; i < m->results->cell_count; i++)
        for (size_t k = 0; belongs(m, &cells[i], first, false) && k < i; k++)
            if (belongs(m, &cells[k], first, false) &&
                same_member(m, &cells[i], &cells[k]))
                return true;
    return false;
}

/* --- families -------------------------------------------------------------------- */

static void add_manual(struct family *family, const struct results_cell *cell)
{
    size_t at = family->manual_count;
    while (at > 0 && family->manual[at - 1]->p_l > cell->p_l)
        at--;
    if (at > 0 && family->manual[at - 1]->p_l == cell->p_l)
        return;
    memmove(&family->manual[at + 1], &family->manual[at],
            (family->manual_count - at) * sizeof(const struct results_cell *));
    family->manual[at] = cell;
    family->manual_count++;
}

static void add_family(struct maker *m, const struct results_cell *first)
{
    struct families *families = m->families;
    families->items = mem_grow(families->items, &m->capacity, families->count + 1,
                               sizeof *families->items);
    struct family *family = &families->items[families->count++];
    bool by_label = is_ambiguous(m, first);
    *family = (struct family){
        .name = text_copy(residue_of(m, first)),
        .automatic = first->is_auto ? first : NULL,
        .manual = mem_alloc(m->results->cell_count, sizeof(const struct results_cell *)),
    };
    for (size_t i = 0; i < m->results->cell_count; i++) {
        const struct results_cell *cell = &m->results->cells[i];
        if (!cell->is_auto && belongs(m, cell, first, by_label))
            add_manual(family, cell);
    }
}

static bool is_member(const struct families *families, const struct results_cell *cell)
{
    for (size_t i = 0; i < families->count; i++)
        for (size_t k = 0; k < families->items[i].manual_count; k++)
            if (families->items[i].manual[k] == cell)
                return true;
    return false;
}

static void maker_init(struct maker *m)
{
    size_t count = m->results->cell_count;
    m->residues = mem_alloc(count, sizeof(char *));
    m->designs = mem_alloc(count, sizeof *m->designs);
    for (size_t i = 0; i < count; i++) {
        m->residues[i] = without_p_l(m->results->cells[i].label);
        m->designs[i] = first_of_design(m->results, i);
    }
}

static void maker_deinit(struct maker *m)
{
    for (size_t i = 0; i < m->results->cell_count; i++)
        mem_free(m->residues[i]);
    mem_free(m->residues);
    mem_free(m->designs);
}

void families_make(const struct results *results, struct families *families)
{
    struct maker m = {.results = results, .families = families};
    const struct results_cell *cells = results->cells;
    *families = (struct families){0};
    maker_init(&m);
    for (size_t i = 0; i < results->cell_count; i++)
        if (cells[i].is_auto)
            add_family(&m, &cells[i]);
    for (size_t i = 0; i < results->cell_count; i++)
        if (cells[i].has_chains && !cells[i].is_auto && !is_member(families, &cells[i]))
            add_family(&m, &cells[i]);
    maker_deinit(&m);
}

void families_deinit(struct families *families)
{
    for (size_t i = 0; i < families->count; i++) {
        mem_free(families->items[i].name);
        mem_free(families->items[i].manual);
    }
    mem_free(families->items);
    *families = (struct families){0};
}
