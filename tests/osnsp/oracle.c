/* oracle.c - a tree of linear programs, solved by GLPK's simplex method. */
#include "oracle.h"

#include <glpk.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Parts of a solution that differ by more than this, relatively, are two solutions. */
static const double same_answer = 1e-8;

struct tree {
    const struct dalcs_system *s;
    glp_prob *lp;
    glp_smcp parameters;
    double *offset; /* [n_pairs] F s */
    const bool *closed;
    struct oracle_answer answer;
};

static void must_be(bool condition, const char *what) {
    if (!condition) {
        fprintf(stderr, "oracle: %s\n", what);
        abort();
    }
}

static double row_times_inputs(const struct dalcs_csr *a, int row, const double *inputs) {
    double sum = 0.0;
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        sum += a->x[k] * inputs[a->j[k]];
    }
    return sum;
}

/* Row i of the program: (sigma P - A) y = sigma P x_k + E s, then C y = w - F s. */
static void write_rows(struct tree *t, double sigma, const double *u) {
    const struct dalcs_system *s = t->s;
    int n_equations = dalcs_system_n_equations(s);
    int n_columns = dalcs_system_n_columns(s);
    const double *inputs = u + s->n_x;
    double *dense = calloc((size_t)n_columns, sizeof(*dense));
    int *index = calloc((size_t)n_columns + 1, sizeof(*index));
    double *value = calloc((size_t)n_columns + 1, sizeof(*value));
    must_be(dense != NULL && index != NULL && value != NULL, "out of memory");
    for (int i = 0; i < n_equations + s->n_pairs; i++) {
        memset(dense, 0, (size_t)n_columns * sizeof(*dense));
        const struct dalcs_csr *a = i < n_equations ? &s->A : &s->C;
        int row = i < n_equations ? i : i - n_equations;
        double sign = i < n_equations ? -1.0 : 1.0;
        for (int k = a->p[row]; k < a->p[row + 1]; k++) {
            dense[a->j[k]] += sign * a->x[k];
        }
        double right;
        if (i < n_equations) {
            right = row_times_inputs(&s->E, row, inputs);
            for (int k = row < s->n_x ? s->P.p[row] : 0; row < s->n_x && k < s->P.p[row + 1]; k++) {
                dense[s->P.j[k]] += sigma * s->P.x[k];
                right += sigma * s->P.x[k] * u[s->P.j[k]];
            }
            glp_set_row_bnds(t->lp, i + 1, GLP_FX, right, right);
        } else {
            t->offset[row] = row_times_inputs(&s->F, row, inputs);
        }
        int n = 0;
        for (int c = 0; c < n_columns; c++) {
            if (dense[c] != 0.0) {
                n++;
                index[n] = c + 1;
                value[n] = dense[c];
            }
        }
        glp_set_mat_row(t->lp, i + 1, n, index, value);
    }
    free(dense);
    free(index);
    free(value);
}

enum pair_state { PAIR_OPEN, PAIR_CLOSED, PAIR_UNDECIDED };

static void set_pair(struct tree *t, int pair, enum pair_state state) {
    int n_equations = dalcs_system_n_equations(t->s);
    bool is_switch = t->s->pair[pair].kind == DALCS_PAIR_SWITCH;
    double zero = -t->offset[pair];
    int row = n_equations + pair + 1;
    int column = n_equations + pair + 1;
    glp_set_row_bnds(t->lp, row,
                     state == PAIR_CLOSED ? GLP_FX
                     : is_switch          ? GLP_FR
                                          : GLP_LO,
                     zero, zero);
    glp_set_col_bnds(t->lp, column,
                     state == PAIR_OPEN ? GLP_FX
                     : is_switch        ? GLP_FR
                                        : GLP_LO,
                     0.0, 0.0);
}

/* True when the linear program has a solution; *bounded tells whether the objective is. */
static bool solve(struct tree *t, bool *bounded) {
    int failure = glp_simplex(t->lp, &t->parameters);
    if (failure != 0) {
        glp_std_basis(t->lp);
        failure = glp_simplex(t->lp, &t->parameters);
    }
    int status = glp_get_status(t->lp);
    if (failure != 0 || (status != GLP_OPT && status != GLP_NOFEAS && status != GLP_UNBND)) {
        glp_std_basis(t->lp);
        must_be(glp_exact(t->lp, &t->parameters) == 0, "neither simplex nor exact simplex ended");
        status = glp_get_status(t->lp);
    }
    *bounded = status == GLP_OPT;
    return status == GLP_OPT || status == GLP_UNBND;
}

/* All pairs are decided and there is a solution: keep it, and look whether there is another by
 * pushing along a direction that no coincidence makes normal to the solutions. */
