/* words.c - why something is not determined, as an engineer would say it. */
#include "freedom.h"

/* Names in a list, at most. */
enum { MOST_NAMES = 12 };

static const char *name_of(const struct dalcs_view *view, const int *part, int k) {
    return view->freedom[part[k]].name;
}

/* "d1, d2 and d3" or, between - and -, "d1-d2-d3". */
static const char *join(const struct dalcs_view *view, const char *list, int k, int n,
                        const char *name, bool in_order) {
    if (list == NULL || k > MOST_NAMES) {
        return list;
    }
    if (k == MOST_NAMES && n > MOST_NAMES + 1) {
        return dalcs_arena_printf(view->work, in_order ? "%s-... (%d more)" : "%s and %d more",
                                  list, n - k);
    }
    const char *between = k == 0 ? "" : in_order ? "-" : k + 1 < n ? ", " : " and ";
    return dalcs_arena_printf(view->work, "%s%s%s", list, between, name);
}

/* A diode that breaks down has two branches, one after the other. */
static bool is_first(const struct dalcs_view *view, const int *part, int k) {
    return k == 0 || name_of(view, part, k - 1) != name_of(view, part, k);
}

static int count_names(const struct dalcs_view *view, int n, const int *part) {
    int n_names = 0;
    for (int k = 0; k < n; k++) {
        n_names += is_first(view, part, k) ? 1 : 0;
    }
    return n_names;
}

static const char *list_names(const struct dalcs_view *view, int n, const int *part) {
    const char *list = "";
    int n_names = count_names(view, n, part);
    for (int k = 0, named = 0; k < n; k++) {
        if (is_first(view, part, k)) {
            list = join(view, list, named++, n_names, name_of(view, part, k), false);
        }
    }
    return list;
}

static int vertex(const struct dalcs_view *view, int freedom, int end) {
    return view->u->vertex_of[view->freedom[freedom].node[end]];
}

bool dalcs_view_are_parallel(const struct dalcs_view *view, int n, const int *part) {
    bool parallel = true;
    for (int k = 1; k < n; k++) {
        int a = vertex(view, part[k], 0);
        int b = vertex(view, part[k], 1);
        int first = vertex(view, part[0], 0);
        int second = vertex(view, part[0], 1);
        parallel = parallel && ((a == first && b == second) || (a == second && b == first));
    }
    return parallel;
}

/* The names along a loop; "" when the branches are more than one loop. */
static const char *follow_loop(const struct dalcs_view *view, int n, const int *part) {
    bool simple = true;
    for (int k = 0; k < 2 * n; k++) {
        int v = vertex(view, part[k / 2], k % 2);
        view->link[v] ^= part[k / 2];
        simple = ++view->degree[v] <= 2 && simple;
    }
    const char *list = "";
    int at = part[0];
    int v = vertex(view, at, 1);
    for (int k = 0; simple && k < n; k++) {
        list = join(view, list, k, n, view->freedom[at].name, true);
        at ^= view->link[v]; /* the other of the two at this vertex */
        v = vertex(view, at, vertex(view, at, 0) == v ? 1 : 0);
    }
    for (int k = 0; k < 2 * n; k++) {
        v = vertex(view, part[k / 2], k % 2);
        view->link[v] = view->degree[v] = 0;
    }
    return list;
}

const char *dalcs_words_for_loop(const struct dalcs_view *view, int n, const int *part) {
    bool has_coils = false;
    for (int k = 0; k < n; k++) {
        has_coils = has_coils || view->freedom[part[k]].is_coil;
    }
    if (has_coils) {
        return dalcs_arena_printf(view->work, "loops of %s, with perfectly coupled coils",
                                  list_names(view, n, part));
    }
    const char *first = name_of(view, part, 0);
    if (n == 1) {
        return dalcs_arena_printf(view->work, "both ends of %s on one node", first);
    }
    if (dalcs_view_are_parallel(view, n, part)) {
        if (n > 2) {
            const char *list = list_names(view, n, part);
            return list == NULL ? NULL : dalcs_arena_printf(view->work, "%s in parallel", list);
        }
        bool opposed = view->freedom[part[0]].is_diode && view->freedom[part[1]].is_diode &&
                       vertex(view, part[0], 0) == vertex(view, part[1], 1);
        return dalcs_arena_printf(view->work, "%s %sparallel to %s", first, opposed ? "anti" : "",
                                  name_of(view, part, 1));
    }
    const char *loop = follow_loop(view, n, part);
    if (loop != NULL && loop[0] != '\0') {
        return dalcs_arena_printf(view->work, "loop %s", loop);
    }
    const char *list = loop == NULL ? NULL : list_names(view, n, part);
    return list == NULL ? NULL : dalcs_arena_printf(view->work, "loops of %s", list);
}

/* The names of a stack of diodes from anode to cathode; "" when it is none. */
static const char *follow_stack(const struct dalcs_view *view, const int *island_of, int n,
                                const int *border) {
    int *next = view->link; /* of an island, the diode away from it + 1; 0: none */
    bool stacked = n > 1;
    for (int k = 0; k < n; k++) {
        int from = island_of[vertex(view, border[k], 0)];
        stacked = stacked && view->freedom[border[k]].is_diode && next[from] == 0;
        next[from] = border[k] + 1;
    }
    const char *list = "";
    int island = 0;
    for (int k = 0; k < n && stacked; k++) {
        stacked = next[island] > 0 && (k == 0 || island != 0);
        if (stacked) {
            int at = next[island] - 1;
            list = join(view, list, k, n, view->freedom[at].name, true);
            island = island_of[vertex(view, at, 1)];
        }
    }
    for (int k = 0; k < n; k++) {
        next[island_of[vertex(view, border[k], 0)]] = 0;
    }
    return list == NULL || (stacked && island == 0) ? list : "";
}

static const char *list_nodes(const struct dalcs_view *view, int n, const int *node) {
    const char *list = "";
    for (int k = 0; k < n; k++) {
        list = join(view, list, k, n, view->u->circuit->node_name[node[k]], false);
    }
    return list;
}

static const char *words_for_border(const struct dalcs_view *view, int n, const int *border) {
    const char *elements = list_names(view, n, border);
    return elements == NULL ? NULL
                            : dalcs_arena_printf(view->work, "%s block%s", elements,
                                                 count_names(view, n, border) == 1 ? "s" : "");
}

const char *dalcs_words_for_island(const struct dalcs_view *view, const int *island_of, int n_nodes,
                                   const int *node, int n, const int *border, const char **brief) {
    const char *stack = follow_stack(view, island_of, n, border);
    if (stack != NULL && stack[0] != '\0') {
        return dalcs_arena_printf(view->work, "stack %s blocks", stack);
    }
    const char *nodes = list_nodes(view, n_nodes, node);
    const char *blocking = words_for_border(view, n, border);
    *brief = n > 0 ? blocking : NULL;
    if (stack == NULL || nodes == NULL || blocking == NULL) {
        return NULL;
    }
    return n == 0 ? dalcs_arena_printf(view->work, "nothing sets the voltage of %s", nodes)
                  : dalcs_arena_printf(view->work, "nothing conducts between %s and the rest: %s",
                                       nodes, blocking);
}
