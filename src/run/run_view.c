#include "run/run_view.h"

#include "base/clock.h"

#define VERDICT_RATIO 1.25 /* of the times of two verdicts */

/* What the first look of each kind may take, until it is known: s, and s a pixel. */
static const double first_cost[VIEWS] = {0.01, 0.02};
static const double first_cost_of_pixel[VIEWS] = {2e-7, 1e-6};

/* What is kept for the look at the end, in looks at the picture: it shows error bars too.
 */
#define LAST_LOOK 2.0

static void charge(struct run *run, double seconds)
{
    struct view_account *account = &run->view.accounts[run->view.kind];
    account->taken += seconds;
    account->last += seconds;
}

/* The CPU time of the viewers since the last look is due to that. */
static void charge_viewers(struct run *run)
{
    const struct run_viewer *viewer = run->options->viewer;
    double cpu = viewer->cpu(viewer->ctx);
    charge(run, cpu - run->view.viewers_cpu);
    run->view.viewers_cpu = cpu;
}

static bool affordable(const struct run *run, enum view_kind kind)
{
    const struct view_account *account = &run->view.accounts[kind];
    double most = run->options->viewer->share * (run->cpu - run->view.resumed_cpu);
    double expected = account->looks > 0 ? account->last
                                         : first_cost[kind] + first_cost_of_pixel[kind] *
                                                                  run_pixels(run);
    double kept = kind == VIEW_PICTURE ? LAST_LOOK * expected : 0.0;
    return account->taken + expected + kept <= most;
}

static bool choose(struct run *run)
{
    bool verdict = run->options->viewer->verdict &&
                   run->wall >= VERDICT_RATIO * run->view.verdict_at &&
                   affordable(run, VIEW_VERDICT);
    if (!verdict && !affordable(run, VIEW_PICTURE))
        return false;
    run->view.kind = verdict ? VIEW_VERDICT : VIEW_PICTURE;
    return true;
}

bool run_view_due(struct run *run)
{
    const struct run_viewer *viewer = run->options->viewer;
    if (viewer == NULL || clock_wall() < run->view.next || !viewer->wanted(viewer->ctx))
        return false;
    charge_viewers(run);
    if (!choose(run))
        return false;
    run->view.begun = clock_cpu_thread();
    run->view.next = clock_wall() + viewer->every;
    return true;
}

/* While this thread is busy with the look, those that render wait. */
void run_view(struct run *run, struct run *whole)
{
    const struct run_viewer *viewer = run->options->viewer;
    struct view_account *account = &run->view.accounts[run->view.kind];
    bool verdict = run->view.kind == VIEW_VERDICT;
    struct run_result now = {0};
    run_take_results(whole, verdict, &now);
    now.end = RUN_GOING;
    viewer->show(viewer->ctx, &now);
    verdict_deinit(&now.verdict);
    if (verdict)
        run->view.verdict_at = run->wall;
    account->looks++;
    account->last = 0.0;
    charge(run, settings_threads(run->options->settings) *
                    (clock_cpu_thread() - run->view.begun));
}
