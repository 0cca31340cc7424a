/* source_conflicts.c - sources that contradict each other by themselves, or leave a current open.
 *
 * V sources and shorts form a forest, and every further V source closes one loop with it. Everything
 * but current sources merges nodes, and what is then not ground is a part that only they reach. Both are
 * a sum of sources that must be 0 at all times. */
#include "source_conflicts.h"

#include "quantity.h"
#include "rounding.h"
#include "union_find.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_MESSAGES = 20, /* the run finds the rest */
    MOST_TERMS = 60     /* of a sum that is looked at */
};

/* What a sum of constants leaves, over its size, that is certainly not 0. */
static const double surely = 1e-9;

/* Sources with a sign. */
struct sum {
    int n;
    int device[MOST_TERMS];
    double sign[MOST_TERMS];
};

enum verdict { CONTRADICT, AGREE, UNKNOWN };

static bool same_points(const struct dalcs_stimulus *a, const struct dalcs_stimulus *b) {
    size_t n = (size_t)a->u.pwl.n;
    return a->u.pwl.n == b->u.pwl.n && a->u.pwl.repeats == b->u.pwl.repeats &&
           a->u.pwl.repeat_from == b->u.pwl.repeat_from &&
           memcmp(a->u.pwl.t, b->u.pwl.t, n * sizeof(double)) == 0 &&
           memcmp(a->u.pwl.v, b->u.pwl.v, n * sizeof(double)) == 0;
}

/* The same function of time, and the same operating value? */
static bool same(const struct dalcs_stimulus *a, const struct dalcs_stimulus *b) {
    if (a->kind != b->kind || a->has_dc != b->has_dc || (a->has_dc && a->dc != b->dc)) {
        return false;
    }
    switch (a->kind) {
    case DALCS_STIMULUS_SIN:
        return memcmp(&a->u.sine, &b->u.sine, sizeof(a->u.sine)) == 0;
    case DALCS_STIMULUS_PULSE:
        return memcmp(&a->u.pulse, &b->u.pulse, sizeof(a->u.pulse)) == 0;
    case DALCS_STIMULUS_PWL:
        return same_points(a, b);
    case DALCS_STIMULUS_EXP:
        return memcmp(&a->u.exponential, &b->u.exponential, sizeof(a->u.exponential)) == 0;
    case DALCS_STIMULUS_TONES:
        return a->u.tones.offset == b->u.tones.offset && a->u.tones.delay == b->u.tones.delay &&
               a->u.tones.n == b->u.tones.n &&
               memcmp(a->u.tones.tone, b->u.tones.tone,
                      (size_t)a->u.tones.n * sizeof(*a->u.tones.tone)) == 0;
    default:
        return a->dc == b->dc;
    }
}

static const struct dalcs_stimulus *stimulus_of(const struct dalcs_circuit *c, int device) {
    return &c->stimulus[c->device[device].stimulus];
}

/* Is the sum 0 at all times? Equal functions cancel; what is left must be constant to be judged.
 * *left: what is left over. */
static enum verdict judge(const struct dalcs_circuit *c, const struct sum *s, double *left) {
    bool gone[MOST_TERMS] = {false};
    double size = 0.0;
    *left = 0.0;
    if (s->n > MOST_TERMS) {
        return UNKNOWN;
    }
    for (int i = 0; i < s->n; i++) {
        const struct dalcs_stimulus *a = stimulus_of(c, s->device[i]);
        for (int j = i + 1; j < s->n && a->kind != DALCS_STIMULUS_DC && !gone[i]; j++) {
            if (!gone[j] && s->sign[i] == -s->sign[j] && same(a, stimulus_of(c, s->device[j]))) {
                gone[i] = gone[j] = true;
            }
        }
        if (a->kind != DALCS_STIMULUS_DC && !gone[i]) {
            return UNKNOWN;
        }
        if (a->kind == DALCS_STIMULUS_DC) {
            *left += s->sign[i] * a->dc;
            size += fabs(a->dc);
        }
    }
    return fabs(*left) > surely * size           ? CONTRADICT
           : fabs(*left) <= dalcs_rounded * size ? AGREE
                                                 : UNKNOWN;
}

static void add_term(struct sum *s, int device, double sign) {
    if (s->n < MOST_TERMS) {
        s->device[s->n] = device;
        s->sign[s->n] = sign;
    }
    s->n++;
}

/* "v1 (5 V)", of a function of time "v1", of a short "r1". */
static const char *element_text(struct dalcs_arena *a, const struct dalcs_circuit *c, int device) {
    const struct dalcs_device *d = &c->device[device];
    if (d->stimulus < 0 || c->stimulus[d->stimulus].kind != DALCS_STIMULUS_DC) {
        return d->name;
    }
    char value[DALCS_QUANTITY_SIZE];
    (void)dalcs_quantity_write(value, c->stimulus[d->stimulus].dc,
                               d->kind == DALCS_VSOURCE ? "V" : "A", 6);
    const char *text = dalcs_arena_printf(a, "%s (%s)", d->name, value);
    return text == NULL ? d->name : text;
}

/* "a, b"; either may be empty. */
static const char *listed(struct dalcs_arena *a, const char *before, const char *after) {
    if (*before == '\0' || *after == '\0') {
        return *before == '\0' ? after : before;
    }
    const char *text = dalcs_arena_printf(a, "%s, %s", before, after);
    return text == NULL ? before : text;
}

