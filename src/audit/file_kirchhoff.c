/* file_kirchhoff.c - Kirchhoff's current law with some of the currents.
 *
 * Where one current at a node is not known, the law gives it. Nodes that such currents join are one set, into
 * which as much flows as out of it. A set with ground says nothing. */
#include "file_internal.h"

#include "union_find.h"

static int root(const struct file_audit *a, int device, int end) {
    return a->nodes.of[a->circuit->device[device].node[end]];
}

static void count_unknown(struct file_audit *a, const struct file_row *row) {
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        a->sets.count[n] = 0;
        for (int k = a->nodes.first_branch[n]; k < a->nodes.first_branch[n + 1]; k++) {
            a->sets.count[n] += row->i[a->nodes.branch[k]].known ? 0 : 1;
        }
    }
}

/* The one at this node that is not known, and minus what leaves by the others. */
static int take_rest(const struct file_audit *a, const struct file_row *row, int node,
                     struct file_number *rest) {
    int found = -1;
    *rest = file_exactly(0.0);
    for (int k = a->nodes.first_branch[node]; k < a->nodes.first_branch[node + 1]; k++) {
        const int d = a->nodes.branch[k];
        if (row->i[d].known) {
            *rest = file_add(*rest, root(a, d, 0) == node ? -1.0 : 1.0, row->i[d]);
        } else {
            found = d;
        }
    }
    return found;
}

void file_peel(struct file_audit *a, struct file_row *row) {
    int n_stack = 0;
    count_unknown(a, row);
    for (int n = a->circuit->n_nodes - 1; n > 0; n--) {
        if (a->sets.count[n] == 1) {
            a->sets.stack[n_stack++] = n;
        }
    }
    while (n_stack > 0) {
        const int node = a->sets.stack[--n_stack];
        if (a->sets.count[node] != 1) {
            continue;
        }
        struct file_number rest;
        const int d = take_rest(a, row, node, &rest);
        const bool is_first = root(a, d, 0) == node;
        row->i[d] = file_add(file_exactly(0.0), is_first ? 1.0 : -1.0, rest);
        row->is_spent[node] = true;
        a->sets.count[node] = 0;
        const int other = root(a, d, is_first ? 1 : 0);
        if (--a->sets.count[other] == 1 && other > 0) {
            a->sets.stack[n_stack++] = other;
        }
    }
}

void file_cluster(struct file_audit *a, const struct file_number *flow) {
    dalcs_union_reset(a->sets.cluster, a->circuit->n_nodes);
    for (int d = 0; d < a->circuit->n_devices; d++) {
        if (!flow[d].known && !dalcs_device_is_short(&a->circuit->device[d])) {
            dalcs_union_join(a->sets.cluster, root(a, d, 0), root(a, d, 1));
        }
    }
}

void file_sum_sets(struct file_audit *a, const struct file_number *flow) {
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        a->sets.sum[n] = (struct file_number){0};
        a->sets.largest[n] = 0.0;
    }
    for (int d = 0; d < a->circuit->n_devices; d++) {
        const int from = dalcs_union_find(a->sets.cluster, root(a, d, 0));
        const int to = dalcs_union_find(a->sets.cluster, root(a, d, 1));
        if (from == to || !flow[d].known) {
            continue;
        }
        for (int e = 0; e < 2; e++) {
            const int n = e == 0 ? from : to;
            a->sets.sum[n].value += (e == 0 ? 1.0 : -1.0) * flow[d].value;
            a->sets.sum[n].error += flow[d].error;
            a->sets.sum[n].known = true;
            a->sets.largest[n] = fmax(a->sets.largest[n], file_amperes(a, d));
        }
    }
}

void file_describe_sets(struct file_audit *a, const struct file_row *row) {
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        a->sets.count[n] = 0;
        a->sets.stack[n] = -1;
        a->sets.has_unspent[n] = false;
    }
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        if (a->nodes.of[n] == n) {
            const int set = dalcs_union_find(a->sets.cluster, n);
            a->sets.count[set]++;
            a->sets.has_unspent[set] = a->sets.has_unspent[set] || row == NULL || !row->is_spent[n];
            a->sets.stack[set] = n != set && a->sets.stack[set] < 0 ? n : a->sets.stack[set];
        }
    }
}

void file_note_covered(struct file_audit *a) {
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        const int set = dalcs_union_find(a->sets.cluster, a->nodes.of[n]);
        a->coverage.is_covered[n] = a->coverage.is_covered[n] || a->coverage.is_checked[set];
    }
}

/* Does as much flow into a set as out of it? */
static void ask_set(struct file_audit *a, const struct file_row *row, int set) {
    file_find_set(a, set, "A", fabs(a->sets.sum[set].value),
                  a->sets.sum[set].error + a->sets.largest[set], row->t, row->t);
}

void file_check_nodes(struct file_audit *a, const struct file_row *row) {
    if (a->is_at_rest) {
        file_check_islands(a, row);
    }
    file_cluster(a, row->i);
    file_sum_sets(a, row->i);
    file_describe_sets(a, row);
    for (int n = 0; n < a->circuit->n_nodes; n++) {
        a->coverage.is_covered[n] = a->coverage.is_covered[n] || row->is_spent[a->nodes.of[n]];
        a->coverage.is_checked[n] =
            n > 0 && a->sets.count[n] > 0 && a->sets.sum[n].known && a->sets.has_unspent[n];
        if (a->coverage.is_checked[n]) {
            ask_set(a, row, n);
        }
    }
    file_note_covered(a);
}

void file_find_set(struct file_audit *a, int set, const char *unit, double defect, double allowed,
                   double from, double to) {
    if (file_find(a, DALCS_AUDIT_KCL, set, unit, defect, allowed, from, to)) {
        a->worst[DALCS_AUDIT_KCL][set].n_nodes = a->sets.count[set];
        a->worst[DALCS_AUDIT_KCL][set].other = a->sets.stack[set];
    }
}