static void take_leaf(struct tree *t) {
    const struct dalcs_system *s = t->s;
    int n_columns = dalcs_system_n_columns(s);
    t->answer.n_modes++;
    if (!t->answer.feasible) {
        t->answer.feasible = true;
        t->answer.unique = true;
        for (int c = 0; c < n_columns; c++) {
            t->answer.y[c] = glp_get_col_prim(t->lp, c + 1);
        }
    }
    for (int direction = GLP_MIN; direction <= GLP_MAX && t->answer.unique; direction++) {
        glp_set_obj_dir(t->lp, direction);
        for (int c = 0; c < n_columns; c++) {
            glp_set_obj_coef(t->lp, c + 1, sin((c + 1.0) * (c + 1.0))); /* in no linear relation */
        }
        bool bounded;
        must_be(solve(t, &bounded), "a solution was lost");
        t->answer.unique = bounded;
        for (int c = 0; bounded && c < n_columns; c++) {
            double y = glp_get_col_prim(t->lp, c + 1);
            double apart = fabs(y - t->answer.y[c]);
            if (apart > same_answer * fmax(1.0, fabs(y))) {
                t->answer.unique = false;
            }
        }
    }
    for (int c = 0; c < n_columns; c++) {
        glp_set_obj_coef(t->lp, c + 1, 0.0);
    }
}

static void search(struct tree *t, int pair) {
    while (pair < t->s->n_pairs && t->s->pair[pair].kind == DALCS_PAIR_SWITCH) {
        pair++;
    }
    bool bounded;
    if (!solve(t, &bounded)) {
        return;
    }
    if (pair == t->s->n_pairs) {
        take_leaf(t);
        return;
    }
    for (enum pair_state state = PAIR_OPEN; state <= PAIR_CLOSED; state++) {
        set_pair(t, pair, state);
        search(t, pair + 1);
    }
    set_pair(t, pair, PAIR_UNDECIDED);
}

static void setup(struct tree *t, const struct dalcs_system *system, double sigma, const double *u,
                  const bool *closed) {
    int n_equations = dalcs_system_n_equations(system);
    int n_columns = dalcs_system_n_columns(system);
    *t = (struct tree){.s = system, .lp = glp_create_prob(), .closed = closed};
    t->offset = calloc((size_t)system->n_pairs + 1, sizeof(*t->offset));
    t->answer.y = calloc((size_t)n_columns + 1, sizeof(*t->answer.y));
    must_be(t->offset != NULL && t->answer.y != NULL, "out of memory");
    glp_term_out(GLP_OFF);
    glp_init_smcp(&t->parameters);
    t->parameters.tol_bnd = 1e-9;
    t->parameters.tol_dj = 1e-9;
    if (n_columns > 0) {
        glp_add_rows(t->lp, n_equations + system->n_pairs);
        glp_add_cols(t->lp, n_columns);
        write_rows(t, sigma, u);
    }
    for (int c = 0; c < n_equations; c++) {
        bool zero = system->column[c].kind == DALCS_LABEL_REFERENCE;
        glp_set_col_bnds(t->lp, c + 1, zero ? GLP_FX : GLP_FR, 0.0, 0.0);
    }
    for (int d = 0; d < system->n_pairs; d++) {
        bool is_switch = system->pair[d].kind == DALCS_PAIR_SWITCH;
        set_pair(t, d, !is_switch ? PAIR_UNDECIDED : closed[d] ? PAIR_CLOSED : PAIR_OPEN);
    }
    glp_std_basis(t->lp);
}

static void finish(struct tree *t) {
    glp_delete_prob(t->lp);
    free(t->offset);
}

struct oracle_answer oracle_solve(const struct dalcs_system *system, double sigma, const double *u,
                                  const bool *closed) {
    struct tree t;
    setup(&t, system, sigma, u, closed);
    search(&t, 0);
    finish(&t);
    return t.answer;
}

static bool is_among(const char *name, const char *const *element, int n_elements) {
    bool is = false;
    for (int k = 0; k < n_elements && !is; k++) {
        is = strcmp(name, element[k]) == 0;
    }
    return is;
}

bool oracle_contradicts(const struct dalcs_system *system, double sigma, const double *u,
                        const bool *closed, const char *const *element, int n_elements) {
    int n_equations = dalcs_system_n_equations(system);
    struct tree t;
    setup(&t, system, sigma, u, closed);
    for (int row = 0; row < n_equations; row++) {
        bool is_law = system->row[row].kind == DALCS_LABEL_BRANCH ||
                      system->row[row].kind == DALCS_LABEL_STATE;
        if (is_law && !is_among(system->row[row].element, element, n_elements)) {
            glp_set_row_bnds(t.lp, row + 1, GLP_FR, 0.0, 0.0);
        }
    }
    for (int d = 0; d < system->n_pairs; d++) {
        if (!is_among(system->pair[d].element, element, n_elements)) {
            glp_set_row_bnds(t.lp, n_equations + d + 1, GLP_FR, 0.0, 0.0);
            glp_set_col_bnds(t.lp, n_equations + d + 1, GLP_FR, 0.0, 0.0);
        }
    }
    bool bounded;
    bool has_answer = solve(&t, &bounded);
    finish(&t);
    free(t.answer.y);
    return !has_answer;
}
