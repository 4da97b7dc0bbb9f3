#include "live/mailbox.h"

#include "base/clock.h"
#include "base/mem.h"

#include <pthread.h>
#include <signal.h>
#include <string.h>
#include <time.h>

struct mailbox {
    struct mailbox_work work;
    pthread_t thread;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    /* Under the lock: */
    void *waiting; /* NULL: none */
    bool busy, closing;
    double cpu;
};

static struct timespec after(clockid_t clock, double seconds)
{
    struct timespec at;
    clock_gettime(clock, &at);
    double whole = (double)at.tv_nsec * 1e-9 + seconds;
    at.tv_sec += (time_t)whole;
    at.tv_nsec = (long)((whole - (double)(time_t)whole) * 1e9);
    return at;
}

/* Waits for an item, a tick, or the end; false at the end. The lock is held. */
static bool next(struct mailbox *m, void **item)
{
    struct timespec until = after(CLOCK_MONOTONIC, m->work.tick);
    int status = 0;
    while (m->waiting == NULL && !m->closing && status == 0)
        status = m->work.tick > 0.0
                     ? pthread_cond_timedwait(&m->changed, &m->lock, &until)
                     : pthread_cond_wait(&m->changed, &m->lock);
    *item = m->waiting;
    m->waiting = NULL;
    return *item || !m->closing;
}

static void *run(void *ctx)
{
    struct mailbox *m = ctx;
    void *item;
    pthread_mutex_lock(&m->lock);
    while (next(m, &item)) {
        m->busy = true;
        pthread_mutex_unlock(&m->lock);
        m->work.work(m->work.ctx, item);
        pthread_mutex_lock(&m->lock);
        m->busy = false;
        m->cpu = clock_cpu_thread();
        pthread_cond_broadcast(&m->changed);
    }
    pthread_mutex_unlock(&m->lock);
    return NULL;
}

/* Signals are for the thread that renders. */
static int start(struct mailbox *m)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    int status = pthread_create(&m->thread, NULL, run, m);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return status;
}

static void release(struct mailbox *m)
{
    pthread_cond_destroy(&m->changed);
    pthread_mutex_destroy(&m->lock);
    mem_free(m);
}

struct mailbox *mailbox_create(const struct mailbox_work *work, struct err *err)
{
    struct mailbox *m = mem_alloc(1, sizeof *m);
    pthread_condattr_t monotonic;
    m->work = *work;
    pthread_mutex_init(&m->lock, NULL);
    pthread_condattr_init(&monotonic);
    pthread_condattr_setclock(&monotonic, CLOCK_MONOTONIC);
    pthread_cond_init(&m->changed, &monotonic);
    pthread_condattr_destroy(&monotonic);
    int status = start(m);
    if (status == 0)
        return m;
    release(m);
    err_set(err, ERR_IO, NULL, "cannot start a thread: %s", strerror(status));
    return NULL;
}

void mailbox_put(struct mailbox *m, void *item)
{
    pthread_mutex_lock(&m->lock);
    void *replaced = m->waiting;
    m->waiting = item;
    pthread_cond_broadcast(&m->changed);
    pthread_mutex_unlock(&m->lock);
    if (replaced)
        m->work.discard(replaced);
}

bool mailbox_idle(struct mailbox *m)
{
    pthread_mutex_lock(&m->lock);
    bool idle = m->waiting == NULL && !m->busy;
    pthread_mutex_unlock(&m->lock);
    return idle;
}

double mailbox_cpu(struct mailbox *m)
{
    pthread_mutex_lock(&m->lock);
    double cpu = m->cpu;
    pthread_mutex_unlock(&m->lock);
    return cpu;
}

bool mailbox_destroy(struct mailbox *m, double patience)
{
    if (m == NULL)
        return true;
    pthread_mutex_lock(&m->lock);
    m->closing = true;
    pthread_cond_broadcast(&m->changed);
    pthread_mutex_unlock(&m->lock);
    struct timespec until = after(CLOCK_REALTIME, patience);
    if (pthread_timedjoin_np(m->thread, NULL, &until) != 0)
        return false;
    release(m);
    return true;
}
