/* witness.c - why a problem has no solution, in elements.
 *
 * In an infeasible monotone problem the proximal iterates run away along a ray d: K d = 0 in the
 * mode's rows, currents only forward, voltages only reverse, and sources that do work along it
 * (d'b > 0, which the running away itself shows). Its nonzero entries are a loop of elements that
 * carry current without resistance, or a cutset of elements that block. */
#include "osnsp_internal.h"

#include "magnitudes.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

void dalcs_witness_add(struct dalcs_witness *w, const char *name) {
    for (int k = 0; k < w->n_elements; k++) {
        if (strcmp(w->element[k], name) == 0) {
            return;
        }
    }
    size_t capacity = (size_t)w->capacity;
    if (dalcs_grow(&w->element, &capacity, (size_t)w->n_elements + 1, sizeof(*w->element)) !=
        DALCS_OK) {
        return; /* one name less in a message is better than no message */
    }
    w->capacity = (int)capacity;
    w->element[w->n_elements++] = name;
}

static double but_rounding(double entry, double largest) {
    return fabs(entry) > dalcs_nothing * largest ? entry : 0.0;
}

/* Sources that do work along d[n + n_pairs] (balanced). Where a row sums the KCL of a tree of
 * capacitors, the other rows of the tree are paired with voltages relative to its root. */
static void add_sources(struct dalcs_osnsp *p, const double *d, double largest) {
    const struct dalcs_system *s = p->system;
    const struct dalcs_step_form *f = p->cache.form[0];
    for (int input = 1; input < s->n_inputs; input++) {
        double work = 0.0;
        double size = 0.0;
        for (int i = 0; i < f->n + f->n_pairs; i++) {
            double along = d[i];
            if (i < f->n && s->forest_root[f->column_of[i]] != f->column_of[i]) {
                int root = s->forest_root[f->column_of[i]] - s->n_x;
                along -= d[root] * f->scale[root] / f->scale[i];
            }
            along = but_rounding(along, largest) * f->scale[i] / f->row_scale[i];
            for (int k = f->R.p[i]; k < f->R.p[i + 1]; k++) {
                if (f->R.j[k] == s->n_x + input) {
                    work += f->R.x[k] * along;
                    size += fabs(f->R.x[k] * along);
                }
            }
        }
        if (fabs(work) > dalcs_nothing * size) {
            dalcs_witness_add(&p->witness, s->input_element[input]);
        }
    }
}

/* The direction in volts and amperes, of the states as well. */
static void keep_ray(struct dalcs_osnsp *p, const double *d, double largest) {
    const struct dalcs_system *s = p->system;
    const struct dalcs_step_form *f = p->cache.form[0];
    double *ray = p->witness.ray;
    int n_equations = dalcs_system_n_equations(s);
    for (int i = 0; i < f->n; i++) {
        ray[f->column_of[i]] = f->scale[i] * but_rounding(d[i], largest);
    }
    for (int k = 0; k < f->n_pairs; k++) {
        ray[n_equations + k] = f->scale[f->n + k] * but_rounding(d[f->n + k], largest);
    }
    for (int x = 0; x < s->n_x; x++) {
        double sum = 0.0;
        for (int k = f->state.X.p[x]; k < f->state.X.p[x + 1]; k++) {
            sum += f->state.X.x[k] * ray[f->state.X.j[k]];
        }
        ray[x] = sum;
    }
    p->witness.has_ray = true;
}

/* Is d, with what it makes of the pairs' w behind it, a ray? *largest: its largest entry. */
static bool is_ray(struct dalcs_osnsp *p, const double *d, double *largest) {
    const struct dalcs_system *s = p->system;
    const struct dalcs_step_form *f = p->cache.form[0];
    int n = f->n + f->n_pairs;
    const double *d_w = d + n;
    *largest = 0.0;
    for (int i = 0; i < n + f->n_pairs; i++) {
        *largest = fmax(*largest, fabs(d[i]));
    }
    double *residual = p->work.rhs;
    double *size = p->work.step_before;
    memset(residual, 0, (size_t)n * sizeof(double));
    memset(size, 0, (size_t)n * sizeof(double));
    for (int c = 0; c < n; c++) {
        for (int k = f->K.p[c]; k < f->K.p[c + 1]; k++) {
            residual[f->K.j[k]] += f->K.x[k] * d[c];
            size[f->K.j[k]] += fabs(f->K.x[k] * d[c]);
        }
    }
    for (int i = 0; i < n; i++) {
        bool must_vanish = i < f->n || dalcs_osnsp_is_on(p, i - f->n);
        if (must_vanish && fabs(residual[i]) > dalcs_answer_rounded * fmax(size[i], *largest)) {
            return false;
        }
    }
    for (int k = 0; k < f->n_pairs; k++) {
        bool is_diode = s->pair[k].kind == DALCS_PAIR_DIODE;
        if (is_diode &&
            (d[f->n + k] < -dalcs_nothing * *largest || d_w[k] < -dalcs_nothing * *largest)) {
            return false;
        }
    }
    return true;
}

