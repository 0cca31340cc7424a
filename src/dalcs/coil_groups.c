/* coil_groups.c - coils that couplings join, group by group. */
#include "coil_groups.h"

#include "layout.h"
#include "union_find.h"

#include <math.h>
#include <stdlib.h>

/* Coils coupled among each other, at most: their inductance matrix is dense. */
enum { MOST_COUPLED_COILS = 5000 };

/* The matrix of a group, its diagonal filled, and the place of each coil in it. */
static enum dalcs_status start_group(const struct dalcs_circuit *c, struct coil_group *g,
                                     int *position /* [n_devices] */, struct dalcs_diag *diag) {
    const struct dalcs_device *first = &c->device[g->device[0]];
    if (g->n > MOST_COUPLED_COILS) {
        dalcs_diag_add(diag, DALCS_ERROR, &first->where, NULL,
                       "%d coils are coupled with '%s', more than %d", g->n - 1, first->name,
                       MOST_COUPLED_COILS - 1);
        return DALCS_E_LIMIT;
    }
    g->L = dalcs_alloc((size_t)g->n * (size_t)g->n, sizeof(*g->L));
    if (g->L == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < g->n; i++) {
        position[g->device[i]] = i;
        g->L[i * g->n + i] = c->device[g->device[i]].value;
    }
    return DALCS_OK;
}

static void add_mutual_inductances(struct dalcs_layout *l, const int *position) {
    const struct dalcs_circuit *c = l->circuit;
    for (int k = 0; k < c->n_couplings; k++) {
        const struct dalcs_coupling *m = &c->coupling[k];
        const struct coil_group *g = &l->group[l->group_of[m->inductor[0]]];
        int i = position[m->inductor[0]];
        int j = position[m->inductor[1]];
        double mutual = m->k * sqrt(g->L[i * g->n + i] * g->L[j * g->n + j]);
        g->L[i * g->n + j] = mutual;
        g->L[j * g->n + i] = mutual;
    }
}

static int place_in(const struct coil_group *g, int device) {
    int k = 0;
    while (k < g->n && g->device[k] != device) {
        k++;
    }
    return k;
}

/* A factor of 0 on a K card counts as given; nothing reads the matrix after this. */
static void mark_zeros(const struct dalcs_circuit *c, const struct coil_group *g) {
    for (int k = 0; k < c->n_couplings; k++) {
        const struct dalcs_coupling *m = &c->coupling[k];
        const int i = m->k == 0.0 ? place_in(g, m->inductor[0]) : g->n;
        if (i < g->n) {
            const int j = place_in(g, m->inductor[1]);
            g->L[i * g->n + j] = g->L[j * g->n + i] = -0x1p-1000;
        }
    }
}

/* Two coils of a group that no K card couples; false: there are none. */
static bool find_uncoupled(const struct coil_group *g, int *first, int *second, int *n_pairs) {
    *n_pairs = 0;
    for (int i = 0; i < g->n; i++) {
        for (int j = i + 1; j < g->n; j++) {
            if (g->L[i * g->n + j] == 0.0 && (*n_pairs)++ == 0) {
                *first = i;
                *second = j;
            }
        }
    }
    return *n_pairs > 0;
}

static double factor_of(const struct coil_group *g, int i, int j) {
    return g->L[i * g->n + j] / sqrt(g->L[i * g->n + i] * g->L[j * g->n + j]);
}

