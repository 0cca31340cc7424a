/* file_report.c - what was found, the worst first, and what could not be asked. */
#include "file_internal.h"

#include <stdlib.h>
#include <string.h>

static const char *const law_name[FILE_LAWS] = {
    [DALCS_AUDIT_KCL] = "KCL",         [DALCS_AUDIT_BRANCH] = "BRANCH",
    [DALCS_AUDIT_CURRENT] = "CURRENT", [DALCS_AUDIT_POSITION] = "POSITION",
    [DALCS_AUDIT_ENERGY] = "ENERGY",
};

static int n_of(const struct file_audit *a, int law) {
    return law == DALCS_AUDIT_KCL ? a->circuit->n_nodes : a->circuit->n_devices;
}

/* "out", "a, b", "a, b and 3 more" */
static const char *name_of(const struct file_audit *a, int law, int index,
                           struct dalcs_arena *arena) {
    if (law != DALCS_AUDIT_KCL) {
        return dalcs_arena_printf(arena, "%s", a->circuit->device[index].name);
    }
    const struct file_worst *w = &a->worst[law][index];
    const char *first = a->circuit->node_name[index];
    if (w->n_nodes < 2) {
        return dalcs_arena_printf(arena, "%s", first);
    }
    const char *other = a->circuit->node_name[w->other];
    return w->n_nodes == 2
               ? dalcs_arena_printf(arena, "%s, %s", first, other)
               : dalcs_arena_printf(arena, "%s, %s and %d more", first, other, w->n_nodes - 2);
}

static int by_ratio(const void *one, const void *other) {
    const struct dalcs_table_law *a = one, *b = other;
    const double left = a->defect * fmax(b->allowed, 0x1p-1022);
    const double right = b->defect * fmax(a->allowed, 0x1p-1022);
    if (left != right) {
        return left < right ? 1 : -1;
    }
    const int order = strcmp(a->law, b->law);
    return order != 0 ? order : strcmp(a->where, b->where);
}

static enum dalcs_status list_laws(struct file_audit *a, struct dalcs_arena *arena,
                                   struct dalcs_table_audit *result) {
    size_t n = 0;
    for (int law = 0; law < FILE_LAWS; law++) {
        n += (size_t)n_of(a, law);
    }
    struct dalcs_table_law *list = dalcs_arena_alloc(arena, n, sizeof *list);
    if (list == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int law = 0; law < FILE_LAWS; law++) {
        for (int i = 0; i < n_of(a, law); i++) {
            const struct file_worst *w = &a->worst[law][i];
            if (w->n_checked == 0) {
                continue;
            }
            struct dalcs_table_law *to = &list[result->n_laws];
            *to = (struct dalcs_table_law){.law = law_name[law],
                                           .where = name_of(a, law, i, arena),
                                           .unit = w->unit,
                                           .defect = w->defect,
                                           .allowed = w->allowed,
                                           .from = w->from,
                                           .to = w->to,
                                           .since = w->since,
                                           .sees = w->sees,
                                           .n_checked = w->n_checked,
                                           .n_broken = w->n_broken};
            if (to->where == NULL) {
                return DALCS_E_NOMEM;
            }
            result->n_laws++;
            result->n_broken += w->n_broken > 0 ? 1 : 0;
        }
    }
    qsort(list, result->n_laws, sizeof *list, by_ratio);
    result->law = list;
    return DALCS_OK;
}

/* ---- What could not be asked -------------------------------------------------------------------- */

/* Signals that are missing, in words. */
struct missing {
    struct dalcs_arena *arena;
    const char *text;
    int n;
    bool failed;
};

static void miss(struct missing *m, char kind, const char *name) {
    m->text = m->n == 0 ? dalcs_arena_printf(m->arena, "%c(%s)", kind, name)
                        : dalcs_arena_printf(m->arena, "%s, %c(%s)", m->text, kind, name);
    m->failed = m->failed || m->text == NULL;
    m->n++;
}

static void miss_potential(const struct file_audit *a, struct missing *m, int node) {
    if (node > 0 && a->columns.potential_of[node] < 0 && !a->coverage.ever_given[node]) {
        miss(m, 'v', a->circuit->node_name[node]);
    }
}

static void miss_current(const struct file_audit *a, struct missing *m, int device) {
    if (!a->coverage.ever_seen[device]) {
        miss(m, 'i', a->circuit->device[device].name);
    }
}

static bool is_asked(const struct file_audit *a, enum dalcs_audit_law law, int index) {
    return a->worst[law][index].n_checked > 0;
}

/* An output that the file lacks, and that its own law gave to others: it is missing all the same, unless the program made the
 * node, which has the element's name. */
static void miss_output(const struct file_audit *a, struct missing *m, int device) {
    const int node = a->circuit->device[device].node[0];
    const char *name = a->circuit->node_name[node];
    const bool is_own =
        strchr(name, '(') != NULL && strcmp(name, a->circuit->device[device].name) == 0;
    if (a->coverage.ever_given[node] && !is_own) {
        miss(m, 'v', name);
    }
}

