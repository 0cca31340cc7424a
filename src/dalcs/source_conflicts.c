/* source_conflicts.c - sources that contradict each other by themselves, or leave a current open.
 *
 * Loops of V sources are in source_loops.c. Everything but current sources merges nodes, and what is then not ground is a
 * part that only they reach: what goes into it is a sum of sources that must be 0 at all times. */
#include "source_conflicts.h"

#include "source_loops.h"
#include "source_sums.h"
#include "union_find.h"

#include <stdlib.h>

/* A part that only current sources reach. */
struct part {
    struct dalcs_source_sum into;
    bool is_known; /* no controlled source reaches it */
};

static bool is_current_source(const struct dalcs_device *d) {
    return d->kind == DALCS_ISOURCE || d->kind == DALCS_CCCS || d->kind == DALCS_VCCS;
}

/* The sources that cross the border of the part of this representative. */
static void list_border(struct part *p, const struct dalcs_circuit *c, int *whole, int part) {
    *p = (struct part){.is_known = true};
    for (int i = 0; i < c->n_devices; i++) {
        const struct dalcs_device *d = &c->device[i];
        bool from = dalcs_union_find(whole, d->node[0]) == part;
        bool to = dalcs_union_find(whole, d->node[1]) == part;
        if (from != to) { /* a current source: all else has merged its nodes */
            p->is_known = p->is_known && d->kind == DALCS_ISOURCE;
            dalcs_source_sum_add(&p->into, i, to ? 1.0 : -1.0);
        }
    }
}

static const char *nodes_of(const struct dalcs_circuit *c, int *whole, int part,
                            struct dalcs_arena *arena) {
    const char *list = "";
    int n = 0;
    for (int k = 0; k < c->n_nodes && list != NULL; k++) {
        if (dalcs_union_find(whole, k) != part || n++ >= DALCS_MOST_CONFLICTS) {
            continue;
        }
        list = dalcs_arena_printf(arena, "%s%s%s", list, n > 1 ? ", " : "", c->node_name[k]);
    }
    list = list != NULL && n > DALCS_MOST_CONFLICTS
               ? dalcs_arena_printf(arena, "%s and %d more", list, n - DALCS_MOST_CONFLICTS)
               : list;
    list = list == NULL ? NULL : dalcs_arena_printf(arena, "%s %s", n > 1 ? "nodes" : "node", list);
    return list == NULL ? "" : list;
}

static void report_part(const struct dalcs_circuit *c, const struct part *p, const char *nodes,
                        double left, struct dalcs_arena *arena, struct dalcs_diag *diag) {
    const struct dalcs_location *where = &c->device[p->into.device[0]].where;
    const char *in = "";
    const char *out = "";
    for (int k = 0; k < p->into.n; k++) {
        const char **list = p->into.sign[k] > 0.0 ? &in : &out;
        *list = dalcs_listed(arena, *list, dalcs_source_text(arena, c, p->into.device[k]));
    }
    if (p->into.n == 1) {
        dalcs_diag_add(diag, DALCS_ERROR, where, NULL,
                       "nothing but %s reaches %s: its current has no way %s",
                       dalcs_listed(arena, in, out), nodes, left > 0.0 ? "out" : "in");
        return;
    }
    dalcs_diag_add(diag, DALCS_ERROR, where, NULL,
                   "nothing but current sources reaches %s, and they do not balance: %s in, %s out",
                   nodes, *in == '\0' ? "none" : in, *out == '\0' ? "none" : out);
}

static enum dalcs_status check_parts(const struct dalcs_circuit *c, struct dalcs_arena *arena,
                                     struct dalcs_diag *diag) {
    bool has_source = false;
    for (int i = 0; i < c->n_devices; i++) {
        has_source = has_source || c->device[i].kind == DALCS_ISOURCE;
    }
    if (!has_source) {
        return DALCS_OK;
    }
    int *whole = dalcs_alloc((size_t)c->n_nodes, sizeof(*whole));
    bool *is_seen = dalcs_alloc((size_t)c->n_nodes, sizeof(*is_seen));
    enum dalcs_status status = whole == NULL || is_seen == NULL ? DALCS_E_NOMEM : DALCS_OK;
    int n_parts = 0;
    if (status == DALCS_OK) {
        dalcs_union_reset(whole, c->n_nodes);
        is_seen[0] = true; /* the rest of the circuit determines ground */
    }
    for (int i = 0; i < c->n_devices && status == DALCS_OK; i++) {
        if (!is_current_source(&c->device[i])) {
            dalcs_union_join(whole, c->device[i].node[0], c->device[i].node[1]);
        }
    }
    for (int k = 0; k < 2 * c->n_devices && whole != NULL && is_seen != NULL; k++) {
        const struct dalcs_device *d = &c->device[k / 2];
        int part = dalcs_union_find(whole, d->node[k % 2]);
        if (d->kind != DALCS_ISOURCE || is_seen[part] || n_parts >= DALCS_MOST_CONFLICTS) {
            continue;
        }
        struct part p;
        double left;
        is_seen[part] = true;
        n_parts++;
        list_border(&p, c, whole, part);
        if (p.is_known && dalcs_source_sum_judge(c, &p.into, &left) == DALCS_SUM_CONTRADICTS) {
            report_part(c, &p, nodes_of(c, whole, part, arena), left, arena, diag);
            status = DALCS_E_NETLIST;
        }
    }
    free(whole);
    free(is_seen);
    return status;
}

enum dalcs_status dalcs_source_conflicts(const struct dalcs_circuit *circuit,
                                         struct dalcs_diag *diag) {
    struct dalcs_arena arena = {0};
    enum dalcs_status status = dalcs_source_loops_check(circuit, &arena, diag);
    if (status != DALCS_E_NOMEM) {
        enum dalcs_status parts = check_parts(circuit, &arena, diag);
        status = parts != DALCS_OK ? parts : status;
    }
    dalcs_arena_finish(&arena);
    return status;
}