/* The missing K cards, as a message: a chain of them leaves the factors in between at 0. NULL: none is missing. */
static const char *name_uncoupled(const struct dalcs_circuit *c, const struct coil_group *g,
                                  struct dalcs_arena *arena) {
    int i = 0;
    int j = 0;
    int n_pairs;
    mark_zeros(c, g);
    if (!find_uncoupled(g, &i, &j, &n_pairs)) {
        return g->n > 2 ? "with three coils and k12 = k13 = 1, k23 must be 1" : NULL;
    }
    const char *a = c->device[g->device[i]].name;
    const char *b = c->device[g->device[j]].name;
    if (n_pairs > 1) {
        return dalcs_arena_printf(
            arena,
            "no K card couples '%s' with '%s', nor %d other pair%s: write one "
            "card with all of them, K1 %s ... %s 0.99",
            a, b, n_pairs - 1, n_pairs == 2 ? "" : "s", a, b);
    }
    if (g->n != 3) {
        return dalcs_arena_printf(arena, "no K card couples '%s' with '%s': add one, K9 %s %s k", a,
                                  b, a, b);
    }
    const double ki = factor_of(g, i, 3 - i - j);
    const double kj = factor_of(g, j, 3 - i - j);
    const double width = sqrt((1.0 - ki * ki) * (1.0 - kj * kj));
    const double low = ki * kj - width;
    const double high = ki * kj + width;
    return width < 1e-9
               ? dalcs_arena_printf(arena,
                                    "no K card couples '%s' with '%s': add K9 %s %s %.9g, the only "
                                    "possible factor",
                                    a, b, a, b, ki * kj)
               : dalcs_arena_printf(arena,
                                    "no K card couples '%s' with '%s': add K9 %s %s k, k from %.4g "
                                    "to %.4g",
                                    a, b, a, b, low, high);
}

static enum dalcs_status split_group(const struct dalcs_circuit *c, struct coil_group *g,
                                     struct dalcs_diag *diag) {
    bool valid;
    DALCS_TRY(dalcs_inductance_split(&g->split, g->n, g->L, &valid));
    if (!valid) {
        const struct dalcs_device *first = &c->device[g->device[0]];
        struct dalcs_arena arena = {0};
        dalcs_diag_add(diag, DALCS_ERROR, &first->where, name_uncoupled(c, g, &arena),
                       "the %d coils coupled with '%s' cannot exist: their inductance matrix has a "
                       "negative eigenvalue, and they could supply more energy than they took",
                       g->n - 1, first->name);
        dalcs_arena_finish(&arena);
        return DALCS_E_NETLIST;
    }
    return DALCS_OK;
}

/* Gives every coil that is coupled the number of its group. */
static void number_groups(struct dalcs_layout *l, int *parent /* work [n_devices] */) {
    const struct dalcs_circuit *c = l->circuit;
    dalcs_union_reset(parent, c->n_devices);
    for (int k = 0; k < c->n_couplings; k++) {
        dalcs_union_join(parent, c->coupling[k].inductor[0], c->coupling[k].inductor[1]);
    }
    for (int i = 0; i < c->n_devices; i++) {
        int first = dalcs_union_find(parent, i);
        if (first == i) {
            continue;
        }
        if (l->group_of[first] < 0) {
            l->group_of[first] = l->n_groups++;
        }
        l->group_of[i] = l->group_of[first];
    }
}

enum dalcs_status dalcs_coil_groups_find(struct dalcs_layout *l, struct dalcs_diag *diag) {
    const struct dalcs_circuit *c = l->circuit;
    if (c->n_couplings == 0) {
        return DALCS_OK;
    }
    enum dalcs_status status = DALCS_E_NOMEM;
    int *start = NULL;
    /* Of a union-find first, then the place of each coil in its group. */
    int *work = dalcs_alloc((size_t)c->n_devices, sizeof(*work));
    l->group = dalcs_alloc((size_t)c->n_couplings, sizeof(*l->group));
    if (work == NULL || l->group == NULL) {
        goto done;
    }
    number_groups(l, work);
    status = dalcs_list_members(c->n_devices, l->group_of, l->n_groups, &start, &l->grouped_coil);
    for (int g = 0; g < l->n_groups && status == DALCS_OK; g++) {
        struct coil_group *group = &l->group[g];
        group->n = start[g + 1] - start[g];
        group->device = l->grouped_coil + start[g];
        status = start_group(c, group, work, diag);
    }
    if (status == DALCS_OK) {
        add_mutual_inductances(l, work);
    }
    for (int g = 0; g < l->n_groups && status == DALCS_OK; g++) {
        status = split_group(c, &l->group[g], diag);
    }
done:
    free(start);
    free(work);
    return status;
}
