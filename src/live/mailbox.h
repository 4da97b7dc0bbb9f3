#ifndef ETALON_LIVE_MAILBOX_H
#define ETALON_LIVE_MAILBOX_H

/* A thread of its own for work that must not hold up a run: it takes one item at a time.
 * One more may wait; a newer one replaces it. */

#include "base/err.h"

#include <stdbool.h>

struct mailbox;

struct mailbox_work {
    /* On the thread; takes the item. NULL: none came for `tick` seconds. */
    void (*work)(void *ctx, void *item);
    void (*discard)(void *item); /* of an item that was replaced */
    void *ctx;
    double tick; /* s; 0: never */
};

struct mailbox *mailbox_create(const struct mailbox_work *work, struct err *err);
/* Hands over an item; never waits for the thread's work. */
void mailbox_put(struct mailbox *mailbox, void *item);
/* Nothing waits and nothing is being worked on. */
bool mailbox_idle(struct mailbox *mailbox);
/* CPU time of the thread so far, in s. */
double mailbox_cpu(struct mailbox *mailbox);
/* Ends the thread once it has worked on all items. False if it has not ended after
 * `patience` seconds: then it keeps what it uses until the process ends. */
bool mailbox_destroy(struct mailbox *mailbox, double patience);

#endif
