/* motion.c - columns, powers, names. */
#include "motion.h"

#include <math.h>

enum { MOST_COLUMNS = 60 };

enum dalcs_status dalcs_motion_columns(const struct dalcs_lcs *l, const struct dalcs_giving *g,
                                       double **y, struct dalcs_arena *arena) {
    const struct dalcs_blocks *b = l->blocks;
    int n_equations = dalcs_system_n_equations(b->system);
    *y =
        dalcs_arena_alloc(arena, 2 * (size_t)dalcs_system_n_columns(b->system) + 1, sizeof(double));
    if (*y == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int q = 0; q < 2; q++) {
        for (int j = 0; j < l->n + l->m; j++) {
            double v = j < l->n ? g->x[2 * j + q] : g->u[2 * (j - l->n) + q];
            for (int i = 0; i < b->n; i++) {
                (*y)[2 * i + q] += *dalcs_at(&l->full_x, i, j) * v;
            }
            for (int k = 0; k < b->p; k++) {
                (*y)[2 * b->z_column[k] + q] += *dalcs_at(&l->full_z, k, j) * v;
            }
            for (int i = 0; i < b->m; i++) {
                double *lambda = &(*y)[2 * (n_equations + b->pair[i]) + q];
                if (!l->is_swapped[i]) {
                    *lambda = g->u[2 * i + q];
                } else {
                    *lambda +=
                        (j < l->n ? *dalcs_at(&l->C, i, j) : *dalcs_at(&l->D, i, j - l->n)) * v;
                }
            }
        }
    }
    return DALCS_OK;
}

/* ---- Powers --------------------------------------------------------------------------------- */

struct gift {
    const char *element;
    double power; /* W, of the motion; > 0 gives */
};

static double part(const double *y, const int *column, int q) {
    return (column[0] >= 0 ? y[2 * column[0] + q] : 0.0) -
           (column[1] >= 0 ? y[2 * column[1] + q] : 0.0);
}

/* Twice the average of a term over a period of the motion. */
static double gives(const struct dalcs_power_term *t, const double *y) {
    double first[2] = {part(y, t->first, 0), part(y, t->first, 1)};
    double second[2] = {part(y, t->second, 0), part(y, t->second, 1)};
    double power = 0.0;
    if (t->factor == DALCS_POWER_SQUARE) {
        power = t->coefficient * (first[0] * first[0] + first[1] * first[1]);
    } else if (t->factor == DALCS_POWER_PRODUCT) {
        power = t->coefficient * (first[0] * second[0] + first[1] * second[1]);
    }
    return t->account == DALCS_POWER_SOURCES ? power : -power;
}

/* Elements that give, most first. */
static enum dalcs_status find_gifts(const struct dalcs_power *power, const double *y,
                                    struct gift **gift, size_t *n, struct dalcs_arena *arena) {
    double largest = 0.0;
    *n = 0;
    *gift = dalcs_arena_alloc(arena, (size_t)power->n + 1, sizeof(**gift));
    if (*gift == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int k = 0; k < power->n; k++) { /* the terms of a device lie together */
        const char *element = power->term[k].element;
        if (*n == 0 || (*gift)[*n - 1].element != element) {
            (*gift)[(*n)++] = (struct gift){element, 0.0};
        }
        (*gift)[*n - 1].power += gives(&power->term[k], y);
        largest = fmax(largest, fabs((*gift)[*n - 1].power));
    }
    size_t kept = 0;
    for (size_t k = 0; k < *n; k++) {
        struct gift g = (*gift)[k];
        if (g.power > 1e-9 * largest) {
            size_t at = kept++;
            while (at > 0 && (*gift)[at - 1].power < g.power) {
                (*gift)[at] = (*gift)[at - 1];
                at--;
            }
            (*gift)[at] = g;
        }
    }
    *n = kept;
    return DALCS_OK;
}

