/* orbit_rates.c - derivatives by time along a run. */
#include "orbit_rates.h"

#include "rounding.h"

#include <lapacke.h>
#include <math.h>

/* weight[s + 1] such that the derivative by theta of a quantity is the sum of weight * value at node. */
static void derivative_weights(const struct dalcs_collocation *c, double theta, double *weight) {
    for (int k = 0; k <= c->s; k++) {
        weight[k] = 0.0;
        for (int j = 0; j <= c->s; j++) {
            double product = j == k ? 0.0 : 1.0 / (c->node[k] - c->node[j]);
            for (int m = 0; m <= c->s && j != k; m++) {
                product *=
                    m == j || m == k ? 1.0 : (theta - c->node[m]) / (c->node[k] - c->node[m]);
            }
            weight[k] += product;
        }
    }
}

void dalcs_orbit_rates_of(const struct dalcs_orbit_rates *rates, double *y, double tau, double *f) {
    const struct dalcs_radau_part *part = rates->part;
    const struct dalcs_system *s = part->component->system;
    const struct dalcs_osnsp *p = &part->component->osnsp;
    for (int d = 0; d < s->n_pairs; d++) {
        y[dalcs_system_n_equations(s) + d] *= dalcs_osnsp_is_on(p, d) ? 1.0 : 0.0;
    }
    dalcs_excitation_inputs(&part->excitation, part->segment.t, tau, rates->inputs);
    for (int x = 0; x < s->n_x; x++) {
        f[x] = dalcs_csr_row_dot(&s->A, x, y) + dalcs_csr_row_dot(&s->E, x, rates->inputs);
    }
    if (s->n_x > 0) {
        (void)LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', rates->n_x, 1, rates->P, rates->n_x,
                             rates->pivot, f, rates->n_x);
    }
}

int dalcs_orbit_guard_row(const struct dalcs_radau_part *part, int guard) {
    const struct dalcs_system *s = part->component->system;
    return guard < s->n_pairs ? dalcs_system_n_equations(s) + guard
                              : dalcs_system_n_columns(s) + guard - s->n_pairs;
}

double dalcs_orbit_weigh(const struct dalcs_stage_layout *l, const double *weight,
                         const double *out, int row) {
    double sum = 0.0;
    for (int k = 0; k < l->n_nodes; k++) {
        sum += weight[k] * out[k * l->stride + row];
    }
    return sum;
}

double dalcs_orbit_row_rate(const struct dalcs_radau_part *part, int row, double theta) {
    double weight[DALCS_MAX_NODES];
    derivative_weights(part->stages.method, theta, weight);
    return dalcs_orbit_weigh(&part->stages.layout, weight, part->segment.out, row) /
           part->segment.h;
}

double dalcs_orbit_guard_rate(const struct dalcs_radau_part *part, int row) {
    return dalcs_orbit_row_rate(part, row, part->segment.end);
}

static double slope_at(const struct dalcs_stimulus *s, double t, struct dalcs_stimulus_term *term) {
    struct dalcs_stimulus_piece piece = {.term = term};
    dalcs_stimulus_course_at(s, t, &piece);
    double slope = piece.slope;
    for (int k = 0; k < piece.n_terms; k++) {
        slope += term[k].omega * term[k].sine - term[k].decay * term[k].cosine;
    }
    return slope;
}

double dalcs_slope_before(const struct dalcs_stimulus *s, double t,
                          struct dalcs_stimulus_term *term) {
    /* a piece is asked for that ends there */
    return slope_at(s, t * (1.0 - dalcs_answer_rounded), term);
}

double dalcs_slope_behind(const struct dalcs_stimulus *s, double t,
                          struct dalcs_stimulus_term *term) {
    return slope_at(s, t, term);
}

