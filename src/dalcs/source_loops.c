/* source_loops.c - V sources and shorts form a forest, and every further V source closes one loop with it. */
#include "source_loops.h"

#include "quantity.h"
#include "source_conflicts.h"
#include "source_sums.h"
#include "union_find.h"

#include <math.h>
#include <stdlib.h>

struct forest {
    int n, *device;   /* [n] V sources and shorts, in the order of the netlist */
    bool *is_tree;    /* [n] */
    bool has_loops;   /* else nothing below is set */
    int *start, *arc; /* [n_nodes + 1], [2 n] tree devices at each node */
    int *up;          /* [n_nodes] the device towards the root, -1 */
    int *depth;       /* [n_nodes] */
    int *queue;       /* [n_nodes], of a union-find before */
};

static int other_end(const struct dalcs_device *d, int node) {
    return d->node[0] == node ? d->node[1] : d->node[0];
}

/* Shorts without a current of their own, the other shorts, sources: the later ones close loops. */
static int rank_of(const struct dalcs_device *d, bool wants_current) {
    return dalcs_device_is_short(d) ? (wants_current ? 1 : 0) : d->kind == DALCS_VSOURCE ? 2 : -1;
}

static void grow(struct forest *f, const struct dalcs_circuit *c, const bool *wants_current) {
    dalcs_union_reset(f->queue, c->n_nodes);
    for (int rank = 0; rank < 3; rank++) {
        for (int i = 0; i < f->n; i++) {
            const struct dalcs_device *d = &c->device[f->device[i]];
            if (rank_of(d, wants_current[f->device[i]]) == rank) {
                f->is_tree[i] = dalcs_union_join(f->queue, d->node[0], d->node[1]);
                f->has_loops = f->has_loops || (rank > 0 && !f->is_tree[i]);
            }
        }
    }
}

static void list_arcs(struct forest *f, const struct dalcs_circuit *c) {
    for (int i = 0; i < f->n; i++) {
        for (int e = 0; e < 2 && f->is_tree[i]; e++) {
            f->start[c->device[f->device[i]].node[e] + 1]++;
        }
    }
    for (int n = 0; n < c->n_nodes; n++) {
        f->start[n + 1] += f->start[n];
        f->depth[n] = f->start[n]; /* where the next one goes */
    }
    for (int i = 0; i < f->n; i++) {
        for (int e = 0; e < 2 && f->is_tree[i]; e++) {
            f->arc[f->depth[c->device[f->device[i]].node[e]]++] = f->device[i];
        }
    }
}

static void root(struct forest *f, const struct dalcs_circuit *c) {
    for (int n = 0; n < c->n_nodes; n++) {
        f->depth[n] = -1;
        f->up[n] = -1;
    }
    for (int r = 0; r < c->n_nodes; r++) {
        int n = 0;
        if (f->depth[r] < 0) {
            f->depth[r] = 0;
            f->queue[n++] = r;
        }
        for (int q = 0; q < n; q++) {
            int node = f->queue[q];
            for (int k = f->start[node]; k < f->start[node + 1]; k++) {
                int next = other_end(&c->device[f->arc[k]], node);
                if (f->depth[next] < 0) {
                    f->depth[next] = f->depth[node] + 1;
                    f->up[next] = f->arc[k];
                    f->queue[n++] = next;
                }
            }
        }
    }
}

/* Does number i of f->device? */
static bool closes_loop(const struct forest *f, const struct dalcs_circuit *c,
                        const bool *wants_current, int i) {
    return rank_of(&c->device[f->device[i]], wants_current[f->device[i]]) > 0 && !f->is_tree[i];
}

struct loop {
    struct dalcs_source_sum sum; /* of its sources' voltages */
    const char *rest;            /* its elements but the source that closes it, in order */
};

/* The loop that a source closes: up the tree from both of its ends until they meet, or until there
 * are too many sources to be judged. Without an arena its sum only. */
static struct loop walk_loop(const struct forest *f, const struct dalcs_circuit *c, int closing,
                             struct dalcs_arena *arena) {
    const struct dalcs_device *d = &c->device[closing];
    int node[2] = {d->node[0], d->node[1]};
    const char *way[2] = {"", ""};
    struct loop loop = {.rest = ""};
    if (d->kind == DALCS_VSOURCE) {
        dalcs_source_sum_add(&loop.sum, closing, 1.0);
    }
    for (int n = 0; node[0] != node[1] && loop.sum.n <= DALCS_MOST_SUMMANDS; n++) {
        int side = f->depth[node[0]] >= f->depth[node[1]] ? 0 : 1;
        int up = f->up[node[side]];
        const struct dalcs_device *e = &c->device[up];
        if (e->kind == DALCS_VSOURCE) {
            dalcs_source_sum_add(&loop.sum, up,
                                 (e->node[0] == node[side]) == (side == 0) ? -1.0 : 1.0);
        }
        if (n < DALCS_MOST_SUMMANDS && arena != NULL) {
            const char *text = dalcs_source_text(arena, c, up);
            way[side] =
                side == 0 ? dalcs_listed(arena, text, way[0]) : dalcs_listed(arena, way[1], text);
        }
        node[side] = other_end(e, node[side]);
    }
    loop.rest = arena != NULL ? dalcs_listed(arena, way[1], way[0]) : "";
    return loop;
}