static enum dalcs_status add_powers(struct dalcs_findings *f, const struct dalcs_power *power,
                                    const double *y) {
    struct gift *gift;
    size_t n;
    struct dalcs_evidence w;
    DALCS_TRY(find_gifts(power, y, &gift, &n, f->work));
    const char **name = dalcs_arena_alloc(f->result, n + 1, sizeof(*name));
    DALCS_TRY(dalcs_evidence_new(&w, f, "powers", n));
    if (name == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < n; k++) {
        name[k] = gift[k].element;
        dalcs_evidence_put(&w, name[k], gift[k].power, 0.0);
    }
    f->verdict[f->n_verdicts - 1].element = name;
    f->verdict[f->n_verdicts - 1].n_elements = n;
    return n > 0 ? dalcs_findings_witness(f, true, &w) : DALCS_OK;
}

/* ---- Witnesses ------------------------------------------------------------------------------ */

const char *dalcs_mode_text(const struct dalcs_blocks *b, const bool *is_on,
                            struct dalcs_arena *arena) {
    const char **name = dalcs_arena_alloc(arena, (size_t)b->m + 1, sizeof(*name));
    size_t n = 0;
    if (name == NULL) {
        return NULL;
    }
    for (int i = 0; i < b->m; i++) {
        if (is_on[i]) {
            const struct dalcs_pair *pair = &b->system->pair[b->pair[i]];
            name[n++] = pair->element;
        }
    }
    if (b->m == 0) {
        return "its only mode";
    }
    if (n == 0) {
        return b->m == 1 ? "its diode off" : "all diodes off";
    }
    if (n == (size_t)b->m && n > 1) {
        return "all diodes on";
    }
    const char *list = dalcs_join_names(arena, n, name);
    return list == NULL ? NULL : dalcs_arena_printf(arena, "%s on", list);
}

static enum dalcs_status add_mode(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                  const double *s, const bool *is_on) {
    struct dalcs_evidence w;
    DALCS_TRY(dalcs_evidence_new(&w, f, "mode", (size_t)b->m + 1));
    dalcs_evidence_put(&w, "s", s[0], s[1]);
    for (int i = 0; i < b->m; i++) {
        if (is_on[i]) {
            dalcs_evidence_put(&w, b->system->pair[b->pair[i]].element, 1.0, 0.0);
        }
    }
    return dalcs_findings_witness(f, true, &w);
}

enum dalcs_status dalcs_motion_witness(struct dalcs_findings *f, const struct dalcs_blocks *b,
                                       const double *s, const bool *is_on, const double *y,
                                       const struct dalcs_power *power) {
    int n = dalcs_system_n_columns(b->system);
    struct dalcs_evidence w;
    double largest = 0.0;
    for (int i = 0; i < n; i++) {
        largest = fmax(largest, hypot(y[2 * i], y[2 * i + 1]));
    }
    double *scaled = dalcs_arena_alloc(f->work, 2 * (size_t)n + 1, sizeof(*scaled));
    if (scaled == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < 2 * n && largest > 0.0; i++) {
        scaled[i] = y[i] / largest;
    }
    if (is_on != NULL) {
        DALCS_TRY(add_mode(f, b, s, is_on));
    }
    DALCS_TRY(dalcs_evidence_new(&w, f, is_on != NULL ? "eigenvector" : "motion", (size_t)n + 1));
    if (is_on == NULL) {
        dalcs_evidence_put(&w, "s", s[0], s[1]);
    }
    for (int i = 0; i < n && n <= MOST_COLUMNS; i++) {
        const char *name = dalcs_column_name(b->system, i, f->result);
        if (name == NULL) {
            return DALCS_E_NOMEM;
        }
        dalcs_evidence_put(&w, name, scaled[2 * i], scaled[2 * i + 1]);
    }
    DALCS_TRY(dalcs_findings_witness(f, true, &w));
    return power != NULL ? add_powers(f, power, scaled) : DALCS_OK;
}
