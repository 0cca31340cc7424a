/* file_names.c - which column is what of the circuit.
 *
 * v(out), V(x1:n), v(a,b), out; i(d1), I(x1:D1), @d1[id], @i1[current], i(@r1[i]), v1#branch, @d.x1.d1[id]: what dalcs,
 * ngspice, LTspice and Xyce call them, in any case. */
#include "file_internal.h"

#include "lower_case.h"
#include "names.h"

#include <string.h>

enum { NAME_SIZE = 256 };

struct finder {
    struct file_audit *a;
    struct dalcs_names node, device;
    char name[NAME_SIZE]; /* of the column at hand: lower case, dots for colons, no blanks */
};

static enum dalcs_status list_names(struct finder *f) {
    const struct dalcs_circuit *c = f->a->circuit;
    for (int n = 0; n < c->n_nodes; n++) {
        int found;
        DALCS_TRY(dalcs_names_find_or_add(&f->node, c->node_name[n], n, &found));
    }
    for (int d = 0; d < c->n_devices; d++) {
        int found;
        DALCS_TRY(dalcs_names_find_or_add(&f->device, c->device[d].name, d, &found));
    }
    return DALCS_OK;
}

static bool take_name(struct finder *f, const char *name) {
    size_t n = 0;
    for (; *name != '\0'; name++) {
        if (n + 1 >= sizeof f->name) {
            return false;
        }
        if (*name != ' ' && *name != '"') {
            f->name[n++] = *name == ':' ? '.' : dalcs_lower(*name);
        }
    }
    f->name[n] = '\0';
    return n > 0;
}

static int find_node(const struct finder *f, const char *name) {
    return strcmp(name, "gnd") == 0 && dalcs_names_find(&f->node, name) < 0
               ? 0
               : dalcs_names_find(&f->node, name);
}

/* The current of an element that has parts beside it, as Rpar of a coil, is that of its terminal. */
static int find_named(const struct finder *f, const char *name) {
    char terminal[NAME_SIZE + sizeof "terminal()"];
    snprintf(terminal, sizeof terminal, "terminal(%s)", name);
    const int found = dalcs_names_find(&f->device, terminal);
    return found >= 0 ? found : dalcs_names_find(&f->device, name);
}

/* x1.d1 is d.x1.d1 in ngspice, and d:x1:1 or x1:d1 in LTspice. */
static int find_device(const struct finder *f, const char *name) {
    int found = find_named(f, name);
    const char *last = strrchr(name, '.');
    if (found >= 0 || last == NULL || name[1] != '.') {
        return found;
    }
    found = find_named(f, name + 2);
    if (found < 0) {
        char other[NAME_SIZE + 1];
        snprintf(other, sizeof other, "%.*s.%c%s", (int)(last - name - 2 > 0 ? last - name - 2 : 0),
                 name + 2, name[0], last + 1);
        found = find_named(f, other);
    }
    return found;
}

/* The device whose current a column is; -1: it is none. */
static int device_of(struct finder *f) {
    char *name = f->name;
    size_t length = strlen(name);
    char *branch = strstr(name, "#branch");
    if (branch != NULL) {
        *branch = '\0';
        return find_device(f, name);
    }
    if (length > 3 && strncmp(name, "i(", 2) == 0 && name[length - 1] == ')') {
        name[length - 1] = '\0';
        name += 2;
    }
    const size_t inner = dalcs_names_current_of(name);
    if (inner > 0) {
        name[1 + inner] = '\0';
        return find_device(f, name + 1);
    }
    return name == f->name ? -1 : find_device(f, name);
}

/* ---- Potentials --------------------------------------------------------------------------------- */

static void set_potential(struct file_audit *a, int node, int base, double sign, size_t column) {
    a->columns.potential_of[node] = a->columns.n_potentials;
    a->columns.potential[a->columns.n_potentials++] =
        (struct file_potential){node, base, sign, column};
}

static bool is_found(const struct file_audit *a, int node) {
    return node == 0 || a->columns.potential_of[node] >= 0;
}

/* v(a) and v(a,b): the nodes; one that there is not: false. */
static bool nodes_of(struct finder *f, int node[2]) {
    char *name = f->name;
    const size_t length = strlen(name);
    node[1] = 0;
    if (length > 3 && strncmp(name, "v(", 2) == 0 && name[length - 1] == ')') {
        name[length - 1] = '\0';
        name += 2;
        char *comma = strchr(name, ',');
        if (comma != NULL) {
            *comma = '\0';
            node[1] = find_node(f, comma + 1);
        }
    }
    node[0] = find_node(f, name);
    return node[0] >= 0 && node[1] >= 0 && node[0] != node[1];
}

/* A difference gives the other potential where one is known; true: it did. */
static bool take_difference(struct file_audit *a, const int node[2], size_t column) {
    if (is_found(a, node[0]) == is_found(a, node[1])) {
        return false;
    }
    const int known = is_found(a, node[0]) ? 0 : 1;
    set_potential(a, node[1 - known], node[known], known == 1 ? 1.0 : -1.0, column);
    return true;
}

static bool are_equal(const struct dalcs_wave_table *t, size_t a, size_t b) {
    bool equal = true;
    for (size_t k = 0; k < t->n_rows && equal; k++) {
        equal = t->value[k * t->n_columns + a] == t->value[k * t->n_columns + b];
    }
    return equal;
}

