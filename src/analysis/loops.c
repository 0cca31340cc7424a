/* loops.c - currents that may circulate.
 *
 * A branch may carry more ahead, and less down to where its sign ends. A difference of two answers is
 * a circulation in these bounds. Branches between vertices that do not reach each other are on none;
 * of the others those on a common loop are. How far one of them may go is a greatest flow from its head
 * to its tail through the others. */
#include "branch_graph.h"
#include "freedom.h"
#include "names.h"

#include <math.h>

struct loops {
    struct dalcs_view *view;
    struct dalcs_branch_graph graph;
    int n;
    struct dalcs_branch *branch; /* [n] */
    int *freedom;                /* [n] what each of them is */
    int *block;                  /* [n] */
    int n_blocks;
    int *start, *member; /* of block k: member[start[k]..start[k + 1] - 1] */
    bool *has_coils;     /* [n_blocks] */
    int *first_signal;   /* of block k: signal[first_signal[k]..first_signal[k + 1] - 1] */
    struct dalcs_open_signal *signal;
};

static enum dalcs_status list_branches(struct loops *l) {
    struct dalcs_view *view = l->view;
    size_t most = (size_t)view->n;
    l->branch = dalcs_arena_alloc(view->work, most, sizeof(*l->branch));
    l->freedom = dalcs_arena_alloc(view->work, most, sizeof(*l->freedom));
    l->block = dalcs_arena_alloc(view->work, most, sizeof(*l->block));
    if (l->branch == NULL || l->freedom == NULL || l->block == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < view->n; i++) {
        const struct dalcs_freedom *f = &view->freedom[i];
        if (!f->may_carry) {
            continue;
        }
        if (f->device >= 0) {
            int *slot = &view->u->branch_of[2 * f->device];
            slot[slot[0] < 0 ? 0 : 1] = l->n;
        }
        l->freedom[l->n] = i;
        l->branch[l->n++] = (struct dalcs_branch){.tail = view->u->vertex_of[f->node[0]],
                                                  .head = view->u->vertex_of[f->node[1]],
                                                  .ahead = INFINITY,
                                                  .back = f->back};
    }
    return dalcs_branch_graph_setup(&l->graph, view->work, view->n_vertices, l->n, l->branch);
}

/* Coils that perfect coupling ties make one problem of all blocks that they are in. */
static void join_coupled_blocks(struct loops *l) {
    int common = -1;
    for (int e = 0; e < l->n; e++) {
        if (l->block[e] >= 0 && l->view->freedom[l->freedom[e]].is_coil) {
            l->has_coils[l->block[e]] = true;
            common = common < 0 ? l->block[e] : common;
        }
    }
    for (int e = 0; e < l->n; e++) {
        if (l->block[e] >= 0 && l->has_coils[l->block[e]]) {
            l->block[e] = common;
        }
    }
}

