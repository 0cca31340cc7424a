/* islands.c - voltages between parts that nothing conducts between.
 *
 * What holds a voltage makes islands of nodes. Between them a diode allows v(anode) <= v(cathode) plus
 * what it blocks now and has to spare, so the highest that one island may stand over another is the
 * shortest way from it along diodes, anode to cathode. Islands that diodes without current and voltage
 * connect in a circle stay together. */
#include "branch_graph.h"
#include "freedom.h"

#include "union_find.h"

#include <math.h>

struct islands {
    struct dalcs_view *view;
    int *island_of; /* [n_vertices] a vertex of the island */
    int *parent;    /* [n_vertices] of islands that float together */
    int n;          /* diodes between islands */
    struct dalcs_branch *branch;
    double *slack; /* [n] */
    struct dalcs_branch_graph graph;
    double *above, *below; /* [n_vertices] how far ground's island may be under and over others */
    double *other;         /* [n_vertices] work */
    int *first_signal;     /* of cause k: signal[first_signal[k]..first_signal[k + 1] - 1] */
    struct dalcs_open_signal *signal;
    int *first_border, *border; /* the same of what borders on it */
    int *first_vertex, *vertex; /* and of what it opens */
};

static void hold(struct islands *s) {
    const struct dalcs_view *view = s->view;
    const struct dalcs_topology *t = &view->u->topology;
    dalcs_union_reset(s->island_of, view->n_vertices);
    for (int i = 0; i < view->n; i++) {
        const struct dalcs_freedom *f = &view->freedom[i];
        if (f->voltage == DALCS_VOLTAGE_FIXED) {
            dalcs_union_join(s->island_of, view->u->vertex_of[f->node[0]],
                             view->u->vertex_of[f->node[1]]);
        }
    }
    for (int v = 0; v < view->n_vertices; v++) { /* a voltage by convention, 0 */
        if (t->is_reference[t->node_of[view->node[v]]]) {
            dalcs_union_join(s->island_of, 0, v);
        }
    }
}

static void flatten(struct islands *s) {
    for (int v = 0; v < s->view->n_vertices; v++) {
        s->island_of[v] = dalcs_union_find(s->island_of, v);
    }
}

/* Diodes between islands: at first only those that are tied, to join what they connect in circles. */
static enum dalcs_status list_diodes(struct islands *s, int *part) {
    const struct dalcs_view *view = s->view;
    s->branch = dalcs_arena_alloc(view->work, (size_t)view->n, sizeof(*s->branch));
    s->slack = dalcs_arena_alloc(view->work, (size_t)view->n, sizeof(*s->slack));
    if (s->branch == NULL || s->slack == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < view->n; i++) {
        const struct dalcs_freedom *f = &view->freedom[i];
        int tail = s->island_of[view->u->vertex_of[f->node[0]]];
        int head = s->island_of[view->u->vertex_of[f->node[1]]];
        if (f->voltage == DALCS_VOLTAGE_BELOW && tail != head) {
            s->slack[s->n] = f->slack;
            s->branch[s->n++] = (struct dalcs_branch){tail, head, f->is_tied ? 1.0 : 0.0, 0.0};
        }
    }
    DALCS_TRY(dalcs_branch_graph_setup(&s->graph, view->work, view->n_vertices, s->n, s->branch));
    dalcs_branch_graph_circuits(&s->graph, part);
    for (int e = 0; e < s->n; e++) {
        if (part[s->branch[e].tail] == part[s->branch[e].head]) {
            dalcs_union_join(s->island_of, s->branch[e].tail, s->branch[e].head);
        }
        s->branch[e].ahead = 1.0;
    }
    flatten(s);
    for (int e = 0; e < s->n; e++) {
        s->branch[e].tail = s->island_of[s->branch[e].tail];
        s->branch[e].head = s->island_of[s->branch[e].head];
    }
    return dalcs_branch_graph_setup(&s->graph, view->work, view->n_vertices, s->n, s->branch);
}