/* Of a ray: a loop in amperes, or a cutset in volts. */
static enum dalcs_witness_kind kind_of_ray(const struct dalcs_osnsp *p, const double *d) {
    const struct dalcs_system *s = p->system;
    const struct dalcs_step_form *f = p->cache.form[0];
    const double *d_w = d + f->n + f->n_pairs;
    double current = 0.0;
    double voltage = 0.0;
    for (int i = 0; i < f->n; i++) {
        double *unit = s->column_is_current[f->column_of[i]] ? &current : &voltage;
        *unit = fmax(*unit, fabs(d[i]));
    }
    for (int k = 0; k < f->n_pairs; k++) {
        current = fmax(current, fabs(d[f->n + k]));
        voltage = fmax(voltage, fabs(d_w[k]));
    }
    return current >= voltage ? DALCS_WITNESS_LOOP : DALCS_WITNESS_CUTSET;
}

/* A ray, with what it makes of the pairs' w behind it, and its names. */
static void take_ray(struct dalcs_osnsp *p, const double *d, double largest) {
    const struct dalcs_system *s = p->system;
    const struct dalcs_step_form *f = p->cache.form[0];
    const double *d_w = d + f->n + f->n_pairs;
    p->witness.n_elements = 0;
    keep_ray(p, d, largest);
    p->witness.kind = kind_of_ray(p, d);
    add_sources(p, d, largest);
    for (int i = 0; i < f->n; i++) {
        int c = f->column_of[i];
        enum dalcs_label_kind kind = s->column[c].kind;
        if (s->column_is_current[c] && fabs(d[i]) > dalcs_nothing * largest &&
            kind != DALCS_LABEL_REFERENCE) {
            dalcs_witness_add(&p->witness, s->column[c].element);
        }
    }
    for (int k = 0; k < f->n_pairs; k++) {
        if (fmax(fabs(d[f->n + k]), fabs(d_w[k])) > dalcs_nothing * largest) {
            dalcs_witness_add(&p->witness, s->pair[k].element);
        }
    }
}

bool dalcs_witness_from_ray(struct dalcs_osnsp *p) {
    double largest;
    const bool is = is_ray(p, p->work.step_now, &largest);
    if (is) {
        take_ray(p, p->work.step_now, largest);
    }
    return is;
}

/* The ray whose weights dalcs_witness_weight() tells. */
static void find_ray(const struct dalcs_osnsp *p, const double *v, double *ray) {
    const struct dalcs_system *s = p->system;
    const int n_equations = dalcs_system_n_equations(s);
    for (int pass = 0; pass < 2; pass++) { /* roots first */
        for (int row = 0; row < n_equations; row++) {
            const int c = s->dual[row];
            const int root = s->forest_root[c];
            if ((root == c) == (pass == 0)) {
                ray[c] = v[row] + (root == c ? 0.0 : ray[root]);
            }
        }
    }
    memcpy(ray + n_equations, v + n_equations, (size_t)s->n_pairs * sizeof(double));
}

void dalcs_witness_from_passive_weights(struct dalcs_osnsp *p, const double *v) {
    const struct dalcs_system *s = p->system;
    const struct dalcs_step_form *f = p->cache.form[0];
    const int n_equations = dalcs_system_n_equations(s);
    double *ray = p->witness.ray;
    double *d = p->work.step_now;
    double largest = 0.0;
    find_ray(p, v, ray);
    for (int i = 0; i < f->n; i++) {
        d[i] = ray[f->column_of[i]] / f->scale[i];
    }
    for (int k = 0; k < f->n_pairs; k++) {
        d[f->n + k] = ray[n_equations + k] / f->scale[f->n + k];
        d[f->n + f->n_pairs + k] = f->row_scale[f->n + k] * dalcs_csr_row_dot(&s->C, k, ray);
    }
    for (int i = 0; i < f->n + 2 * f->n_pairs; i++) {
        largest = fmax(largest, fabs(d[i]));
    }
    take_ray(p, d, largest);
}

