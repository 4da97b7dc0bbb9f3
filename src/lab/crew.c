#include "lab/crew.h"

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

#define PATIENCE 200 /* ms */

struct worker {
    pid_t pid; /* 0: there is none */
    int link;  /* socket that keeps messages apart */
    bool busy;
    size_t job;
};

struct crew {
    const struct jobs *jobs;
    struct stage_options stage;
    struct worker *workers;
    struct pollfd *polled;
    int count, next; /* where the next look for an event begins: no worker is starved */
};

struct task {
    size_t job;
    bool reference;
};

struct crew *crew_create(const struct jobs *jobs, const struct stage_options *stage,
                         int count, struct err *err)
{
    if (count < 1) {
        err_set(err, ERR_USAGE, NULL, "there must be a worker");
        return NULL;
    }
    int threads = par_threads_available() / count;
    struct crew *crew = mem_alloc(1, sizeof *crew);
    *crew = (struct crew){.jobs = jobs, .stage = *stage, .count = count};
    crew->stage.threads = threads > 0 ? threads : 1;
    crew->workers = mem_alloc((size_t)count, sizeof *crew->workers);
    crew->polled = mem_alloc((size_t)count, sizeof *crew->polled);
    return crew;
}

static int leave(struct worker *worker)
{
    int status = 0;
    close(worker->link);
    while (waitpid(worker->pid, &status, 0) < 0 && errno == EINTR)
        ;
    *worker = (struct worker){0};
    return status;
}

void crew_destroy(struct crew *crew)
{
    if (crew == NULL)
        return;
    for (int i = 0; i < crew->count; i++)
        if (crew->workers[i].pid)
            leave(&crew->workers[i]);
    mem_free(crew->workers);
    mem_free(crew->polled);
    mem_free(crew);
}

/* --- the worker ------------------------------------------------------------------ */

/* What its hooks send with. */
struct sender {
    int link;
    size_t job;
};

static void send_event(const struct sender *sender, struct crew_event *event)
{
    event->job = sender->job;
    while (send(sender->link, event, sizeof *event, MSG_NOSIGNAL) < 0 && errno == EINTR)
        ;
}

static void send_progress(void *ctx, const struct run_progress *progress)
{
    struct crew_event event = {.kind = CREW_PROGRESS, .progress = *progress};
    send_event(ctx, &event);
}

static void send_half(void *ctx, const char *folder, int half)
{
    struct crew_event event = {.kind = CREW_HALF, .half = half};
    snprintf(event.folder, sizeof event.folder, "%s", folder);
    send_event(ctx, &event);
}

static void do_task(const struct crew *crew, struct stage *stage, const struct task *task,
                    struct crew_event *event)
{
    const struct job *job = &crew->jobs->items[task->job];
    bool ok = task->reference ? stage_prepare(stage, job, &event->err)
                              : part_run(stage, crew->stage.folder, job, &event->outcome,
                                         &event->err);
    bool stopped = crew->stage.stop && *crew->stage.stop;
    event->kind = ok ? CREW_DONE : stopped ? CREW_STOPPED : CREW_FAILED;
}

_Noreturn static void work(const struct crew *crew, int link)
{
    struct sender sender = {.link = link};
    struct stage_options options = crew->stage;
    options.on_half = options.on_half ? send_half : NULL;
    options.on_progress = options.on_progress ? send_progress : NULL;
    options.hook_ctx = &sender;
    struct stage *stage = stage_create(&options);
    struct task task;
    for (;;) {
        ssize_t size = recv(link, &task, sizeof task, 0);
        if (size < 0 && errno == EINTR)
            continue;
        if (size != (ssize_t)sizeof task)
            break;
        struct crew_event event = {0};
        sender.job = task.job;
        do_task(crew, stage, &task, &event);
        send_event(&sender, &event);
    }
    stage_destroy(stage);
    _exit(0);
}

/* In the child: alone with its link, and gone when the parent is. */
_Noreturn static void become_worker(const struct crew *crew, pid_t parent, int link)
{
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(1);
    for (int i = 0; i < crew->count; i++)
        if (crew->workers[i].pid)
            close(crew->workers[i].link);
    work(crew, link);
}

static bool start(struct crew *crew, struct worker *worker, struct err *err)
{
    int links[2];
    pid_t parent = getpid();
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, links) != 0)
        return err_set(err, ERR_IO, NULL, "cannot start a worker: %s", strerror(errno));
    fflush(NULL); /* or both processes would write what is buffered */
    pid_t pid = fork();
    if (pid == 0) {
        close(links[0]);
        become_worker(crew, parent, links[1]);
    }
    close(links[1]);
    *worker = (struct worker){.pid = pid, .link = links[0]};
    if (pid > 0)
        return true;
    err_set(err, ERR_IO, NULL, "cannot start a worker: %s", strerror(errno));
    close(links[0]);
    *worker = (struct worker){0};
    return false;
}

/* --- the parent ------------------------------------------------------------------ */

static struct worker *idle(const struct crew *crew)
{
    for (int i = 0; i < crew->count; i++)
        if (!crew->workers[i].busy)
            return &crew->workers[i];
    return NULL;
}

bool crew_is_idle(const struct crew *crew)
{
    return idle(crew) != NULL;
}

bool crew_is_busy(const struct crew *crew)
{
    for (int i = 0; i < crew->count; i++)
        if (crew->workers[i].busy)
            return true;
    return false;
}

bool crew_give(struct crew *crew, size_t job, bool reference, struct err *err)
{
    struct task task;
    struct worker *worker = idle(crew);
    memset(&task, 0, sizeof task); /* what pads it is sent too */
    task.job = job;
    task.reference = reference;
    if (worker->pid == 0 && !start(crew, worker, err))
        return false;
    /* If it has died meanwhile the next look at its link says so. */
    (void)send(worker->link, &task, sizeof task, MSG_NOSIGNAL);
    worker->busy = true;
    worker->job = job;
    return true;
}

static void receive(struct worker *worker, struct crew_event *event)
{
    ssize_t size = recv(worker->link, event, sizeof *event, 0);
    if (size < 0 && errno == EINTR)
        return;
    if (size != (ssize_t)sizeof *event) {
        bool busy = worker->busy;
        *event = (struct crew_event){.job = worker->job};
        event->wait_status = leave(worker);
        event->kind = busy ? CREW_DIED : CREW_NOTHING;
    }
    if (event->kind >= CREW_DONE)
        worker->busy = false;
}

void crew_wait(struct crew *crew, struct crew_event *event)
{
    *event = (struct crew_event){0};
    for (int i = 0; i < crew->count; i++)
        crew->polled[i] = (struct pollfd){
            .fd = crew->workers[i].pid ? crew->workers[i].link : -1, .events = POLLIN};
    if (poll(crew->polled, (nfds_t)crew->count, PATIENCE) <= 0)
        return;
    for (int i = 0; i < crew->count; i++) {
        int at = (crew->next + i) % crew->count;
        if (crew->polled[at].revents == 0)
            continue;
        crew->next = at + 1;
        receive(&crew->workers[at], event);
        return;
    }
}

void crew_stop(struct crew *crew)
{
    for (int i = 0; i < crew->count; i++)
        if (crew->workers[i].pid)
            kill(crew->workers[i].pid, SIGTERM);
}
