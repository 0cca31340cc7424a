/* conduction.h - when diodes and switches conduct, and when states jump: what is drawn as bars and
 * marks. */
#ifndef DALCS_CONDUCTION_H
#define DALCS_CONDUCTION_H

#include "dalcs.h"
#include "names.h"

struct dalcs_conduction_change {
    double time; /* s */
    bool on;
};

struct dalcs_conduction_element {
    const char *name; /* "d1" */
    size_t n, capacity;
    struct dalcs_conduction_change *change; /* [n], times ascend, sides alternate */
    bool on_before;                         /* the first change */
};

/* Zero-initialise; finish frees everything. */
struct dalcs_conduction {
    size_t n, capacity;
    struct dalcs_conduction_element *element; /* [n] in the order in which they were met */
    size_t n_jumps, jump_capacity;
    double *jump;     /* [n_jumps] s, ascending */
    bool of_matrices; /* of a system file: a pair is on or off, nothing conducts */
    struct dalcs_names names;
    struct dalcs_arena arena;
};

/* Adds a change of the element of that name, a new one where it is not known yet. A change to the
 * side on which the element is does nothing. */
enum dalcs_status dalcs_conduction_add(struct dalcs_conduction *conduction, const char *name,
                                       double time, bool on) DALCS_MUST_CHECK;

/* An element without any change so far, which is on or off; nothing where the name is known. */
enum dalcs_status dalcs_conduction_add_element(struct dalcs_conduction *conduction,
                                               const char *name, bool on) DALCS_MUST_CHECK;

enum dalcs_status dalcs_conduction_add_jump(struct dalcs_conduction *conduction,
                                            double time) DALCS_MUST_CHECK;

/* The events and jumps of a run that has just ended. */
enum dalcs_status dalcs_conduction_add_report(struct dalcs_conduction *conduction,
                                              const struct dalcs_report *report) DALCS_MUST_CHECK;

/* Sorts the elements by their names, d2 before d10. Nothing can be added afterwards. */
void dalcs_conduction_sort(struct dalcs_conduction *conduction);

/* fraction[n]: the part of the time in which the element conducts, of n equal parts of
 * [start, stop]. */
void dalcs_conduction_fractions(const struct dalcs_conduction_element *element, double start,
                                double stop, int n, double *fraction);

void dalcs_conduction_finish(struct dalcs_conduction *conduction);

#endif
