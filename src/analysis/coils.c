/* coils.c - currents that circulate through ideal transformers, by linear programs.
 *
 * Perfectly coupled coils carry, besides their common magnetising current, currents in the ratio of
 * their turns: a circulation in one winding is one in the others too. So flows do not tell how far a
 * current may go, but a linear program in the differences of answers does: KCL, the ratios, and the
 * signs of diodes. GLPK solves it. */
#include "freedom.h"

#ifdef DALCS_WITH_GLPK

#include <glpk.h>
#include <math.h>
#include <setjmp.h>

/* In units near the largest current. The corner that the method ends at is computed from its equations;
 * this only says which corner will do. (GLPK's exact simplex method would, but GMP under it ends the
 * program when memory does.) */
static const double tolerance = 1e-11;

struct program {
    const struct dalcs_view *view;
    int n_part;
    const int *part;
    int n_ties;
    int *tie;    /* columns of the system: free currents of coils */
    int *row_of; /* [n_vertices] KCL, from 1 */
    int n_rows;
    int *place; /* [view->n] of an element in part, else -1 */
    int *index; /* work, from 1 */
    double *value;
    double unit; /* A: a power of 2 near the largest current */
    int n_signals;
    struct dalcs_open_signal *signal; /* whose intervals are wanted */
    bool is_solved;                   /* and found */
    bool *moves;                      /* or, where it is not NULL, which coils of part move */
    glp_prob *lp;
};

static const struct dalcs_probe *probe_of(const struct dalcs_view *view, int freedom) {
    const struct dalcs_network *n = view->network;
    int k = 0;
    while (n->state[k].element != view->freedom[freedom].name) {
        k++;
    }
    return &n->state[k].probe;
}

static int tie_of(struct program *p, int column) {
    int k = 0;
    while (k < p->n_ties && p->tie[k] != column) {
        k++;
    }
    p->tie[k] = column;
    p->n_ties = k < p->n_ties ? p->n_ties : k + 1;
    return k;
}

static enum dalcs_status number(struct program *p) {
    const struct dalcs_view *view = p->view;
    size_t n = (size_t)view->n;
    size_t n_columns = (size_t)dalcs_system_n_columns(view->system);
    p->tie = dalcs_arena_alloc(view->work, n_columns, sizeof(int));
    p->row_of = dalcs_arena_alloc(view->work, (size_t)view->n_vertices, sizeof(int));
    p->place = dalcs_arena_alloc(view->work, n, sizeof(int));
    p->index = dalcs_arena_alloc(view->work, n + n_columns + 2, sizeof(int));
    p->value = dalcs_arena_alloc(view->work, n + n_columns + 2, sizeof(double));
    if (p->tie == NULL || p->row_of == NULL || p->place == NULL || p->index == NULL ||
        p->value == NULL) {
        return DALCS_E_NOMEM;
    }
    for (int i = 0; i < view->n; i++) {
        p->place[i] = -1;
    }
    for (int k = 0; k < p->n_part; k++) {
        const struct dalcs_freedom *f = &view->freedom[p->part[k]];
        p->place[p->part[k]] = k;
        for (int end = 0; end < 2; end++) {
            int *row = &p->row_of[view->u->vertex_of[f->node[end]]];
            *row = *row > 0 ? *row : ++p->n_rows;
        }
    }
    for (int i = 0; i < view->n; i++) {
        const struct dalcs_probe *probe = view->freedom[i].is_coil ? probe_of(view, i) : NULL;
        for (int k = 0; probe != NULL && k < probe->n_terms; k++) {
            if (probe->term[k].index >= view->system->n_x) {
                (void)tie_of(p, probe->term[k].index);
            }
        }
    }
    int exponent;
    (void)frexp(view->largest[1], &exponent);
    p->unit = view->largest[1] > 0.0 ? ldexp(1.0, exponent) : 1.0;
    return DALCS_OK;
}

/* Columns: the differences of all branches, then those of the ties. */
static void write_columns(const struct program *p) {
    glp_add_cols(p->lp, p->n_part + p->n_ties);
    for (int k = 0; k < p->n_part; k++) {
        double back = p->view->freedom[p->part[k]].back;
        glp_set_col_bnds(p->lp, k + 1, isinf(back) ? GLP_FR : GLP_LO, -back / p->unit, 0.0);
    }
    for (int k = 0; k < p->n_ties; k++) {
        glp_set_col_bnds(p->lp, p->n_part + k + 1, GLP_FR, 0.0, 0.0);
    }
}

static void write_kcl(const struct program *p) {
    glp_add_rows(p->lp, p->n_rows);
    for (int r = 1; r <= p->n_rows; r++) {
        glp_set_row_bnds(p->lp, r, GLP_FX, 0.0, 0.0);
    }
    for (int k = 0; k < p->n_part; k++) {
        const struct dalcs_freedom *f = &p->view->freedom[p->part[k]];
        int tail = p->row_of[p->view->u->vertex_of[f->node[0]]];
        int head = p->row_of[p->view->u->vertex_of[f->node[1]]];
        int rows[] = {0, tail, head};
        double values[] = {0.0, 1.0, -1.0};
        glp_set_mat_col(p->lp, k + 1, tail != head ? 2 : 0, rows, values);
    }
}