/* Islands other than ground's that open elements connect are one cause. */
static void join_causes(struct islands *s) {
    const struct dalcs_view *view = s->view;
    dalcs_union_reset(s->parent, view->n_vertices);
    for (int i = 0; i < view->n; i++) {
        int a = s->island_of[view->u->vertex_of[view->freedom[i].node[0]]];
        int b = s->island_of[view->u->vertex_of[view->freedom[i].node[1]]];
        if (a != 0 && b != 0) {
            dalcs_union_join(s->parent, a, b);
        }
    }
}

static enum dalcs_status allocate(struct islands *s, int **part) {
    size_t n = (size_t)s->view->n_vertices;
    struct dalcs_arena *work = s->view->work;
    s->island_of = dalcs_arena_alloc(work, n, sizeof(int));
    s->parent = dalcs_arena_alloc(work, n, sizeof(int));
    *part = dalcs_arena_alloc(work, n, sizeof(int));
    s->above = dalcs_arena_alloc(work, n, sizeof(double));
    s->below = dalcs_arena_alloc(work, n, sizeof(double));
    s->other = dalcs_arena_alloc(work, n, sizeof(double));
    bool complete = s->island_of != NULL && s->parent != NULL && *part != NULL &&
                    s->above != NULL && s->below != NULL && s->other != NULL;
    return complete ? DALCS_OK : DALCS_E_NOMEM;
}

/* The island of a node in this component, or ground's. */
static int island(const struct islands *s, int node) {
    int v = s->view->u->vertex_of[node];
    return v < 0 ? 0 : s->island_of[v];
}

static void find_interval(const struct islands *s, int a, int b, struct dalcs_open_signal *signal) {
    const struct dalcs_told *other = &s->view->u->told[signal->output];
    double rise = s->above[a];
    double fall = s->below[a];
    if (b != 0) {
        dalcs_branch_graph_distances(&s->graph, a, s->slack, false, s->other);
        rise = s->other[b];
        dalcs_branch_graph_distances(&s->graph, a, s->slack, true, s->other);
        fall = s->other[b];
    }
    dalcs_view_bound(s->view, false, fall + other->fall, rise + other->rise, signal);
}

/* A voltage of this component that was not told of, or, between it and another one, only for what the
 * other one leaves open at the same time. */
static bool concerns(const struct islands *s, int output) {
    const struct dalcs_output *out = &s->view->network->output[output];
    const struct dalcs_told *told = &s->view->u->told[output];
    int here = s->view->at->system;
    bool is_here = out->plus.system == here || out->minus.system == here;
    bool is_news = !told->is_told || (told->system != here && told->time == s->view->at->time);
    return is_here && !out->is_current && is_news;
}

/* Which cause opens a voltage; -1: none. */
static int cause_of(struct islands *s, int output) {
    if (!concerns(s, output)) {
        return -1;
    }
    const int *node = s->view->u->circuit->results.signal[output].node;
    int a = island(s, node[0]);
    int b = island(s, node[1]);
    return a == b ? -1 : dalcs_union_find(s->parent, a != 0 ? a : b);
}

static enum dalcs_status sort_signals(struct islands *s) {
    struct dalcs_view *view = s->view;
    size_t n_outputs = (size_t)view->network->n_outputs;
    int *part = dalcs_arena_alloc(view->work, n_outputs, sizeof(*part));
    if (part == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < view->network->n_outputs; i++) {
        part[i] = cause_of(s, i);
    }
    return dalcs_view_sort_signals(view, view->n_vertices, part, &s->first_signal, &s->signal);
}

/* Keeps the signals of a cause that may go somewhere. */
static void find_intervals(struct islands *s, struct dalcs_finding *finding) {
    int n_open = 0;
    for (int k = 0; k < finding->n_signals; k++) {
        struct dalcs_open_signal *signal = &finding->signal[k];
        const int *node = s->view->u->circuit->results.signal[signal->output].node;
        find_interval(s, island(s, node[0]), island(s, node[1]), signal);
        if (dalcs_view_is_open(s->view, false, signal->lower, signal->upper)) {
            finding->signal[n_open++] = *signal;
        }
    }
    finding->n_signals = n_open;
}