void dalcs_witness_from_clash(struct dalcs_osnsp *p) {
    const struct dalcs_system *s = p->system;
    p->witness.n_elements = 0;
    p->witness.kind = DALCS_WITNESS_CUTSET;
    for (int c = 0; c < dalcs_system_n_columns(s); c++) { /* all nodes rise together */
        bool is_node =
            c >= s->n_x && c < dalcs_system_n_equations(s) && s->column[c].kind == DALCS_LABEL_NODE;
        p->witness.ray[c] = is_node ? 1.0 : 0.0;
    }
    p->witness.has_ray = true;
    for (int r = 0; r < dalcs_system_n_equations(s); r++) {
        for (int k = s->E.p[r]; s->row_is_current[r] && k < s->E.p[r + 1]; k++) {
            if (s->E.j[k] > 0) {
                dalcs_witness_add(&p->witness, s->input_element[s->E.j[k]]);
            }
        }
    }
}

double dalcs_witness_weight(const struct dalcs_witness *w, const struct dalcs_system *s, int row) {
    int c = s->dual[row];
    int root = s->forest_root[c];
    return root != c ? w->ray[c] - w->ray[root] : w->ray[c];
}

double dalcs_osnsp_along_ray(const struct dalcs_osnsp *p, const double *inputs) {
    const struct dalcs_system *s = p->system;
    double sum = 0.0;
    for (int row = 0; row < dalcs_system_n_equations(s) && p->witness.has_ray; row++) {
        sum += dalcs_witness_weight(&p->witness, s, row) * dalcs_csr_row_dot(&s->E, row, inputs);
    }
    for (int d = 0; d < s->n_pairs && p->witness.has_ray; d++) {
        sum -=
            p->witness.ray[dalcs_system_n_equations(s) + d] * dalcs_csr_row_dot(&s->F, d, inputs);
    }
    return sum;
}

/* A witness names at least the equation that fits worst. */
void dalcs_witness_complete(struct dalcs_osnsp *p) {
    int where = p->certificate.where;
    if (p->witness.n_elements == 0 && where >= 0 && where < dalcs_system_n_equations(p->system)) {
        dalcs_witness_add(&p->witness, p->system->row[where].element);
    }
}

void dalcs_osnsp_blame_states(struct dalcs_osnsp *p, const double *x, const double *y1,
                              const double *y2) {
    const struct dalcs_system *s = p->system;
    double largest = 0.0;
    for (int i = 0; i < s->n_x; i++) {
        largest = fmax(largest, fabs(y2[i] - y1[i]));
    }
    p->witness.n_elements = 0;
    p->witness.kind = DALCS_WITNESS_DERIVATIVE;
    p->witness.has_ray = false;
    for (int i = 0; i < s->n_x; i++) {
        if (fmax(fabs(y1[i] - x[i]), fabs(y2[i] - x[i])) >= 0.5 * largest) {
            dalcs_witness_add(&p->witness, s->column[i].element);
        }
    }
}

static void name_pairs(const struct dalcs_system *s, struct dalcs_witness *w) {
    w->n_elements = 0;
    w->kind = DALCS_WITNESS_MODE;
    w->has_ray = false;
    for (int d = 0; d < s->n_pairs; d++) {
        dalcs_witness_add(w, s->pair[d].element);
    }
}

void dalcs_witness_from_modes(struct dalcs_osnsp *p) {
    name_pairs(p->system, &p->witness);
}

void dalcs_witness_from_cases(struct dalcs_osnsp *p) {
    name_pairs(p->system, &p->weighed);
}

void dalcs_witness_copy(struct dalcs_osnsp *p, const struct dalcs_witness *from) {
    p->witness.kind = from->kind;
    p->witness.has_ray = from->has_ray;
    p->witness.n_elements = 0;
    for (int k = 0; k < from->n_elements; k++) {
        dalcs_witness_add(&p->witness, from->element[k]);
    }
}