/* What a coil carries more is what its ties do; nothing, where it is on no loop. */
static void write_ratios(struct program *p) {
    for (int i = 0; i < p->view->n; i++) {
        if (!p->view->freedom[i].is_coil) {
            continue;
        }
        const struct dalcs_probe *probe = probe_of(p->view, i);
        int n = 0;
        for (int k = 0; k < probe->n_terms; k++) {
            if (probe->term[k].index >= p->view->system->n_x) {
                n++;
                p->index[n] = p->n_part + 1 + tie_of(p, probe->term[k].index);
                p->value[n] = -probe->term[k].coefficient;
            }
        }
        if (p->place[i] >= 0) {
            n++;
            p->index[n] = p->place[i] + 1;
            p->value[n] = 1.0;
        }
        int row = glp_add_rows(p->lp, 1);
        glp_set_row_bnds(p->lp, row, GLP_FX, 0.0, 0.0);
        glp_set_mat_row(p->lp, row, n, p->index, p->value);
    }
}

/* The furthest that a device's current goes in a direction (1 or -1); NAN where GLPK fails. */
static double furthest(const struct program *p, int device, double direction) {
    const struct dalcs_device *d = &p->view->u->circuit->device[device];
    for (int k = 0; k < p->n_part; k++) {
        const struct dalcs_freedom *f = &p->view->freedom[p->part[k]];
        double sign = f->node[0] == d->node[0] ? direction : -direction;
        glp_set_obj_coef(p->lp, k + 1, f->device == device ? sign : 0.0);
    }
    glp_set_obj_dir(p->lp, GLP_MAX);
    glp_smcp parameters;
    glp_init_smcp(&parameters);
    parameters.msg_lev = GLP_MSG_OFF;
    parameters.tol_bnd = parameters.tol_dj = tolerance;
    glp_std_basis(p->lp);
    if (glp_simplex(p->lp, &parameters) != 0) {
        return NAN;
    }
    int status = glp_get_status(p->lp);
    return status == GLP_OPT     ? glp_get_obj_val(p->lp) * p->unit
           : status == GLP_UNBND ? INFINITY
                                 : NAN;
}

static void leave(void *info) {
    longjmp(*(jmp_buf *)info, 1);
}

static void find_intervals(struct program *p) {
    p->is_solved = true;
    for (int i = 0; i < p->n_signals; i++) {
        int device = p->view->u->circuit->results.signal[p->signal[i].output].device;
        double rise = furthest(p, device, 1.0);
        double fall = furthest(p, device, -1.0);
        dalcs_view_bound(p->view, true, fall, rise, &p->signal[i]);
        p->is_solved = p->is_solved && !isnan(fall) && !isnan(rise);
    }
}

/* One whose current GLPK cannot bound moves as well. */
static void find_moving(const struct program *p) {
    for (int k = 0; k < p->n_part; k++) {
        const struct dalcs_freedom *f = &p->view->freedom[p->part[k]];
        struct dalcs_open_signal from_here = {0};
        if (f->is_coil) {
            dalcs_view_bound(p->view, true, furthest(p, f->device, -1.0),
                             furthest(p, f->device, 1.0), &from_here);
            p->moves[k] = !(from_here.lower == 0.0 && from_here.upper == 0.0);
        }
    }
}

/* GLPK ends a program that it finds no memory for. */
static enum dalcs_status solve_all(struct program *p) {
    jmp_buf failed;
    if (setjmp(failed) != 0) {
        glp_free_env();
        return DALCS_E_NOMEM;
    }
    glp_error_hook(leave, &failed);
    p->lp = glp_create_prob();
    write_columns(p);
    write_kcl(p);
    write_ratios(p);
    if (p->moves != NULL) {
        find_moving(p);
    } else {
        find_intervals(p);
    }
    glp_delete_prob(p->lp);
    glp_error_hook(NULL, NULL);
    return DALCS_OK;
}

static enum dalcs_status run_program(struct program *p) {
    DALCS_TRY(number(p));
    int before = glp_init_env(); /* one for each thread; 1: there is one already */
    if (before > 1) {
        return DALCS_E_NOMEM;
    }
    int terminal = glp_term_out(GLP_OFF);
    enum dalcs_status status = solve_all(p);
    if (status == DALCS_OK) {
        glp_term_out(terminal);
    }
    if (before == 0 && status == DALCS_OK) {
        glp_free_env();
    }
    return status;
}

enum dalcs_status dalcs_coils_intervals(const struct dalcs_view *view, int n_part, const int *part,
                                        int n, struct dalcs_open_signal *signal, bool *is_solved) {
    struct program p = {
        .view = view, .n_part = n_part, .part = part, .n_signals = n, .signal = signal};
    enum dalcs_status status = run_program(&p);
    *is_solved = p.is_solved;
    return status;
}

enum dalcs_status dalcs_coils_moving(const struct dalcs_view *view, int n_part, const int *part,
                                     bool *moves) {
    struct program p = {.view = view, .n_part = n_part, .part = part, .moves = moves};
    return run_program(&p);
}

const char *dalcs_coils_hint(void) {
    return "GLPK did not find their intervals";
}

#else

const char *dalcs_coils_hint(void) {
    return "their intervals are not computed: this program was built without GLPK";
}

enum dalcs_status dalcs_coils_intervals(const struct dalcs_view *view, int n_part, const int *part,
                                        int n, struct dalcs_open_signal *signal, bool *is_solved) {
    (void)view;
    (void)n_part;
    (void)part;
    (void)n;
    (void)signal;
    *is_solved = false;
    return DALCS_OK;
}

enum dalcs_status dalcs_coils_moving(const struct dalcs_view *view, int n_part, const int *part,
                                     bool *moves) {
    for (int k = 0; k < n_part; k++) {
        moves[k] = view->freedom[part[k]].is_coil;
    }
    return DALCS_OK;
}

#endif
