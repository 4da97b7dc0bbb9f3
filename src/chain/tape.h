#ifndef ETALON_CHAIN_TAPE_H
#define ETALON_CHAIN_TAPE_H

/* What the rule `tours` asks of a chain: a record of its proposals during the measured
 * start. Steps of every kind and states of every type fill it through tape_record and
 * tape_work; chain/tours.h reads it. A tape has a fixed capacity: the mutations after it
 * is full are not recorded. */

#include "image/contrib.h"

struct pack;

/* What proposed the successor. */
enum tape_event {
    TAPE_LARGE,       /* a large step */
    TAPE_LOCAL,       /* a small step */
    TAPE_AFTER_SMALL, /* the second stage after a small step without a contribution */
    TAPE_AFTER_LARGE, /* that after a large one */
};

struct tape_record {
    double target;    /* of the proposal; 0: it carries nothing and has no splats */
    float acceptance; /* probability with which it is accepted */
    uint8_t event;    /* enum tape_event */
    bool accepted;
    uint16_t splats;
};

struct tape_splat {
    int32_t pixel;
    float luminance;
};

struct tape {
    struct tape_record *records; /* [capacity]; the first is the state at the beginning */
    struct tape_splat *splats;   /* [splat_capacity], of all records in turn */
    long count, capacity, splat_count, splat_capacity;
    bool full;
    /* Mutations by kind (0: small, 1: large) and their work (state_type.work). Sums of
     * whole numbers, so that they are the same on every machine. */
    double mutations[2], work[2];
};

/* splats: greatest number of splats of one proposal. */
void tape_init(struct tape *tape, long mutations, int splats);
void tape_deinit(struct tape *tape);
double tape_bytes(long mutations, int splats);
/* Splats that a tape holds at most. */
long tape_splats_most(long mutations, int splats);

/* The state at which the chain stands when the tape begins. */
void tape_begin(struct tape *tape, const struct contrib *state);
/* One decision: the proposal y was accepted, or not, with probability a. */
void tape_record(struct tape *tape, enum tape_event event, const struct contrib *y,
                 double a, bool accepted);
/* A mutation of a kind begins; its work; further stages add theirs with count 0. */
void tape_work(struct tape *tape, bool large, double count, double work);
/* To or from a checkpoint (base/pack.h), of a film of so many pixels. */
void tape_pack(struct pack *pack, struct tape *tape, long pixels);

#endif
