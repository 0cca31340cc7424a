/* cones.c - Farkas' alternative of the constraints of one instant, by GLPK. */
#include "cones.h"

#ifdef DALCS_WITH_GLPK

#include <glpk.h>
#include <math.h>
#include <setjmp.h>

static const double tolerance = 1e-9;

/* A value of a program whose coefficients are its input's that is more than rounding. */
static const double significant = 1e-6;

struct programs {
    const struct dalcs_system *s;
    const enum dalcs_hold *hold;
    struct dalcs_arena *arena;
    struct dalcs_cones *cones;
    int n;      /* equations */
    int *index; /* [n + n_pairs + n_columns + 2] from 1 */
    double *value;
    enum dalcs_status status;
};

static void leave(void *info) {
    longjmp(*(jmp_buf *)info, 1);
}

static bool solve(glp_prob *lp) {
    glp_smcp parameters;
    glp_init_smcp(&parameters);
    parameters.msg_lev = GLP_MSG_OFF;
    parameters.tol_bnd = parameters.tol_dj = tolerance;
    /* with values far apart it may go round for ever; what is not solved is said not to be checked */
    parameters.it_lim = 1000 + 20 * (glp_get_num_rows(lp) + glp_get_num_cols(lp));
    return glp_simplex(lp, &parameters) == 0 && glp_get_status(lp) == GLP_OPT;
}

static void scale(glp_prob *lp) {
    glp_scale_prob(lp, GLP_SF_GM | GLP_SF_EQ | GLP_SF_2N | GLP_SF_SKIP);
    glp_adv_basis(lp, 0);
}

/* ---- A point that qualifies ----------------------------------------------------------------- */

static bool is_free_pair(const struct programs *p, int column) {
    return column >= p->n && p->hold[column - p->n] == DALCS_NOT_HELD;
}

/* Row i of a, over x, z and lambda - t, so that t stands for its lambdas; and -t in it if `less`. */
static void set_row(const struct programs *p, glp_prob *lp, int row, const struct dalcs_csr *a,
                    int i, bool less) {
    int n = 0;
    double t = less ? -1.0 : 0.0;
    for (int q = a->p[i]; q < a->p[i + 1]; q++) {
        n++;
        p->index[n] = a->j[q] + 1;
        p->value[n] = a->x[q];
        t += is_free_pair(p, a->j[q]) ? a->x[q] : 0.0;
    }
    if (t != 0.0) {
        n++;
        p->index[n] = dalcs_system_n_columns(p->s) + 1;
        p->value[n] = t;
    }
    glp_set_mat_row(lp, row, n, p->index, p->value);
}

/* max t: rows II are 0, every w and every lambda is at least t <= 1. */
static glp_prob *make_point_program(const struct programs *p) {
    const struct dalcs_system *s = p->s;
    int n_columns = dalcs_system_n_columns(s);
    glp_prob *lp = glp_create_prob();
    glp_add_cols(lp, n_columns + 1);
    glp_add_rows(lp, s->n_z + s->n_pairs + 1);
    for (int c = 0; c < n_columns; c++) {
        enum dalcs_hold hold = c < p->n ? DALCS_HELD_CLOSED : p->hold[c - p->n];
        int type = hold == DALCS_HELD_CLOSED ? GLP_FR : hold == DALCS_NOT_HELD ? GLP_LO : GLP_FX;
        glp_set_col_bnds(lp, c + 1, type, 0.0, 0.0);
    }
    glp_set_col_bnds(lp, n_columns + 1, GLP_UP, 0.0, 1.0);
    for (int r = 0; r < s->n_z; r++) {
        set_row(p, lp, r + 1, &s->A, s->n_x + r, false);
        glp_set_row_bnds(lp, r + 1, GLP_FX, 0.0, 0.0);
    }
    for (int i = 0; i < s->n_pairs; i++) {
        int row = s->n_z + i + 1;
        bool is_free = p->hold[i] == DALCS_NOT_HELD;
        set_row(p, lp, row, &s->C, i, is_free);
        glp_set_row_bnds(lp, row,
                         is_free                           ? GLP_LO
                         : p->hold[i] == DALCS_HELD_CLOSED ? GLP_FX
                                                           : GLP_FR,
                         0.0, 0.0);
    }
    glp_set_obj_dir(lp, GLP_MAX);
    glp_set_obj_coef(lp, n_columns + 1, 1.0);
    return lp;
}