static void report_loop(const struct dalcs_circuit *c, int closing, const struct loop *loop,
                        double left, struct dalcs_arena *arena, struct dalcs_diag *diag) {
    const struct dalcs_device *d = &c->device[closing];
    const char *source = dalcs_source_text(arena, c, closing);
    char net[DALCS_QUANTITY_SIZE];
    (void)dalcs_quantity_write(net, fabs(left), "V", 6);
    if (*loop->rest == '\0') {
        dalcs_diag_add(diag, DALCS_ERROR, &d->where, NULL,
                       "%s is shorted: both its ends are on node '%s'", source,
                       c->node_name[d->node[0]]);
    } else if (loop->sum.n == 1) {
        dalcs_diag_add(diag, DALCS_ERROR, &d->where, NULL,
                       "%s is shorted by %s: nothing limits the current", source, loop->rest);
    } else {
        dalcs_diag_add(
            diag, DALCS_ERROR, &d->where, NULL,
            "nothing limits the current around the loop %s, %s, whose voltages add up to "
            "%s, not 0",
            source, loop->rest, net);
    }
}

static void say_idle(const struct dalcs_circuit *c, int closing, const struct loop *loop,
                     struct dalcs_arena *arena, struct dalcs_diag *diag) {
    const struct dalcs_device *d = &c->device[closing];
    dalcs_diag_add(
        diag, DALCS_WARNING, &d->where, NULL,
        "nothing limits the current around the loop %s, %s: the voltages agree, but that "
        "current is not determined; by convention %s carries none",
        dalcs_source_text(arena, c, closing), loop->rest, d->name);
}

static enum dalcs_status report_loops(const struct forest *f, const struct dalcs_circuit *c,
                                      const bool *wants_current, struct dalcs_arena *arena,
                                      struct dalcs_diag *diag) {
    enum dalcs_status status = DALCS_OK;
    int n_messages = 0;
    for (int i = 0; f->has_loops && i < f->n && n_messages < DALCS_MOST_CONFLICTS; i++) {
        if (!closes_loop(f, c, wants_current, i)) {
            continue;
        }
        int device = f->device[i];
        struct loop loop = walk_loop(f, c, device, NULL);
        double left;
        enum dalcs_sum_verdict verdict = dalcs_source_sum_judge(c, &loop.sum, &left);
        loop = verdict != DALCS_SUM_UNKNOWN ? walk_loop(f, c, device, arena) : loop;
        if (verdict == DALCS_SUM_CONTRADICTS) {
            report_loop(c, device, &loop, left, arena, diag);
            status = DALCS_E_NETLIST;
        } else if (verdict == DALCS_SUM_AGREES &&
                   c->device[device].node[0] != c->device[device].node[1]) {
            say_idle(c, device, &loop, arena, diag);
        }
        n_messages += verdict == DALCS_SUM_UNKNOWN ? 0 : 1;
    }
    return status;
}

static void mark_idle(const struct forest *f, const struct dalcs_circuit *c,
                      const bool *wants_current, bool *idle) {
    for (int i = 0; f->has_loops && i < f->n; i++) {
        if (closes_loop(f, c, wants_current, i)) {
            struct loop loop = walk_loop(f, c, f->device[i], NULL);
            double left;
            idle[f->device[i]] = dalcs_source_sum_judge(c, &loop.sum, &left) == DALCS_SUM_AGREES;
        }
    }
}

static void forest_finish(struct forest *f) {
    free(f->device);
    free(f->is_tree);
    free(f->start);
    free(f->arc);
    free(f->up);
    free(f->depth);
    free(f->queue);
}

static enum dalcs_status forest_setup(struct forest *f, const struct dalcs_circuit *c,
                                      const bool *wants_current) {
    size_t n_nodes = (size_t)c->n_nodes;
    size_t n = 0;
    for (int i = 0; i < c->n_devices; i++) {
        n += rank_of(&c->device[i], wants_current[i]) >= 0;
    }
    *f = (struct forest){.device = dalcs_alloc(n, sizeof(int)),
                         .is_tree = dalcs_alloc(n, sizeof(bool)),
                         .queue = dalcs_alloc(n_nodes, sizeof(int))};
    if (f->device == NULL || f->is_tree == NULL || f->queue == NULL) {
        forest_finish(f);
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < c->n_devices; i++) {
        if (rank_of(&c->device[i], wants_current[i]) >= 0) {
            f->device[f->n++] = i;
        }
    }
    grow(f, c, wants_current);
    if (!f->has_loops) {
        return DALCS_OK;
    }
    f->start = dalcs_alloc(n_nodes + 1, sizeof(int));
    f->arc = dalcs_alloc(2 * n, sizeof(int));
    f->up = dalcs_alloc(n_nodes, sizeof(int));
    f->depth = dalcs_alloc(n_nodes, sizeof(int));
    if (f->start == NULL || f->arc == NULL || f->up == NULL || f->depth == NULL) {
        forest_finish(f);
        return DALCS_E_NOMEM;
    }
    list_arcs(f, c);
    root(f, c);
    return DALCS_OK;
}

enum dalcs_status dalcs_source_mark_idle(const struct dalcs_circuit *circuit,
                                         const bool *wants_current, bool *idle) {
    struct forest f;
    DALCS_TRY(forest_setup(&f, circuit, wants_current));
    mark_idle(&f, circuit, wants_current, idle);
    forest_finish(&f);
    return DALCS_OK;
}

enum dalcs_status dalcs_source_loops_check(const struct dalcs_circuit *c, struct dalcs_arena *arena,
                                           struct dalcs_diag *diag) {
    struct forest f;
    bool *wants_current = dalcs_alloc((size_t)c->n_devices, sizeof(*wants_current));
    if (wants_current == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_circuit_mark_wanted_currents(c, wants_current);
    enum dalcs_status status = forest_setup(&f, c, wants_current);
    if (status == DALCS_OK) {
        status = report_loops(&f, c, wants_current, arena, diag);
        forest_finish(&f);
    }
    free(wants_current);
    return status;
}