/* ---- Loops of voltage sources --------------------------------------------------------------- */

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
    struct sum sum;   /* of its sources' voltages */
    const char *rest; /* its elements but the source that closes it, in order */
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
        add_term(&loop.sum, closing, 1.0);
    }
    for (int n = 0; node[0] != node[1] && loop.sum.n <= MOST_TERMS; n++) {
        int side = f->depth[node[0]] >= f->depth[node[1]] ? 0 : 1;
        int up = f->up[node[side]];
        const struct dalcs_device *e = &c->device[up];
        if (e->kind == DALCS_VSOURCE) {
            add_term(&loop.sum, up, (e->node[0] == node[side]) == (side == 0) ? -1.0 : 1.0);
        }
        if (n < MOST_TERMS && arena != NULL) {
            const char *text = element_text(arena, c, up);
            way[side] = side == 0 ? listed(arena, text, way[0]) : listed(arena, way[1], text);
        }
        node[side] = other_end(e, node[side]);
    }
    loop.rest = arena != NULL ? listed(arena, way[1], way[0]) : "";
    return loop;
}

static void report_loop(const struct dalcs_circuit *c, int closing, const struct loop *loop,
                        double left, struct dalcs_arena *arena, struct dalcs_diag *diag) {
    const struct dalcs_device *d = &c->device[closing];
    const char *source = element_text(arena, c, closing);
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
        element_text(arena, c, closing), loop->rest, d->name);
}

static enum dalcs_status report_loops(const struct forest *f, const struct dalcs_circuit *c,
                                      const bool *wants_current, struct dalcs_arena *arena,
                                      struct dalcs_diag *diag) {
    enum dalcs_status status = DALCS_OK;
    int n_messages = 0;
    for (int i = 0; f->has_loops && i < f->n && n_messages < MOST_MESSAGES; i++) {
        if (!closes_loop(f, c, wants_current, i)) {
            continue;
        }
        int device = f->device[i];
        struct loop loop = walk_loop(f, c, device, NULL);
        double left;
        enum verdict verdict = judge(c, &loop.sum, &left);
        loop = verdict != UNKNOWN ? walk_loop(f, c, device, arena) : loop;
        if (verdict == CONTRADICT) {
            report_loop(c, device, &loop, left, arena, diag);
            status = DALCS_E_NETLIST;
        } else if (verdict == AGREE && c->device[device].node[0] != c->device[device].node[1]) {
            say_idle(c, device, &loop, arena, diag);
        }
        n_messages += verdict == UNKNOWN ? 0 : 1;
    }
    return status;
}

static void mark_idle(const struct forest *f, const struct dalcs_circuit *c,
                      const bool *wants_current, bool *idle) {
    for (int i = 0; f->has_loops && i < f->n; i++) {
        if (closes_loop(f, c, wants_current, i)) {
            struct loop loop = walk_loop(f, c, f->device[i], NULL);
            double left;
            idle[f->device[i]] = judge(c, &loop.sum, &left) == AGREE;
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

static enum dalcs_status check_loops(const struct dalcs_circuit *c, struct dalcs_arena *arena,
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

/* ---- Parts that only current sources reach -------------------------------------------------- */

struct part {
    struct sum into;
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
            add_term(&p->into, i, to ? 1.0 : -1.0);
        }
    }
}

static const char *nodes_of(const struct dalcs_circuit *c, int *whole, int part,
                            struct dalcs_arena *arena) {
    const char *list = "";
    int n = 0;
    for (int k = 0; k < c->n_nodes && list != NULL; k++) {
        if (dalcs_union_find(whole, k) != part || n++ >= MOST_MESSAGES) {
            continue;
        }
        list = dalcs_arena_printf(arena, "%s%s%s", list, n > 1 ? ", " : "", c->node_name[k]);
    }
    list = list != NULL && n > MOST_MESSAGES
               ? dalcs_arena_printf(arena, "%s and %d more", list, n - MOST_MESSAGES)
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
        *list = listed(arena, *list, element_text(arena, c, p->into.device[k]));
    }
    if (p->into.n == 1) {
        dalcs_diag_add(diag, DALCS_ERROR, where, NULL,
                       "nothing but %s reaches %s: its current has no way %s",
                       listed(arena, in, out), nodes, left > 0.0 ? "out" : "in");
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
        is_seen[0] = true; /* the rest of the circuit sees to ground */
    }
    for (int i = 0; i < c->n_devices && status == DALCS_OK; i++) {
        if (!is_current_source(&c->device[i])) {
            dalcs_union_join(whole, c->device[i].node[0], c->device[i].node[1]);
        }
    }
    for (int k = 0; k < 2 * c->n_devices && whole != NULL && is_seen != NULL; k++) {
        const struct dalcs_device *d = &c->device[k / 2];
        int part = dalcs_union_find(whole, d->node[k % 2]);
        if (d->kind != DALCS_ISOURCE || is_seen[part] || n_parts >= MOST_MESSAGES) {
            continue;
        }
        struct part p;
        double left;
        is_seen[part] = true;
        n_parts++;
        list_border(&p, c, whole, part);
        if (p.is_known && judge(c, &p.into, &left) == CONTRADICT) {
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
    enum dalcs_status status = check_loops(circuit, &arena, diag);
    if (status != DALCS_E_NOMEM) {
        enum dalcs_status parts = check_parts(circuit, &arena, diag);
        status = parts != DALCS_OK ? parts : status;
    }
    dalcs_arena_finish(&arena);
    return status;
}