/* Lists items by cause[n_items] (-1: of none): those of cause k are item[start[k]..start[k + 1] - 1]. */
static enum dalcs_status sort_items(const struct islands *s, int n_items, const int *cause,
                                    int **start, int **item) {
    int n_causes = s->view->n_vertices;
    *start = dalcs_arena_alloc(s->view->work, (size_t)n_causes + 2, sizeof(**start));
    *item = dalcs_arena_alloc(s->view->work, (size_t)n_items, sizeof(**item));
    if (*start == NULL || *item == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < n_items; i++) {
        (*start)[cause[i] >= 0 ? cause[i] + 2 : 0]++;
    }
    (*start)[0] = 0;
    for (int k = 0; k < n_causes; k++) {
        (*start)[k + 2] += (*start)[k + 1];
    }
    for (int i = 0; i < n_items; i++) {
        if (cause[i] >= 0) {
            (*item)[(*start)[cause[i] + 1]++] = i;
        }
    }
    return DALCS_OK;
}

/* What borders on the islands of a cause, and their vertices, for words. */
static enum dalcs_status sort_parts(struct islands *s) {
    const struct dalcs_view *view = s->view;
    int n = view->n > view->n_vertices ? view->n : view->n_vertices;
    int *cause = dalcs_arena_alloc(view->work, (size_t)n, sizeof(*cause));
    if (cause == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < view->n; i++) {
        const struct dalcs_freedom *f = &view->freedom[i];
        int a = s->island_of[view->u->vertex_of[f->node[0]]];
        int b = s->island_of[view->u->vertex_of[f->node[1]]];
        bool is_border = a != b && !f->is_source;
        cause[i] = is_border ? dalcs_union_find(s->parent, a != 0 ? a : b) : -1;
    }
    DALCS_TRY(sort_items(s, view->n, cause, &s->first_border, &s->border));
    for (int v = 0; v < view->n_vertices; v++) {
        int of = s->island_of[v];
        cause[v] = of != 0 ? dalcs_union_find(s->parent, of) : -1;
    }
    return sort_items(s, view->n_vertices, cause, &s->first_vertex, &s->vertex);
}

static void describe(struct islands *s, int cause, struct dalcs_finding *finding) {
    const struct dalcs_view *view = s->view;
    int *border = s->border + s->first_border[cause];
    int *node = s->vertex + s->first_vertex[cause];
    int n = s->first_border[cause + 1] - s->first_border[cause];
    int n_nodes = s->first_vertex[cause + 1] - s->first_vertex[cause];
    for (int k = 0; k < n; k++) {
        dalcs_view_place(&view->freedom[border[k]], finding);
    }
    for (int k = 0; k < n_nodes; k++) { /* of the view's vertices to the circuit's nodes */
        node[k] = view->node[node[k]];
    }
    finding->kind = DALCS_OPEN_VOLTAGES;
    finding->because =
        dalcs_words_for_island(view, s->island_of, n_nodes, node, n, border, &finding->brief);
}

enum dalcs_status dalcs_islands_find(struct dalcs_view *view) {
    struct islands s = {.view = view};
    int *part;
    DALCS_TRY(allocate(&s, &part));
    hold(&s);
    flatten(&s);
    DALCS_TRY(list_diodes(&s, part));
    join_causes(&s);
    DALCS_TRY(sort_signals(&s));
    DALCS_TRY(sort_parts(&s));
    dalcs_branch_graph_distances(&s.graph, 0, s.slack, true, s.above);
    dalcs_branch_graph_distances(&s.graph, 0, s.slack, false, s.below);
    for (int v = 1; v < view->n_vertices; v++) {
        struct dalcs_finding finding = {.device = -1,
                                        .has_intervals = true,
                                        .signal = s.signal + s.first_signal[v],
                                        .n_signals = s.first_signal[v + 1] - s.first_signal[v]};
        find_intervals(&s, &finding);
        if (finding.n_signals > 0) {
            describe(&s, v, &finding);
        }
        DALCS_TRY(dalcs_view_tell(view, &finding));
    }
    return DALCS_OK;
}