/* The law of an element that nothing was asked of. */
static const char *gap_of_device(const struct file_audit *a, int d, struct missing *m) {
    const struct dalcs_device *device = &a->circuit->device[d];
    const bool is_pair = device->kind == DALCS_DIODE || device->kind == DALCS_SWITCH;
    const bool has_own_current = device->kind == DALCS_RESISTOR || device->kind == DALCS_ISOURCE ||
                                 device->kind == DALCS_VCCS || device->kind == DALCS_CCCS;
    const bool is_asked_of =
        is_asked(a, DALCS_AUDIT_BRANCH, d) || is_asked(a, DALCS_AUDIT_CURRENT, d);
    if ((is_asked_of && !is_pair) || (has_own_current && device->value != 0.0)) {
        return NULL;
    }
    miss_potential(a, m, device->node[0]);
    miss_potential(a, m, device->node[1]);
    if (file_is_given(a, d)) {
        miss_output(a, m, d);
    }
    if (device->kind == DALCS_CAPACITOR) {
        return m->n > 0 ? "BRANCH" : NULL; /* else its charge is in Kirchhoff's law */
    }
    if (is_pair || device->kind == DALCS_INDUCTOR) {
        miss_current(a, m, d);
    }
    for (int e = 2; e < 4 && (device->kind == DALCS_SWITCH || device->kind == DALCS_VCVS); e++) {
        miss_potential(a, m, device->control < 0 ? device->node[e] : 0);
    }
    if (device->control >= 0) {
        miss_current(a, m, device->control);
    }
    return m->n == 0 ? NULL : is_asked_of ? "CURRENT" : "BRANCH";
}

static const char *gap_of_node(const struct file_audit *a, int n, struct missing *m) {
    if (a->coverage.is_covered[n] || a->nodes.of[n] != n ||
        a->nodes.first_branch[n + 1] == a->nodes.first_branch[n]) {
        return NULL;
    }
    for (int k = a->nodes.first_branch[n]; k < a->nodes.first_branch[n + 1]; k++) {
        const int d = a->nodes.branch[k];
        const enum dalcs_device_kind kind = a->circuit->device[d].kind;
        if (!a->coverage.ever_known[d] && kind != DALCS_CAPACITOR) {
            miss(m, 'i', a->circuit->device[d].name);
        } else if (kind == DALCS_CAPACITOR && !a->coverage.ever_known[d]) {
            miss_potential(a, m, a->circuit->device[d].node[0]);
            miss_potential(a, m, a->circuit->device[d].node[1]);
        }
    }
    return "KCL";
}

static enum dalcs_status list_gaps(struct file_audit *a, struct dalcs_arena *arena,
                                   struct dalcs_table_audit *result) {
    const int n = a->circuit->n_devices + a->circuit->n_nodes;
    struct dalcs_table_gap *list = dalcs_arena_alloc(arena, (size_t)n, sizeof *list);
    for (int k = 1; k < n && list != NULL; k++) {
        struct missing m = {.arena = arena};
        const bool is_node = k < a->circuit->n_nodes;
        const int index = is_node ? k : k - a->circuit->n_nodes;
        const char *law = is_node ? gap_of_node(a, index, &m) : gap_of_device(a, index, &m);
        if (law == NULL) {
            continue;
        }
        const char *where = is_node ? a->circuit->node_name[index] : a->circuit->device[index].name;
        struct dalcs_table_gap *gap = &list[result->n_gaps++];
        *gap = (struct dalcs_table_gap){
            law, dalcs_arena_printf(arena, "%s", where),
            m.n > 0 ? dalcs_arena_printf(arena, "%s %s not in the file", m.text,
                                         m.n == 1 ? "is" : "are")
                    : "the file has currents only for sets of nodes with ground in them"};
        if (m.failed || gap->where == NULL || gap->because == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    result->gap = list;
    return list != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

static enum dalcs_status list_foreign(const struct file_audit *a, struct dalcs_arena *arena,
                                      struct dalcs_table_audit *result) {
    const char **list = dalcs_arena_alloc(arena, a->table->n_columns, sizeof *list);
    for (size_t c = 1; c < a->table->n_columns && list != NULL; c++) {
        if (a->columns.is_used[c]) {
            result->n_used++;
        } else if ((list[result->n_foreign++] =
                        dalcs_arena_printf(arena, "%s", a->table->name[c])) == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    result->foreign = list;
    return list != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

enum dalcs_status file_report(struct file_audit *a, struct dalcs_arena *arena,
                              struct dalcs_table_audit *result) {
    const struct dalcs_wave_table *t = a->table;
    *result = (struct dalcs_table_audit){
        .tolerance = a->promise.tolerance,
        .from = t->n_rows > 0 ? t->value[0] : 0.0,
        .to = t->n_rows > 0 ? t->value[(t->n_rows - 1) * t->n_columns] : 0.0,
        .n_rows = t->n_rows};
    DALCS_TRY(list_laws(a, arena, result));
    DALCS_TRY(list_gaps(a, arena, result));
    return list_foreign(a, arena, result);
}
