/* refusal_words.h - the words of which the sentences of refusals are made, in the session's arena. */
#ifndef DALCS_REFUSAL_WORDS_H
#define DALCS_REFUSAL_WORDS_H

#include "refusal.h"

/* Elements of a kind that a sentence lists, and nodes. */
enum { DALCS_REFUSAL_MOST_LISTED = 12 };

/* The sum of the sources over their size, just after they have stopped to agree. */
#define DALCS_TURNING_PART 1e-6

/* Items of a sentence. */
struct dalcs_refusal_list {
    struct dalcs_session *s;
    int n;
    const char *item[DALCS_REFUSAL_MOST_LISTED];
};

void dalcs_refusal_put(struct dalcs_refusal_list *l, const char *item);

/* "a", "a and b", "a, b and c", "a, b and 7 more"; with commas alone as a path is listed. */
const char *dalcs_refusal_joined(const struct dalcs_refusal_list *l, bool is_path);

const char *dalcs_refusal_plural(const struct dalcs_refusal_list *l, const char *one,
                                 const char *many);

/* "5 V", "2.5 mA" */
const char *dalcs_refusal_quantity(struct dalcs_session *s, double value, const char *unit);

/* "v1 (5 V, rising)"; which way it goes where is_turning. */
const char *dalcs_refusal_source(const struct dalcs_refusal *r, int device, bool is_turning);

/* A loop that sources drive: `arc` where it is a single one, in its order. */
const char *dalcs_refusal_of_loop(const struct dalcs_refusal *r, const struct dalcs_loop_arc *arc,
                                  int n_arcs);

/* Through transformers a loop is not one path: its elements, and what couples them. */
const char *dalcs_refusal_of_coupled(const struct dalcs_refusal *r);

/* "i1 (3 A) flows into node 1 and i2 (1 A) out of it (net 2 A), and nothing lets the rest out: d1
 * blocks" */
const char *dalcs_refusal_of_part(const struct dalcs_refusal *r, const struct dalcs_fed_part *part);

#endif
