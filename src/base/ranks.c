#include "base/ranks.h"

#ifdef WITH_MPI

#include "base/clock.h"
#include "base/mem.h"

#include <mpi.h>
#include <stdlib.h>
#include <time.h>

#define NAP_NS     50000 /* between two looks whether the others have come */
#define GRACE      0.5   /* s that a rank that was told to stop waits for the others */
#define CHUNK_MOST (1 << 30) /* bytes of a message */
#define TAG        1

static bool is_on(void)
{
    int on = 0, off = 0;
    MPI_Initialized(&on);
    MPI_Finalized(&off);
    return on && !off;
}

/* mpirun sets this for its processes; else MPI would be started for nothing. */
void ranks_begin(void)
{
    if (getenv("OMPI_COMM_WORLD_SIZE") && !is_on())
        MPI_Init(NULL, NULL);
}

void ranks_end(void)
{
    if (is_on())
        MPI_Finalize();
}

int ranks_own(void)
{
    int rank = 0;
    if (is_on())
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

int ranks_count(void)
{
    int count = 1;
    if (is_on())
        MPI_Comm_size(MPI_COMM_WORLD, &count);
    return count;
}

/* Waits asleep: a rank that waits actively would take the processor from one that has to
 * come. */
bool ranks_agree(unsigned *bits, const volatile sig_atomic_t *stop)
{
    MPI_Request request;
    unsigned own = *bits;
    int done = 0;
    double stopped = 0.0;
    if (!is_on())
        return true;
    MPI_Iallreduce(&own, bits, 1, MPI_UNSIGNED, MPI_BOR, MPI_COMM_WORLD, &request);
    for (;;) {
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done)
            return true;
        if (stop && *stop && stopped == 0.0)
            stopped = clock_wall();
        if (stopped > 0.0 && clock_wall() - stopped > GRACE)
            return false;
        nanosleep(&(struct timespec){0, NAP_NS}, NULL);
    }
}

static int chunk_of(size_t left)
{
    return left < CHUNK_MOST ? (int)left : CHUNK_MOST;
}

static void send(const struct text *bytes)
{
    unsigned long size = bytes->length;
    MPI_Send(&size, 1, MPI_UNSIGNED_LONG, 0, TAG, MPI_COMM_WORLD);
    for (size_t at = 0; at < bytes->length;) {
        int chunk = chunk_of(bytes->length - at);
        MPI_Send(bytes->data + at, chunk, MPI_BYTE, 0, TAG, MPI_COMM_WORLD);
        at += (size_t)chunk;
    }
}

static void receive(int rank, struct text *bytes)
{
    unsigned long size = 0;
    MPI_Recv(&size, 1, MPI_UNSIGNED_LONG, rank, TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    bytes->data = mem_grow(bytes->data, &bytes->capacity, size + 1, 1);
    for (bytes->length = 0; bytes->length < size;) {
        int chunk = chunk_of(size - bytes->length);
        MPI_Recv(bytes->data + bytes->length, chunk, MPI_BYTE, rank, TAG, MPI_COMM_WORLD,
                 MPI_STATUS_IGNORE);
        bytes->length += (size_t)chunk;
    }
}

bool ranks_gather(const struct text *own, ranks_take take, void *ctx)
{
    struct text bytes = {0};
    bool ok = true;
    if (ranks_own() > 0) {
        send(own);
        return true;
    }
    for (int rank = 1; rank < ranks_count(); rank++) {
        receive(rank, &bytes);
        ok = ok && take(ctx, rank, &bytes);
    }
    mem_free(bytes.data);
    return ok;
}

#else

void ranks_begin(void)
{
}

void ranks_end(void)
{
}

int ranks_own(void)
{
    return 0;
}

int ranks_count(void)
{
    return 1;
}

bool ranks_agree(unsigned *bits, const volatile sig_atomic_t *stop)
{
    (void)bits, (void)stop;
    return true;
}

bool ranks_gather(const struct text *own, ranks_take take, void *ctx)
{
    (void)own, (void)take, (void)ctx;
    return true;
}

#endif