static void find_point(struct programs *p) {
    int n_columns = dalcs_system_n_columns(p->s);
    glp_prob *lp = make_point_program(p);
    scale(lp);
    p->cones->is_solved = solve(lp);
    p->cones->is_qualified = p->cones->is_solved && glp_get_obj_val(lp) > 0.5;
    p->cones->point = dalcs_arena_alloc(p->arena, (size_t)n_columns + 1, sizeof(double));
    for (int c = 0; p->cones->point != NULL && c < n_columns; c++) {
        p->cones->point[c] =
            glp_get_col_prim(lp, c + 1) + (is_free_pair(p, c) ? glp_get_obj_val(lp) : 0.0);
    }
    glp_delete_prob(lp);
}

/* ---- Members of a cone ---------------------------------------------------------------------- */

/* Columns: mu of rows II, nu of pairs. Rows: the states (free where the cone leaves them), z,
 * lambda. */
static glp_prob *make_cone_program(const struct programs *p, enum dalcs_cone cone) {
    const struct dalcs_system *s = p->s;
    glp_prob *lp = glp_create_prob();
    glp_add_cols(lp, s->n_z + s->n_pairs + 1);
    glp_add_rows(lp, dalcs_system_n_columns(s));
    for (int r = 0; r < s->n_z; r++) {
        int n = 0;
        for (int q = s->A.p[s->n_x + r]; q < s->A.p[s->n_x + r + 1]; q++) {
            n++;
            p->index[n] = s->A.j[q] + 1;
            p->value[n] = s->A.x[q];
        }
        glp_set_mat_col(lp, r + 1, n, p->index, p->value);
        glp_set_col_bnds(lp, r + 1, GLP_DB, -1.0, 1.0);
    }
    for (int i = 0; i < s->n_pairs; i++) {
        int column = s->n_z + i + 1;
        int n = 0;
        for (int q = s->C.p[i]; q < s->C.p[i + 1]; q++) {
            n++;
            p->index[n] = s->C.j[q] + 1;
            p->value[n] = s->C.x[q];
        }
        glp_set_mat_col(lp, column, n, p->index, p->value);
        bool is_open = p->hold[i] == DALCS_HELD_OPEN;
        glp_set_col_bnds(lp, column, is_open ? GLP_FX : GLP_DB,
                         p->hold[i] == DALCS_HELD_CLOSED ? -1.0 : 0.0, is_open ? 0.0 : 1.0);
    }
    glp_set_col_bnds(lp, s->n_z + s->n_pairs + 1, GLP_FX, 0.0, 0.0);
    for (int c = 0; c < dalcs_system_n_columns(s); c++) {
        int type = GLP_FX;
        if (c < s->n_x) {
            type = cone == DALCS_CONE_STATES ? GLP_FR : GLP_FX;
        } else if (c >= p->n) {
            enum dalcs_hold hold = p->hold[c - p->n];
            type = hold == DALCS_NOT_HELD ? GLP_UP : hold == DALCS_HELD_OPEN ? GLP_FR : GLP_FX;
        }
        glp_set_row_bnds(lp, c + 1, type, 0.0, 0.0);
    }
    return lp;
}

/* The multipliers of rows and pairs at the program's solution; what is only rounding is 0. */
static double *read_member(struct programs *p, glp_prob *lp) {
    const struct dalcs_system *s = p->s;
    double *member = dalcs_arena_alloc(p->arena, (size_t)(p->n + s->n_pairs) + 1, sizeof(double));
    if (member == NULL) {
        p->status = DALCS_E_NOMEM;
        return NULL;
    }
    for (int k = 0; k < s->n_z + s->n_pairs; k++) {
        double value = glp_get_col_prim(lp, k + 1);
        member[s->n_x + k] = fabs(value) > tolerance ? value : 0.0;
    }
    return member;
}

/* The most of the sum of nu and of what their columns leave, -(L_II' mu + D' nu). */
static bool has_diodes(struct programs *p, glp_prob *lp, double **ray) {
    glp_set_obj_dir(lp, GLP_MAX);
    for (int k = 0; k < p->s->n_z + p->s->n_pairs; k++) {
        const struct dalcs_csr *a = k < p->s->n_z ? &p->s->A : &p->s->C;
        int row = k < p->s->n_z ? p->s->n_x + k : k - p->s->n_z;
        double value = k >= p->s->n_z && p->hold[row] == DALCS_NOT_HELD ? 1.0 : 0.0;
        for (int q = a->p[row]; q < a->p[row + 1]; q++) {
            value -= is_free_pair(p, a->j[q]) ? a->x[q] : 0.0;
        }
        glp_set_obj_coef(lp, k + 1, value);
    }
    bool is_solved = solve(lp);
    p->cones->is_solved = p->cones->is_solved && is_solved;
    bool has = is_solved && glp_get_obj_val(lp) > significant;
    if (has && ray != NULL) {
        *ray = read_member(p, lp);
    }
    return has;
}

