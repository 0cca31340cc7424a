/* test_step_form.c - the condensed one-step problem says the same as the whole one. */
#include "step_form.h"

#include "build_network.h"

#include <lapacke.h>

static const char *const circuit[] = {
    "bridge on a floating capacitor\nV1 a b 3\nR0 b 0 1\nD1 a p\nD2 b p\nD3 m a\nD4 m b\n"
    "C1 p m 1u IC=2\nR1 p m 1k\nR2 m 0 1meg\n.tran 1u 1m uic\n",
    "coils, one far smaller than the step\nV1 a 0 2\nL1 a b 1e-15 IC=1\nL2 b c 1m IC=1\n"
    "L3 d 0 4m\nK1 L2 L3 0.9\nR1 c 0 2\nD1 d e dm\nC1 e 0 1u\nR2 e 0 3\n"
    ".model dm D(Ron=0.2 Vfwd=0.6)\n.tran 1u 1m uic\n",
    "a loop and a chain of capacitors\nI1 0 a 1\nR1 a 0 9\nC1 a b 1u IC=1\nC2 b 0 3u\n"
    "C3 a 0 2u IC=1\nC4 b c 5u\nR2 c 0 4\nD1 c a\n.tran 1u 1m uic\n.save i(c2) v(a)\n",
};

enum { N_CIRCUITS = sizeof(circuit) / sizeof(circuit[0]), MAX = 40 };

/* (sigma P - A; rows of C where `on`, of lambda elsewhere) y = (sigma P x + E s; -F s; 0) by LAPACK. */
static void solve_whole(const struct dalcs_system *s, double sigma, unsigned on, const double *u,
                        double *y) {
    int n_equations = dalcs_system_n_equations(s);
    int n = dalcs_system_n_columns(s);
    double M[MAX * MAX] = {0.0};
    lapack_int pivot[MAX];
    for (int i = 0; i < n_equations; i++) {
        y[i] = dalcs_csr_row_dot(&s->E, i, u + s->n_x);
        for (int c = 0; c < n; c++) {
            M[i * n + c] = -entry_of(&s->A, i, c);
        }
        for (int c = 0; i < s->n_x && c < s->n_x; c++) {
            M[i * n + c] += sigma * entry_of(&s->P, i, c);
            y[i] += sigma * entry_of(&s->P, i, c) * u[c];
        }
    }
    for (int d = 0; d < s->n_pairs; d++) {
        bool is_on = on >> d & 1;
        y[n_equations + d] = is_on ? -dalcs_csr_row_dot(&s->F, d, u + s->n_x) : 0.0;
        for (int c = 0; c < n; c++) {
            M[(n_equations + d) * n + c] = is_on ? entry_of(&s->C, d, c) : c == n_equations + d;
        }
    }
    ck_assert_int_eq(LAPACKE_dgesv(LAPACK_ROW_MAJOR, n, 1, M, n, pivot, y, 1), 0);
}

/* The condensed rows at the whole answer: n equations vanish, the others give w; X gives x+. With
 * conditions up to 1e6 here a solution is good to 1e-9 of the terms in a row. */
static void check_condensed(const struct dalcs_system *s, const struct dalcs_step_form *f,
                            const double *u, const double *y) {
    double sum[MAX] = {0.0};
    double size[MAX] = {0.0};
    int n = f->n + f->n_pairs;
    for (int c = 0; c < n; c++) {
        int column = c < f->n ? f->column_of[c] : dalcs_system_n_equations(s) + c - f->n;
        for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
            double term = f->K.x[k] * y[column] / f->scale[c];
            sum[f->K.j[k]] += term;
            size[f->K.j[k]] += fabs(term);
        }
    }
    for (int i = 0; i < n; i++) {
        double w = 0.0;
        sum[i] -= dalcs_csr_row_dot(&f->R, i, u);
        if (i >= f->n) {
            w = dalcs_csr_row_dot(&s->C, i - f->n, y) +
                dalcs_csr_row_dot(&s->F, i - f->n, u + s->n_x);
            w *= f->row_scale[i];
        }
        ck_assert_double_le(fabs(sum[i] - w), 1e-9 * (size[i] + fabs(w)) + 1e-300);
    }
    for (int x = 0; x < s->n_x; x++) {
        double recovered =
            dalcs_csr_row_dot(&f->state.X, x, y) + dalcs_csr_row_dot(&f->state.Xu, x, u);
        ck_assert_double_eq_tol(recovered, y[x], 1e-9 * (1.0 + fabs(y[x])));
        const int *ends = &f->state.ends[2 * x];
        if (ends[0] >= 0) {
            ck_assert_double_eq_tol(y[ends[0]] - y[ends[1]], y[x], 1e-9 * (1.0 + fabs(y[x])));
        }
    }
}