static double input_slope(const struct dalcs_radau_part *part, int input, double t, bool behind,
                          struct dalcs_stimulus_term *term) {
    const int index = part->component->system->stimulus[input];
    const struct dalcs_stimulus *s = index >= 0 ? &part->component->circuit->stimulus[index] : NULL;
    return s == NULL ? 0.0
           : behind  ? dalcs_slope_behind(s, t, term)
                     : dalcs_slope_before(s, t, term);
}

int dalcs_orbit_bystander(const struct dalcs_radau_part *part, int column) {
    const struct dalcs_bystanders *b = &part->excitation.bystanders;
    int found = -1;
    for (int k = 0; k < b->n && found < 0; k++) {
        found = b->column[k] == column ? k : -1;
    }
    return found;
}

double dalcs_orbit_probe_rate(const struct dalcs_radau_part *part, const struct dalcs_probe *probe,
                              bool at_begin, struct dalcs_stimulus_term *term) {
    const int n_inputs = part->component->system->n_inputs;
    const double t = at_begin ? part->segment.t : part->segment.t_end;
    double sum = 0.0;
    for (int k = 0; probe->system >= 0 && k < probe->n_terms + probe->n_inputs; k++) {
        const int index = probe->term[k].index;
        const int bystander = k < probe->n_terms ? dalcs_orbit_bystander(part, index) : -1;
        double value = 0.0;
        if (k >= probe->n_terms) {
            value = input_slope(part, index, t, at_begin, term);
        } else if (bystander < 0) {
            value = dalcs_orbit_row_rate(part, index, at_begin ? 0.0 : part->segment.end);
        } else {
            const double *gain =
                part->excitation.bystanders.gain + (size_t)bystander * (size_t)n_inputs;
            for (int i = 1; i < n_inputs; i++) {
                value += gain[i] != 0.0 ? gain[i] * input_slope(part, i, t, at_begin, term) : 0.0;
            }
        }
        sum += probe->term[k].coefficient * value;
    }
    return sum;
}

/* And in which units energies are alike. */
static enum dalcs_status factor_P(struct dalcs_orbit_rates *rates, const struct dalcs_system *s) {
    for (int r = 0; r < s->n_x; r++) {
        for (int k = s->P.p[r]; k < s->P.p[r + 1]; k++) {
            rates->P[s->P.j[k] * s->n_x + r] += s->P.x[k];
        }
    }
    for (int x = 0; x < s->n_x; x++) {
        rates->unit[x] = 1.0;
        for (int k = s->storage.p[x]; k < s->storage.p[x + 1]; k++) {
            bool stores = s->storage.j[k] == x && s->storage.x[k] > 0.0;
            rates->unit[x] = stores ? sqrt(s->storage.x[k]) : rates->unit[x];
        }
    }
    int failed = s->n_x == 0 ? 0
                             : LAPACKE_dgetrf(LAPACK_COL_MAJOR, s->n_x, s->n_x, rates->P, s->n_x,
                                              rates->pivot);
    return failed == 0 ? DALCS_OK : DALCS_SINGULAR;
}

enum dalcs_status dalcs_orbit_rates_setup(struct dalcs_orbit_rates *rates,
                                          struct dalcs_arena *arena,
                                          const struct dalcs_radau_part *part) {
    const struct dalcs_system *s = part->component->system;
    const size_t n = (size_t)s->n_x;
    *rates = (struct dalcs_orbit_rates){.part = part, .n_x = s->n_x};
    rates->P = dalcs_arena_alloc(arena, n * n, sizeof(double));
    rates->pivot = dalcs_arena_alloc(arena, n, sizeof(int));
    rates->unit = dalcs_arena_alloc(arena, n, sizeof(double));
    rates->inputs = dalcs_arena_alloc(arena, (size_t)s->n_inputs, sizeof(double));
    if (rates->P == NULL || rates->pivot == NULL || rates->unit == NULL || rates->inputs == NULL) {
        return DALCS_E_NOMEM;
    }
    return factor_P(rates, s);
}