/* Sets the objective to the coefficients of an input; returns the largest of them. */
static double set_input(const struct programs *p, glp_prob *lp, int input) {
    const struct dalcs_system *s = p->s;
    double largest = 0.0;
    for (int k = 0; k < s->n_z + s->n_pairs; k++) {
        const struct dalcs_csr *a = k < s->n_z ? &s->E : &s->F;
        int row = k < s->n_z ? s->n_x + k : k - s->n_z;
        double value = 0.0;
        for (int q = a->p[row]; q < a->p[row + 1]; q++) {
            value += a->j[q] == input ? a->x[q] : 0.0;
        }
        glp_set_obj_coef(lp, k + 1, value);
        largest = fmax(largest, fabs(value));
    }
    return largest;
}

static double bound(struct programs *p, glp_prob *lp, int direction, double largest,
                    double **member) {
    glp_set_obj_dir(lp, direction);
    if (!solve(lp)) {
        p->cones->is_solved = false;
        return 0.0;
    }
    double value = glp_get_obj_val(lp);
    if (fabs(value) <= significant * largest) {
        return 0.0;
    }
    *member = read_member(p, lp);
    return value;
}

static void find_members(struct programs *p, enum dalcs_cone cone) {
    glp_prob *lp = make_cone_program(p, cone);
    scale(lp);
    if (cone == DALCS_CONE_STATES) {
        p->cones->has_constraints = has_diodes(p, lp, NULL);
    } else if (!p->cones->is_qualified) {
        (void)has_diodes(p, lp, &p->cones->ray);
    }
    for (int j = 0; j < p->s->n_inputs && p->cones->is_solved; j++) {
        struct dalcs_cone_range *range = &p->cones->range[cone][j];
        double largest = set_input(p, lp, j);
        if (largest > 0.0) {
            range->upper = bound(p, lp, GLP_MAX, largest, &range->highest);
            range->lower = bound(p, lp, GLP_MIN, largest, &range->lowest);
        }
    }
    glp_delete_prob(lp);
}

/* GLPK ends a program that it finds no memory for. */
static enum dalcs_status solve_all(struct programs *p) {
    jmp_buf failed;
    if (setjmp(failed) != 0) {
        glp_free_env();
        return DALCS_E_NOMEM;
    }
    glp_error_hook(leave, &failed);
    find_point(p);
    for (int cone = 0; cone < DALCS_N_CONES && p->cones->is_solved; cone++) {
        find_members(p, (enum dalcs_cone)cone);
    }
    glp_error_hook(NULL, NULL);
    return p->cones->point == NULL ? DALCS_E_NOMEM : p->status;
}

enum dalcs_status dalcs_cones_find(struct dalcs_cones *cones, struct dalcs_arena *arena,
                                   const struct dalcs_system *s, const enum dalcs_hold *hold) {
    *cones = (struct dalcs_cones){0};
    struct programs p = {.s = s, .hold = hold, .arena = arena, .cones = cones};
    p.n = dalcs_system_n_equations(s);
    size_t most = (size_t)(p.n + dalcs_system_n_columns(s) + s->n_pairs + 2);
    p.index = dalcs_arena_alloc(arena, most, sizeof(int));
    p.value = dalcs_arena_alloc(arena, most, sizeof(double));
    for (int cone = 0; cone < DALCS_N_CONES; cone++) {
        cones->range[cone] =
            dalcs_arena_alloc(arena, (size_t)s->n_inputs + 1, sizeof(*cones->range[cone]));
        if (cones->range[cone] == NULL) {
            return DALCS_E_NOMEM;
        }
    }
    if (p.index == NULL || p.value == NULL) {
        return DALCS_E_NOMEM;
    }
    int before = glp_init_env(); /* one for each thread; 1: there is one already */
    if (before > 1) {
        return DALCS_E_NOMEM;
    }
    int terminal = glp_term_out(GLP_OFF);
    enum dalcs_status status = solve_all(&p);
    if (status == DALCS_OK) {
        glp_term_out(terminal);
    }
    if (before == 0 && status == DALCS_OK) {
        glp_free_env();
    }
    return status;
}

#else

enum dalcs_status dalcs_cones_find(struct dalcs_cones *cones, struct dalcs_arena *arena,
                                   const struct dalcs_system *s, const enum dalcs_hold *hold) {
    (void)arena;
    (void)s;
    (void)hold;
    *cones = (struct dalcs_cones){0};
    return DALCS_OK;
}

#endif
