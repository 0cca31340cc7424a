/* replay.c - solves a one-step problem again that a run left behind, and shows it by names.
 *
 * usage: replay FILE.failed.dalcs
 *
 * The residuals are worked out here, from the matrices in the file and the answer, and not by the
 * engine. Exit status: 0 certified, 1 not, 2 usage, 3 a damaged file, 4 input/output. */
#include "osnsp.h"
#include "refute.h"
#include "system_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct replay {
    struct dalcs_system_file file;
    struct dalcs_osnsp osnsp;
    double *y; /* [n_columns] the answer, or what was tried last */
};

static void print_problem(const struct dalcs_system_file *f) {
    const struct dalcs_system *s = &f->system;
    printf("problem   %s\n", f->about);
    printf("size      %d states, %d algebraic unknowns, %d pairs, %d sources; %s\n", s->n_x, s->n_z,
           s->n_pairs, s->n_inputs - 1, s->monotone ? "passive" : "not passive");
    if (f->sigma > 0.0) {
        printf("step      h = %.6g s\n", 1.0 / f->sigma);
    } else {
        printf("step      none: an operating point\n");
    }
    for (int k = 1; k < s->n_inputs; k++) {
        printf("source    %-12s %14.6g\n", s->input_element[k], f->u[s->n_x + k]);
    }
    for (int x = 0; x < s->n_x; x++) {
        printf("state     %-12s %14.6g %c before the step\n", s->column[x].element, f->u[x],
               s->column_is_current[x] ? 'A' : 'V');
    }
}

static void print_unknowns(const struct replay *r) {
    const struct dalcs_system *s = &r->file.system;
    static const char *const what[] = {[DALCS_LABEL_STATE] = "state",
                                       [DALCS_LABEL_NODE] = "node",
                                       [DALCS_LABEL_BRANCH] = "current of",
                                       [DALCS_LABEL_REFERENCE] = "reference of"};
    for (int c = 0; c < dalcs_system_n_equations(s); c++) {
        printf("  %-12s %-12s %14.6g %c\n", what[s->column[c].kind], s->column[c].element, r->y[c],
               s->column_is_current[c] ? 'A' : 'V');
    }
}

static double add_row(const struct dalcs_csr *a, int row, const double *v, double *largest) {
    double sum = 0.0;
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        double term = a->x[k] * v[a->j[k]];
        sum += term;
        *largest = fmax(*largest, fabs(term));
    }
    return sum;
}

static double add_difference(const struct dalcs_csr *a, int row, const double *after,
                             const double *before, double factor, double *largest) {
    double sum = 0.0;
    for (int k = a->p[row]; k < a->p[row + 1]; k++) {
        double term = factor * a->x[k] * (after[a->j[k]] - before[a->j[k]]);
        sum += term;
        *largest = fmax(*largest, fabs(term));
    }
    return sum;
}

static void print_residuals(const struct replay *r) {
    const struct dalcs_system *s = &r->file.system;
    const double *u = r->file.u;
    printf("residual of every equation, and the largest term in it\n");
    for (int i = 0; i < dalcs_system_n_equations(s); i++) {
        double largest = 0.0;
        double sum = add_row(&s->A, i, r->y, &largest) + add_row(&s->E, i, u + s->n_x, &largest);
        if (i < s->n_x) {
            sum -= add_difference(&s->P, i, r->y, u, r->file.sigma, &largest);
        }
        printf("  %-12s %-12s %14.2e of %10.3g %c\n", dalcs_label_equation(s->row[i].kind),
               s->row[i].element, fabs(sum), largest, s->row_is_current[i] ? 'A' : 'V');
    }
}

static void print_pairs(const struct replay *r) {
    const struct dalcs_system *s = &r->file.system;
    const double *lambda = r->y + dalcs_system_n_equations(s);
    printf("mode in the file -> now, current, reverse voltage\n");
    for (int d = 0; d < s->n_pairs; d++) {
        double largest = 0.0;
        double w =
            add_row(&s->C, d, r->y, &largest) + add_row(&s->F, d, r->file.u + s->n_x, &largest);
        bool was_on = (r->file.mode[d / 64] >> (d % 64) & 1) != 0;
        printf("  %-12s %-12s %s -> %s %14.6g A %14.6g V\n",
               s->pair[d].kind == DALCS_PAIR_SWITCH ? "switch"
               : s->pair[d].is_breakdown            ? "breakdown of"
                                                    : "diode",
               s->pair[d].element, was_on ? "on " : "off",
               dalcs_osnsp_is_on(&r->osnsp, d) ? "on " : "off", lambda[d], w);
    }
}

