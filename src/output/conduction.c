/* conduction.c - lists of changes, and the shades that bars have where changes crowd. */
#define _GNU_SOURCE /* strverscmp */
#include "conduction.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Index of the element, made where it is new. */
static enum dalcs_status find_element(struct dalcs_conduction *conduction, const char *name,
                                      bool on_before, size_t *index, bool *is_new) {
    int known = dalcs_names_find(&conduction->names, name);
    *is_new = known < 0;
    if (known >= 0) {
        *index = (size_t)known;
        return DALCS_OK;
    }
    char *copy = dalcs_arena_copy(&conduction->arena, name, strlen(name));
    if (!copy) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_grow(&conduction->element, &conduction->capacity, conduction->n + 1,
                         sizeof *conduction->element));
    DALCS_TRY(dalcs_names_add(&conduction->names, copy, (int)conduction->n));
    *index = conduction->n++;
    conduction->element[*index] =
        (struct dalcs_conduction_element){.name = copy, .on_before = on_before};
    return DALCS_OK;
}

static bool is_on(const struct dalcs_conduction_element *element) {
    return element->n > 0 ? element->change[element->n - 1].on : element->on_before;
}

enum dalcs_status dalcs_conduction_add(struct dalcs_conduction *conduction, const char *name,
                                       double time, bool on) {
    size_t index = 0;
    bool is_new = false;
    DALCS_TRY(find_element(conduction, name, !on, &index, &is_new));
    struct dalcs_conduction_element *element = &conduction->element[index];
    if (is_on(element) == on) {
        return DALCS_OK;
    }
    DALCS_TRY(
        dalcs_grow(&element->change, &element->capacity, element->n + 1, sizeof *element->change));
    element->change[element->n++] = (struct dalcs_conduction_change){time, on};
    return DALCS_OK;
}

enum dalcs_status dalcs_conduction_add_element(struct dalcs_conduction *conduction,
                                               const char *name, bool on) {
    size_t index = 0;
    bool is_new = false;
    return find_element(conduction, name, on, &index, &is_new);
}

enum dalcs_status dalcs_conduction_add_jump(struct dalcs_conduction *conduction, double time) {
    if (conduction->n_jumps > 0 && conduction->jump[conduction->n_jumps - 1] >= time) {
        return DALCS_OK; /* of another part of the circuit at the same time */
    }
    DALCS_TRY(dalcs_grow(&conduction->jump, &conduction->jump_capacity, conduction->n_jumps + 1,
                         sizeof *conduction->jump));
    conduction->jump[conduction->n_jumps++] = time;
    return DALCS_OK;
}

enum dalcs_status dalcs_conduction_add_report(struct dalcs_conduction *conduction,
                                              const struct dalcs_report *report) {
    conduction->of_matrices = report->size.nodes == 0;
    for (size_t i = 0; i < report->n_events; i++) {
        DALCS_TRY(dalcs_conduction_add(conduction, report->event[i].element, report->event[i].time,
                                       report->event[i].on));
    }
    for (size_t i = 0; i < report->n_jumps; i++) {
        DALCS_TRY(dalcs_conduction_add_jump(conduction, report->jump[i].time));
    }
    return DALCS_OK;
}

static int compare_elements(const void *a, const void *b) {
    const struct dalcs_conduction_element *p = a, *q = b;
    return strverscmp(p->name, q->name);
}

void dalcs_conduction_sort(struct dalcs_conduction *conduction) {
    if (conduction->n > 0) {
        qsort(conduction->element, conduction->n, sizeof *conduction->element, compare_elements);
    }
    dalcs_names_finish(&conduction->names);
}

/* Adds the times from `from` to `to` to the parts that they lie in. */
static void add_span(double from, double to, double start, double width, int n, double *fraction) {
    double first = (from - start) / width, last = (to - start) / width;
    first = fmax(first, 0.0);
    last = fmin(last, (double)n);
    for (int i = (int)first; i < n && i < last; i++) {
        fraction[i] += fmin(last, i + 1.0) - fmax(first, (double)i);
    }
}

void dalcs_conduction_fractions(const struct dalcs_conduction_element *element, double start,
                                double stop, int n, double *fraction) {
    double width = (stop - start) / n, since = start;
    bool on = element->on_before;
    memset(fraction, 0, (size_t)n * sizeof *fraction);
    for (size_t i = 0; i < element->n; i++) {
        if (on) {
            add_span(since, element->change[i].time, start, width, n, fraction);
        }
        since = element->change[i].time;
        on = element->change[i].on;
    }
    if (on) {
        add_span(since, stop, start, width, n, fraction);
    }
}

void dalcs_conduction_finish(struct dalcs_conduction *conduction) {
    for (size_t i = 0; i < conduction->n; i++) {
        free(conduction->element[i].change);
    }
    free(conduction->element);
    free(conduction->jump);
    dalcs_names_finish(&conduction->names);
    dalcs_arena_finish(&conduction->arena);
    *conduction = (struct dalcs_conduction){0};
}
