#include "lab/worker_pool.h"

#include "base/mem.h"
#include "base/par.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#define POLL_TIMEOUT 200 /* ms, of one poll */

struct worker {
    pid_t pid;   /* 0: there is none */
    int channel; /* socket to the worker (SOCK_SEQPACKET: one message at a time) */
    bool busy;
    size_t job;
};

struct worker_pool {
    const struct jobs *jobs;
    struct job_context_options context;
    struct worker *workers;
    struct pollfd *polled;
    int count,
        next; /* where the next search for an event begins, so that no worker starves */
};

struct task {
    size_t job;
    bool reference;
};

struct worker_pool *worker_pool_create(const struct jobs *jobs,
                                       const struct job_context_options *context,
                                       int count, struct err *err)
{
    if (count < 1) {
        err_set(err, ERR_USAGE, NULL, "there must be a worker");
        return NULL;
    }
    int threads = par_threads_available() / count;
    struct worker_pool *pool = mem_alloc(1, sizeof *pool);
    *pool = (struct worker_pool){.jobs = jobs, .context = *context, .count = count};
    pool->context.threads = threads > 0 ? threads : 1;
    pool->workers = mem_alloc((size_t)count, sizeof *pool->workers);
    pool->polled = mem_alloc((size_t)count, sizeof *pool->polled);
    return pool;
}

static int join_worker(struct worker *worker)
{
    int status = 0;
    close(worker->channel);
    while (waitpid(worker->pid, &status, 0) < 0 && errno == EINTR)
        ;
    *worker = (struct worker){0};
    return status;
}

void worker_pool_destroy(struct worker_pool *pool)
{
    if (pool == NULL)
        return;
    for (int i = 0; i < pool->count; i++)
        if (pool->workers[i].pid)
            join_worker(&pool->workers[i]);
    mem_free(pool->workers);
    mem_free(pool->polled);
    mem_free(pool);
}

/* --- the worker ------------------------------------------------------------------ */

/* Context of the worker's hooks. */
struct sender {
    int channel;
    size_t job;
};

static void send_event(const struct sender *sender, struct worker_event *event)
{
    event->job = sender->job;
    while (send(sender->channel, event, sizeof *event, MSG_NOSIGNAL) < 0 &&
           errno == EINTR)
        ;
}

static void send_progress(void *ctx, const struct run_progress *progress)
{
    struct worker_event event = {.kind = WORKER_PROGRESS, .progress = *progress};
    send_event(ctx, &event);
}

static void send_half(void *ctx, const char *folder, int half)
{
    struct worker_event event = {.kind = WORKER_REFERENCE_HALF, .half = half};
    snprintf(event.folder, sizeof event.folder, "%s", folder);
    send_event(ctx, &event);
}

static void do_task(const struct worker_pool *pool, struct job_context *context,
                    const struct task *task, struct worker_event *event)
{
    const struct job *job = &pool->jobs->items[task->job];
    bool ok = task->reference ? job_context_make_reference(context, job, &event->err)
                              : part_run(context, pool->context.folder, job,
                                         &event->outcome, &event->err);
    bool stopped = pool->context.stop && *pool->context.stop;
    event->kind = ok ? WORKER_DONE : stopped ? WORKER_STOPPED : WORKER_FAILED;
}

_Noreturn static void work(const struct worker_pool *pool, int channel)
{
    struct sender sender = {.channel = channel};
    struct job_context_options options = pool->context;
    options.on_half = options.on_half ? send_half : NULL;
    options.on_progress = options.on_progress ? send_progress : NULL;
    options.hook_ctx = &sender;
    struct job_context *context = job_context_create(&options);
    struct task task;
    for (;;) {
        ssize_t size = recv(channel, &task, sizeof task, 0);
        if (size < 0 && errno == EINTR)
            continue;
        if (size != (ssize_t)sizeof task)
            break;
        struct worker_event event = {0};
        sender.job = task.job;
        do_task(pool, context, &task, &event);
        send_event(&sender, &event);
    }
    job_context_destroy(context);
    _exit(0);
}

/* In the child: closes the channels of other workers; dies with the parent. */
_Noreturn static void become_worker(const struct worker_pool *pool, pid_t parent,
                                    int channel)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(1);
    for (int i = 0; i < pool->count; i++)
        if (pool->workers[i].pid)
            close(pool->workers[i].channel);
    work(pool, channel);
}

static bool start(struct worker_pool *pool, struct worker *worker, struct err *err)
{
    int ends[2];
    pid_t parent = getpid();
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        return err_set(err, ERR_IO, NULL, "cannot start a worker: %s", strerror(errno));
    fflush(NULL); /* else both processes would write what is buffered */
    pid_t pid = fork();
    if (pid == 0) {
        close(ends[0]);
        become_worker(pool, parent, ends[1]);
    }
    close(ends[1]);
    *worker = (struct worker){.pid = pid, .channel = ends[0]};
    if (pid > 0)
        return true;
    err_set(err, ERR_IO, NULL, "cannot start a worker: %s", strerror(errno));
    close(ends[0]);
    *worker = (struct worker){0};
    return false;
}

/* --- the parent ------------------------------------------------------------------ */

static struct worker *idle(const struct worker_pool *pool)
{
    for (int i = 0; i < pool->count; i++)
        if (!pool->workers[i].busy)
            return &pool->workers[i];
    return NULL;
}

bool worker_pool_is_idle(const struct worker_pool *pool)
{
    return idle(pool) != NULL;
}

bool worker_pool_is_busy(const struct worker_pool *pool)
{
    for (int i = 0; i < pool->count; i++)
        if (pool->workers[i].busy)
            return true;
    return false;
}

bool worker_pool_give(struct worker_pool *pool, size_t job, bool reference,
                      struct err *err)
{
    struct task task;
    struct worker *worker = idle(pool);
    memset(&task, 0, sizeof task); /* the padding is sent too */
    task.job = job;
    task.reference = reference;
    if (worker->pid == 0 && !start(pool, worker, err))
        return false;
    /* If the worker has died meanwhile, worker_pool_wait reports it. */
    (void)send(worker->channel, &task, sizeof task, MSG_NOSIGNAL);
    worker->busy = true;
    worker->job = job;
    return true;
}

static void receive(struct worker *worker, struct worker_event *event)
{
    ssize_t size = recv(worker->channel, event, sizeof *event, 0);
    if (size < 0 && errno == EINTR)
        return;
    if (size != (ssize_t)sizeof *event) {
        bool busy = worker->busy;
        *event = (struct worker_event){.job = worker->job};
        event->wait_status = join_worker(worker);
        event->kind = busy ? WORKER_DIED : WORKER_NOTHING;
    }
    if (event->kind >= WORKER_DONE)
        worker->busy = false;
}

void worker_pool_wait(struct worker_pool *pool, struct worker_event *event)
{
    *event = (struct worker_event){0};
    for (int i = 0; i < pool->count; i++)
        pool->polled[i] = (struct pollfd){
            .fd = pool->workers[i].pid ? pool->workers[i].channel : -1, .events = POLLIN};
    if (poll(pool->polled, (nfds_t)pool->count, POLL_TIMEOUT) <= 0)
        return;
    for (int i = 0; i < pool->count; i++) {
        int at = (pool->next + i) % pool->count;
        if (pool->polled[at].revents == 0)
            continue;
        pool->next = at + 1;
        receive(&pool->workers[at], event);
        return;
    }
}

void worker_pool_stop(struct worker_pool *pool)
{
    for (int i = 0; i < pool->count; i++)
        if (pool->workers[i].pid)
            kill(pool->workers[i].pid, SIGTERM);
}