static enum dalcs_status find_blocks(struct loops *l) {
    struct dalcs_arena *work = l->view->work;
    int *part = dalcs_arena_alloc(work, (size_t)l->view->n_vertices, sizeof(*part));
    l->member = dalcs_arena_alloc(work, (size_t)l->n, sizeof(*l->member));
    if (part == NULL || l->member == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_branch_graph_circuits(&l->graph, part);
    for (int e = 0; e < l->n; e++) {
        if (part[l->branch[e].tail] != part[l->branch[e].head]) {
            l->branch[e].ahead = l->branch[e].back = 0.0;
        }
    }
    l->n_blocks = dalcs_branch_graph_blocks(&l->graph, l->block);
    l->start = dalcs_arena_alloc(work, (size_t)l->n_blocks + 2, sizeof(*l->start));
    l->has_coils = dalcs_arena_alloc(work, (size_t)l->n_blocks, sizeof(*l->has_coils));
    if (l->start == NULL || l->has_coils == NULL) {
        return DALCS_E_NOMEM;
    }
    join_coupled_blocks(l);
    for (int e = 0; e < l->n; e++) {
        if (l->block[e] >= 0) {
            l->start[l->block[e] + 2]++;
        }
    }
    for (int k = 0; k < l->n_blocks; k++) {
        l->start[k + 2] += l->start[k + 1];
    }
    for (int e = 0; e < l->n; e++) {
        if (l->block[e] >= 0) {
            l->member[l->start[l->block[e] + 1]++] = e;
        }
    }
    return DALCS_OK;
}

/* The largest rise and fall of the current of a device. Its own branches bound it, and what the others let
 * flow back. */
static void find_interval(const struct loops *l, int device, struct dalcs_open_signal *signal) {
    const int *own = &l->view->u->branch_of[2 * device];
    const struct dalcs_device *d = &l->view->u->circuit->device[device];
    int tail = l->view->u->vertex_of[d->node[0]];
    int head = l->view->u->vertex_of[d->node[1]];
    double rise = 0.0;
    double fall = 0.0;
    for (int k = 0; k < 2 && own[k] >= 0; k++) {
        const struct dalcs_branch *b = &l->branch[own[k]];
        bool reversed = l->view->freedom[l->freedom[own[k]]].node[0] != d->node[0];
        rise += reversed ? b->back : b->ahead;
        fall += reversed ? b->ahead : b->back;
    }
    if (rise > 0.0) {
        rise = fmin(rise, dalcs_branch_graph_flow(&l->graph, head, tail, own));
    }
    if (fall > 0.0) {
        fall = fmin(fall, dalcs_branch_graph_flow(&l->graph, tail, head, own));
    }
    dalcs_view_bound(l->view, true, fall, rise, signal);
}

/* Which block the current of an output is in; -1: none. */
static int block_of(const struct loops *l, int output) {
    int device = dalcs_view_current_of(l->view, output);
    const int *own = device >= 0 ? &l->view->u->branch_of[2 * device] : NULL;
    int block = -1;
    for (int b = 0; own != NULL && b < 2; b++) {
        block = own[b] >= 0 && l->block[own[b]] >= 0 ? l->block[own[b]] : block;
    }
    return block;
}

static enum dalcs_status sort_signals(struct loops *l) {
    size_t n_outputs = (size_t)l->view->network->n_outputs;
    int *part = dalcs_arena_alloc(l->view->work, n_outputs, sizeof(*part));
    if (part == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < l->view->network->n_outputs; i++) {
        part[i] = block_of(l, i);
    }
    return dalcs_view_sort_signals(l->view, l->n_blocks, part, &l->first_signal, &l->signal);
}

/* Switches, and diodes across them? */
static bool is_shunted_switch(const struct dalcs_view *view, int n, const int *part) {
    int n_switches = 0;
    bool has_others = false;
    for (int k = 0; k < n; k++) {
        const struct dalcs_freedom *f = &view->freedom[part[k]];
        bool is_switch = f->device >= 0 && view->u->circuit->device[f->device].kind == DALCS_SWITCH;
        n_switches += is_switch ? 1 : 0;
        has_others = has_others || !(is_switch || f->is_diode);
    }
    return n_switches > 0 && n_switches < n && !has_others &&
           dalcs_view_are_parallel(view, n, part);
}

/* A thyristor is a switch behind a valve, an inner diode: where its end is, if the two are alone at a node; else -1.
 * *end: the switch's terminal there. */
static int behind_valve(const struct dalcs_view *view, const struct dalcs_freedom *valve,
                        const struct dalcs_freedom *f, int *end) {
    for (int k = 0; k < 4 && f->device >= 0; k++) {
        const int node = valve->node[k / 2];
        if (view->u->circuit->device[f->device].kind == DALCS_SWITCH && f->node[k % 2] == node &&
            dalcs_names_is_inner(view->u->circuit->node_name[node])) {
            *end = k % 2;
            return valve->node[1 - k / 2];
        }
    }
    return -1;
}

/* Takes valves out of part[0..n-1]: their switches reach to the end of both until unfold_valves(). Returns how many
 * are left; those taken out follow them. */
static int fold_valves(struct dalcs_view *view, int n, int *part) {
    int left = n;
    for (int e = 0; e < left; e++) {
        struct dalcs_freedom *valve = &view->freedom[part[e]];
        int end;
        int node = -1;
        for (int i = 0; i < n && node < 0 && valve->is_diode && dalcs_names_is_inner(valve->name);
             i++) {
            struct dalcs_freedom *f = &view->freedom[part[i]];
            node = behind_valve(view, valve, f, &end);
            if (node >= 0) {
                f->node[end] = node;
            }
        }
        if (node >= 0) {
            const int taken = part[e];
            part[e--] = part[--left];
            part[left] = taken;
        }
    }
    return left;
}

static void unfold_valves(struct dalcs_view *view, int n, const int *part) {
    for (int e = 0; e < n; e++) {
        struct dalcs_freedom *f = &view->freedom[part[e]];
        const struct dalcs_device *d = f->device >= 0 ? &view->u->circuit->device[f->device] : NULL;
        if (d != NULL && d->kind == DALCS_SWITCH) {
            f->node[0] = d->node[0];
            f->node[1] = d->node[1];
        }
    }
}

static enum dalcs_status tell_block(struct loops *l, int k) {
    struct dalcs_view *view = l->view;
    int n = l->start[k + 1] - l->start[k];
    int *part = l->member + l->start[k];
    struct dalcs_finding finding = {.device = -1,
                                    .has_intervals = true,
                                    .signal = l->signal + l->first_signal[k],
                                    .n_signals = l->first_signal[k + 1] - l->first_signal[k]};
    if (finding.n_signals == 0) {
        return DALCS_OK;
    }
    if (!l->has_coils[k]) {
        for (int i = 0; i < finding.n_signals; i++) {
            struct dalcs_open_signal *s = &finding.signal[i];
            find_interval(l, view->u->circuit->results.signal[s->output].device, s);
        }
    }
    for (int e = 0; e < n; e++) { /* of the graph's branches to the view's */
        part[e] = l->freedom[part[e]];
    }
    const int left = l->has_coils[k] ? n : fold_valves(view, n, part);
    for (int e = 0; e < left; e++) {
        dalcs_view_place(&view->freedom[part[e]], &finding);
    }
    if (l->has_coils[k]) {
        DALCS_TRY(dalcs_coils_intervals(view, n, part, finding.n_signals, finding.signal,
                                        &finding.has_intervals));
    }
    finding.hint = finding.has_intervals ? NULL : dalcs_coils_hint();
    int n_open = 0;
    for (int i = 0; i < finding.n_signals; i++) {
        const struct dalcs_open_signal *s = &finding.signal[i];
        if (!finding.has_intervals || dalcs_view_is_open(view, true, s->lower, s->upper)) {
            finding.signal[n_open++] = *s;
        }
    }
    finding.n_signals = n_open;
    finding.kind =
        is_shunted_switch(view, left, part) ? DALCS_SHUNTED_SWITCHES : DALCS_OPEN_CURRENTS;
    finding.because = n_open > 0 ? dalcs_words_for_loop(view, left, part) : "";
    unfold_valves(view, left, part);
    return dalcs_view_tell(view, &finding);
}

/* Coupling alone puts a coil on no loop: one whose current is what it is carries no more. *left_out: there are such. */
static enum dalcs_status leave_out_coils(struct loops *l, int k, bool *left_out) {
    struct dalcs_view *view = l->view;
    const int n = l->start[k + 1] - l->start[k];
    int *part = dalcs_arena_alloc(view->work, (size_t)n, sizeof(*part));
    bool *moves = dalcs_arena_alloc(view->work, (size_t)n, sizeof(*moves));
    if (part == NULL || moves == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int e = 0; e < n; e++) {
        part[e] = l->freedom[l->member[l->start[k] + e]];
    }
    DALCS_TRY(dalcs_coils_moving(view, n, part, moves));
    for (int e = 0; e < n; e++) {
        struct dalcs_freedom *f = &view->freedom[part[e]];
        if (f->is_coil && !moves[e]) {
            f->may_carry = false;
            *left_out = true;
        }
    }
    return DALCS_OK;
}

static enum dalcs_status list_blocks(struct loops *l) {
    for (int i = 0; i < l->view->n; i++) {
        const int device = l->view->freedom[i].device;
        if (device >= 0) {
            l->view->u->branch_of[2 * device] = l->view->u->branch_of[2 * device + 1] = -1;
        }
    }
    l->n = 0;
    DALCS_TRY(list_branches(l));
    return find_blocks(l);
}

enum dalcs_status dalcs_loops_find(struct dalcs_view *view) {
    struct loops l = {.view = view};
    bool left_out = false;
    DALCS_TRY(list_blocks(&l));
    for (int k = 0; k < l.n_blocks; k++) {
        if (l.has_coils[k] && l.start[k + 1] > l.start[k]) {
            DALCS_TRY(leave_out_coils(&l, k, &left_out));
        }
    }
    if (left_out) {
        DALCS_TRY(list_blocks(&l));
    }
    DALCS_TRY(sort_signals(&l));
    for (int k = 0; k < l.n_blocks; k++) {
        if (l.start[k + 1] > l.start[k]) {
            DALCS_TRY(tell_block(&l, k));
        }
    }
    return DALCS_OK;
}
