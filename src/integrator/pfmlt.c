/* MMLT whose failed proposals are treated apart [Zeng19], in three modes:
 *   exact    after a failure a second, timid proposal [GreenMira01];
 *   counted  failures are repeats of the state, as in mmlt: the control;
 *   paper    failures are no states [Zeng19, Alg. 2]. Biased: the density is f Z, Z the
 *            probability that a proposal does not fail. */

#include "base/text.h"
#include "integrator/multiplex.h"

static const struct {
    const char *mode;
    const struct step_type *step;
} modes[] = {
    {"exact", &step_pf_exact},
    {"counted", &step_mh},
    {"paper", &step_pf_paper},
};

static void *create(const struct scene *scene, const struct settings *settings)
{
    size_t i = 0;
    while (!text_equal(modes[i].mode, settings->mode))
        i++;
    return multiplex_create(scene, settings, modes[i].step, true);
}

const struct integrator_type integrator_pfmlt = {
    .name = "pfmlt",
    .summary = "mmlt that treats failed proposals apart: mode exact, counted, or paper "
               "(biased)",
    .chains = true,
    .create = create,
    .advance = markov_advance,
    .started = markov_started,
    .picture = markov_picture,
    .statistics = markov_statistics,
    .progress = markov_progress,
    .film_bytes = markov_film_bytes,
    .failure_map = markov_failure_map,
    .pack = markov_pack,
    .evidence = markov_evidence,
    .destroy = markov_destroy,
};