/* Another column of the same node, with other numbers. */
static void note_twin(const struct file_audit *a, int node, size_t column,
                      struct dalcs_diag *diag) {
    const struct file_potential *p = a->columns.potential_of[node] >= 0
                                         ? &a->columns.potential[a->columns.potential_of[node]]
                                         : NULL;
    if (p != NULL && p->base == 0 && p->column != column && p->column > 0 &&
        !are_equal(a->table, p->column, column)) {
        dalcs_diag_add(diag, DALCS_WARNING, NULL, NULL,
                       "columns '%s' and '%s' are both the voltage of node '%s', and differ: the "
                       "first one is taken",
                       a->table->name[p->column], a->table->name[column],
                       a->circuit->node_name[node]);
    }
}

/* Potentials of ground's neighbours first, then what differences make of them, again and again. */
static void find_potentials(struct finder *f, struct dalcs_diag *diag) {
    struct file_audit *a = f->a;
    for (bool more = true, direct = true; more; direct = false) {
        more = false;
        for (size_t c = 1; c < a->table->n_columns; c++) {
            int node[2];
            if (!take_name(f, a->table->name[c]) || !nodes_of(f, node)) {
                continue;
            }
            a->columns.is_used[c] = true;
            if (direct && node[1] == 0) {
                note_twin(a, node[0], c, diag);
            }
            if (!direct || node[0] == 0 || node[1] == 0) {
                more = take_difference(a, node, c) || more;
            }
        }
        more = more || direct;
    }
}

/* Nodes that shorts join have one potential. */
static void share_potentials(struct file_audit *a) {
    for (int n = 1; n < a->circuit->n_nodes; n++) {
        const int root = a->nodes.of[n];
        if (is_found(a, n) && !is_found(a, root)) {
            set_potential(a, root, n, 0.0, 0);
        }
    }
    for (int n = 1; n < a->circuit->n_nodes; n++) {
        if (!is_found(a, n) && is_found(a, a->nodes.of[n])) {
            set_potential(a, n, a->nodes.of[n], 0.0, 0);
        }
    }
}

/* ngspice writes the current of a coil or a source twice with savecurrents: i(l1) and i(@l1[i]). */
static void find_currents(struct finder *f, struct dalcs_diag *diag) {
    struct file_audit *a = f->a;
    for (size_t c = 1; c < a->table->n_columns; c++) {
        const int device = take_name(f, a->table->name[c]) ? device_of(f) : -1;
        if (device < 0) {
            continue;
        }
        a->columns.is_used[c] = true;
        if (a->columns.current[device] < 0) {
            a->columns.current[device] = (long)c;
        } else if (!are_equal(a->table, (size_t)a->columns.current[device], c)) {
            dalcs_diag_add(diag, DALCS_WARNING, NULL, NULL,
                           "columns '%s' and '%s' are both the current of '%s', and differ: the "
                           "first one is taken",
                           a->table->name[a->columns.current[device]], a->table->name[c],
                           a->circuit->device[device].name);
        }
    }
}

/* ---- A file of another circuit ------------------------------------------------------------------ */

enum { MOST_NAMED = 6 };

static enum dalcs_status refuse(const struct finder *f, struct dalcs_diag *diag) {
    struct file_audit *a = f->a;
    struct dalcs_names column = {0}, node = {0};
    int found;
    enum dalcs_status status = DALCS_OK;
    for (size_t c = 1; c < a->table->n_columns && c <= MOST_NAMED && status == DALCS_OK; c++) {
        status = dalcs_names_find_or_add(&column, a->table->name[c], 0, &found);
    }
    int n_nodes = 0;
    for (int n = 1; n < a->circuit->n_nodes && status == DALCS_OK; n++) {
        const bool is_inner = dalcs_names_is_inner(a->circuit->node_name[n]);
        n_nodes += is_inner ? 0 : 1;
        if (!is_inner && n_nodes <= MOST_NAMED) {
            status = dalcs_names_find_or_add(&node, a->circuit->node_name[n], 0, &found);
        }
    }
    if (status == DALCS_OK) {
        const char *has = dalcs_names_join(&column, MOST_NAMED, &a->arena);
        const char *wants = dalcs_names_join(&node, MOST_NAMED, &a->arena);
        dalcs_diag_add(
            diag, DALCS_ERROR, NULL, NULL,
            "the file has no signal of this circuit: it has %s%s; the netlist's nodes are "
            "%s%s",
            has != NULL ? has : "none", a->table->n_columns > MOST_NAMED + 1 ? ", ..." : "",
            wants != NULL ? wants : "none", n_nodes > MOST_NAMED ? ", ..." : "");
        status = DALCS_E_OPTION;
    }
    dalcs_names_finish(&column);
    dalcs_names_finish(&node);
    return status;
}

enum dalcs_status file_find_columns(struct file_audit *a, struct dalcs_diag *diag) {
    struct finder f = {.a = a};
    enum dalcs_status status = list_names(&f);
    if (status == DALCS_OK) {
        find_potentials(&f, diag);
        share_potentials(a);
        find_currents(&f, diag);
        bool any = false;
        for (size_t c = 1; c < a->table->n_columns; c++) {
            any = any || a->columns.is_used[c];
        }
        status = any ? DALCS_OK : refuse(&f, diag);
    }
    dalcs_names_finish(&f.node);
    dalcs_names_finish(&f.device);
    return status;
}