START_TEST(test_same_as_whole) {
    for (int k = 0; k < N_CIRCUITS; k++) {
        struct text_network t;
        build_good_network(&t, circuit[k]);
        const struct dalcs_system *s = &t.network.system[0];
        double u[MAX];
        double y[MAX];
        text_network_inputs(&t, 0, u);
        for (double sigma = 1e4; sigma <= 1e6; sigma *= 10.0) {
            struct dalcs_step_form f;
            ck_assert_int_eq(dalcs_step_form_build(&f, s, sigma), DALCS_OK);
            ck_assert_int_le(f.n, dalcs_system_n_equations(s));
            /* The regular modes of a bridge: not both diodes of one side of the source. */
            const unsigned modes = k == 0 ? 0x777 : 0x3;
            for (unsigned on = 0; on < 1u << s->n_pairs; on++) {
                if ((modes >> on & 1) != 0) {
                    solve_whole(s, sigma, on, u, y);
                    check_condensed(s, &f, u, y);
                }
            }
            dalcs_step_form_finish(&f);
        }
        text_network_finish(&t);
    }
}

END_TEST

/* Capacitors vanish as differences of voltages, coils through their branch; not where sigma L is
 * nothing beside the 1 of the voltages: there the current stays, and shorts at sigma = 0. */
START_TEST(test_what_stays) {
    struct text_network t;
    build_good_network(&t, circuit[1]);
    const struct dalcs_system *s = &t.network.system[0];
    struct dalcs_step_form f;
    ck_assert_int_eq(dalcs_step_form_build(&f, s, 1e6), DALCS_OK);
    ck_assert_int_eq(f.n, s->n_z + 1);
    ck_assert_int_eq(f.column_of[s->n_z], find_column(s, DALCS_LABEL_STATE, "l1"));
    dalcs_step_form_finish(&f);
    ck_assert_int_eq(dalcs_step_form_build(&f, s, 0.0), DALCS_OK);
    ck_assert_int_eq(f.n, s->n_z + 3);
    int c1 = find_column(s, DALCS_LABEL_STATE, "c1");
    for (int i = 0; i < f.n; i++) {
        ck_assert_int_ne(f.column_of[i], c1);
    }
    dalcs_step_form_finish(&f);
    ck_assert_ptr_null(f.column_of);
    text_network_finish(&t);
}

END_TEST

/* Scales are powers of 2, so that scaling rounds nothing, and leave entries of about 1. */
START_TEST(test_balanced) {
    for (int k = 0; k < N_CIRCUITS; k++) {
        struct text_network t;
        build_good_network(&t, circuit[k]);
        struct dalcs_step_form f;
        ck_assert_int_eq(dalcs_step_form_build(&f, &t.network.system[0], 1e6), DALCS_OK);
        for (int i = 0; i < f.n + f.n_pairs; i++) {
            int exponent;
            ck_assert_double_eq(frexp(f.scale[i], &exponent), 0.5);
            ck_assert_double_eq(frexp(f.row_scale[i], &exponent), 0.5);
            double largest = 0.0;
            for (int e = f.K.p[i]; e < f.K.p[i + 1]; e++) {
                largest = fmax(largest, fabs(f.K.x[e]));
            }
            ck_assert(largest >= 0.25 && largest <= 4.0);
        }
        dalcs_step_form_finish(&f);
        text_network_finish(&t);
    }
}

END_TEST

RUN_TESTS("step_form", test_same_as_whole, test_what_stays, test_balanced)
