#ifndef ETALON_BASE_DOC_NODE_H
#define ETALON_BASE_DOC_NODE_H

/* The nodes of a document: doc.c builds them, doc_node.c reads them. */

#include "base/doc.h"

struct doc_node {
    const struct doc *doc;
    enum doc_kind kind;
    int line, col;
    int count;
    char *text;               /* scalar */
    bool plain;               /* scalar without quotes */
    struct doc_node **keys;   /* map, [count] */
    struct doc_node **values; /* map and list, [count] */
    /* While the document is built. */
    enum { UNSEEN, OPEN, DONE } state;
    int height;    /* levels below and with this node */
    long expanded; /* nodes below and with this one, shared ones counted each time */
};

struct doc {
    char *name;
    struct doc_node *nodes; /* as libyaml numbers them, from 0 */
    int node_count;
    const struct doc_node *root;
};

#endif