static void print_refusal(const struct dalcs_witness *w, bool is_certain) {
    static const char *const kind[] = {[DALCS_WITNESS_LOOP] = "loop",
                                       [DALCS_WITNESS_CUTSET] = "cutset",
                                       [DALCS_WITNESS_MODE] = "no mode of"};
    printf("verdict   %s: %s",
           is_certain ? "no solution exists" : "a solution may exist, but none was found",
           kind[w->kind]);
    for (int k = 0; k < w->n_elements; k++) {
        printf("%s %s", k > 0 ? "," : "", w->element[k]);
    }
    printf("\n");
}

static void print_verdict(const struct replay *r, enum dalcs_status status, bool is_certain) {
    const struct dalcs_osnsp *p = &r->osnsp;
    printf("work      %ld mode changes, %ld factorisations\n", p->counters.pivots,
           p->counters.factorizations);
    if (status == DALCS_OK) {
        printf("verdict   certified%s: the worst residual is %.2g of its scale\n",
               p->least_norm ? ", the least-norm solution of a singular mode" : "",
               p->certificate.worst);
    } else if (status == DALCS_INFEASIBLE) {
        print_refusal(&p->witness, is_certain);
    } else {
        printf("verdict   %s\n", dalcs_status_text(status));
    }
}

/* Solves from the mode in the file and prints everything. */
static enum dalcs_status replay(struct replay *r) {
    const struct dalcs_system *s = &r->file.system;
    const struct dalcs_run_options usual = dalcs_run_options_default();
    const struct dalcs_osnsp_options options = dalcs_osnsp_options_of(&usual);
    r->y = dalcs_alloc((size_t)dalcs_system_n_columns(s), sizeof(*r->y));
    if (r->y == NULL) {
        return DALCS_E_NOMEM;
    }
    DALCS_TRY(dalcs_osnsp_setup(&r->osnsp, s, &options));
    memcpy(r->osnsp.mode, r->file.mode, (size_t)r->osnsp.n_words * sizeof(*r->osnsp.mode));
    enum dalcs_status status = dalcs_osnsp_solve(&r->osnsp, r->file.sigma, r->file.u, r->y);
    bool is_certain = false;
    if (status == DALCS_INFEASIBLE) {
        enum dalcs_status asked =
            dalcs_osnsp_refute(&r->osnsp, r->file.sigma, r->file.u, &is_certain);
        status = asked < DALCS_OK ? asked : status;
    }
    if (status >= DALCS_OK) {
        print_problem(&r->file);
        printf(status == DALCS_OK ? "answer\n" : "what was tried last\n");
        print_unknowns(r);
        print_pairs(r);
        print_residuals(r);
        print_verdict(r, status, is_certain);
    }
    dalcs_osnsp_finish(&r->osnsp);
    return status;
}

int main(int argc, char **argv) {
    if (argc != 2 || argv[1][0] == '-') {
        bool help = argc == 2 && (strcmp(argv[1], "-h") == 0 || strcmp(argv[1], "--help") == 0);
        fputs("usage: replay FILE.failed.dalcs\n", help ? stdout : stderr);
        return help ? 0 : 2;
    }
    struct dalcs_diag diag = {0};
    struct replay r = {0};
    enum dalcs_status status = dalcs_system_file_read(&r.file, argv[1], &diag);
    if (status == DALCS_OK) {
        status = replay(&r);
    }
    for (size_t k = 0; k < diag.n; k++) {
        fprintf(stderr, "%s\n", diag.item[k].text);
    }
    if (status < DALCS_OK && diag.n == 0) {
        fprintf(stderr, "replay: error: %s\n", dalcs_status_text(status));
    }
    free(r.y);
    dalcs_system_file_finish(&r.file);
    dalcs_diag_finish(&diag);
    return status == DALCS_OK ? 0 : status == DALCS_E_NETLIST ? 3 : status == DALCS_E_IO ? 4 : 1;
}
